"""Common result of all record formats: uniform acceleration series in SI, their metadata, and which become axes."""

import re
from dataclasses import dataclass, field, replace

import numpy as np

from blockshake.dynamics.motion import CHANNELS
from blockshake.errors import Argument, InputError
from blockshake.tables.numbers import missing_code, plain_number, touching_numbers

SPECTRUM = re.compile("spectr|pseudo", re.IGNORECASE)  # of a header whose values are no motion
# how the direction of a vertical component is written: PEER's "UP", K-NET's "U-D", ESM's "HNZ"
_VERTICAL = re.compile(
    r"(?:^|[\s,:=])(?:UP|DOWN|DWN|DN|U-?D|UD[12]?|V|Z|VERT(?:ICAL)?\.?|[A-Z]{2}Z)$", re.IGNORECASE
)
_FEW = 0.01  # of all values, which have fewer digits than all others: a print of zeros left out has a tenth


@dataclass(frozen=True)
class Record:
    """One recorded component."""

    acceleration: np.ndarray  # float64 (n_rows,); as recorded, no correction made here [m/s2]
    time_step: float  # [s]
    format: str  # name of the file format
    checked: str  # entries of the header that were held against the values
    assumed: str = ""  # what the file does not say; empty where it states all
    channel: str = ""  # name of the component; empty where the format holds a single one
    # str to str; what the header states of event, station and processing; ``licence`` where stated
    metadata: dict = field(default_factory=dict)

    def turned(self, axis, sign):
        """This record, or for a ``sign`` of -1 the reversed one, which tells so."""
        if sign > 0.0:
            return self
        assumed = "; ".join(filter(None, (self.assumed, f"{axis} is reversed")))
        return replace(self, acceleration=-self.acceleration + 0.0, assumed=assumed)

    def vertical(self):
        """The text by which the file states that the component is vertical; empty where it does not.

        The direction is a channel's name, a stream, or what follows the last comma of an event.
        """
        _, comma, last = self.metadata.get("event", "").rpartition(",")
        texts = self.channel, self.metadata.get("stream", ""), last if comma else ""
        return next((text.strip() for text in texts if _VERTICAL.search(text.strip())), "")


def positive_number(text, where, key, kind=float):
    """A header's number, finite and above zero.

    Raises
    ------
    InputError
        The text is no such number.
    """
    number = plain_number(text)
    try:
        number = kind(number)
    except (TypeError, ValueError):
        number = 0
    if not (0 < number < np.inf):
        raise InputError(
            where,
            key,
            f"expected a positive {'integer' if kind is int else 'number'}, found '{text.strip()}'",
        )
    return number


def finite_number(text, where, key):
    """A finite number written as text.

    Raises
    ------
    InputError
        The text is no number, or is NaN or infinite.
    """
    number = float(plain_number(text) or "nan")
    if not np.isfinite(number):
        raise InputError(where, key, f"expected a finite number, found '{text.strip()}'")
    return number


def free_values(lines, first, count, where, count_key):
    """Series of values between blanks, or touching where a sign tells them apart, from the last lines of a file.

    Parameters
    ----------
    lines, first : list of str, int
        The whole file; index of the first line of values.
    count : int
        How many values the header promises.
    where, count_key : str
        File and header entry that a message names.

    Returns
    -------
    float64 array, shape (count,)
        In the file's unit.

    Raises
    ------
    InputError
        A value is not a finite number, stands for a missing one or is cut short, or there are more or fewer than
        ``count``, or fewer than two.
    """
    cells = [(text, index + 1) for index in range(first, len(lines)) for text in _tokens(lines[index])]
    return _series(cells, count, where, count_key)


def fixed_values(lines, first, count, layout, where, count_key):
    """Series of values in columns of a fixed width, which may touch: float64 array, shape (count,), in the file's unit.

    ``layout``: columns of a full line and their width; ``lines``, ``first``, ``count``, ``where`` and ``count_key`` are
    those of `free_values`.

    Raises
    ------
    InputError
        The reasons of `free_values`; a line that holds another number of values than its columns.
    """
    columns, width = layout
    cells, behind = [], first + -(-count // columns)
    for index in range(first, min(behind, len(lines))):
        line, expected = lines[index].rstrip(), min(columns, count - len(cells))
        if len(line) == expected * width:
            texts = cut_columns(line, width)
        else:
            texts = _tokens(line)
        if len(texts) != expected and plain_number(texts[0] if texts else ""):
            expected = f"expected {expected} values, in {width} columns each, found {len(texts)}"
            raise InputError(where, f"line {index + 1}", expected)
        if len(texts) != expected:  # the next header, or the end
            break
        cells += [(text.strip(), index + 1) for text in texts]
    rest = "".join(lines[behind : behind + 1])
    if any(texts and all(map(plain_number, texts)) for texts in (cut_columns(rest, width), _tokens(rest))):
        raise InputError(where, count_key, f"expected {count} values, found more in line {behind + 1}")
    return _series(cells, count, where, count_key)


def cut_columns(line, width):
    """Texts of one line, cut at fixed columns: they may touch."""
    line = line.rstrip()
    return [line[start : start + width] for start in range(0, len(line), width)]


def _tokens(line):
    """Texts of one line between blanks, or touching where a sign tells them apart."""
    return [text for token in line.split() for text in touching_numbers(token) or [token]]


def _series(cells, count, where, count_key):
    """Values of texts with the numbers of their lines, as many as promised."""
    values = np.array([finite_number(text, where, f"line {line}") for text, line in cells])
    if len(values) != count:
        raise InputError(where, count_key, f"expected {count} values, found {len(values)}")
    if count < 2:
        raise InputError(where, count_key, f"expected at least two values, found {count}")
    digits = [len(text.partition(".")[2]) for text, _ in cells]
    most = max(digits)
    short = [cell for cell, behind in zip(cells, digits, strict=True) if behind < most]
    if 0 < len(short) <= max(1, _FEW * len(cells)):  # 1.23E-0 for 1.23E-05
        text, line = short[0]
        wrong = f"expected as many digits as elsewhere, found '{text}': it is cut short"
        raise InputError(where, f"line {line}", wrong)
    coded = missing_code(values)
    if coded is not None:
        text, line = cells[coded]
        raise InputError(where, f"line {line}", f"expected a value; '{text}' looks like a code for none")
    return values


def chosen_records(records, channels, where):
    """Records by axis.

    Parameters
    ----------
    records : list of Record
        One file.
    channels : dict of str to str, or None
        By axis (``x``, ``y``, ``z``) the name of a channel, or its number in the file, from 1, behind a minus where it
        is reversed; None takes the only one as x.
    where : str
        File that a message names.

    Raises
    ------
    InputError
        Another axis, no such channel, a channel twice, several where none is named, or channels of different steps or
        lengths.
    """
    if channels is None and len(records) == 1:
        return _horizontal({"x": records[0]}, where)
    listed = "; ".join(
        f"{number}: {record.channel or 'no name'}" for number, record in enumerate(records, start=1)
    )
    chosen, signs = {}, {}
    for axis, name in (channels or {"x": ""}).items():
        signs[axis], name = (-1.0, name[1:]) if name.startswith("-") else (1.0, name)
        if axis not in CHANNELS[:3]:
            raise InputError(Argument("channels"), axis, f"expected {', '.join(CHANNELS[:3])}")
        named = [
            record
            for number, record in enumerate(records, start=1)
            if name.strip().lower() in (str(number), record.channel.lower() or None)
        ]
        if len(named) != 1:
            raise InputError(
                where, f"channel '{name}'" if name else "",
                f"expected one of the {len(records)} acceleration channels ({listed}), which "
                "`blockshake convert-motion --column x=NUMBER` chooses",
            )  # fmt: skip
        if any(named[0] is other for other in chosen.values()):
            raise InputError(Argument("channels"), f"{axis}={name}", "expected every channel for one axis")
        chosen[axis] = named[0]
    first = next(iter(chosen.values()))
    for record in chosen.values():
        if (record.time_step, len(record.acceleration)) != (first.time_step, len(first.acceleration)):
            raise InputError(where, "", f"expected channels of the same time step and length ({listed})")
    signed = {axis: record.turned(axis, signs[axis]) for axis, record in chosen.items()}
    return _horizontal(signed, where)


def one_motion(components):
    """Records by axis from files by axis, of one event and station; the shorter ones rest behind their ends.

    Parameters
    ----------
    components : dict of str to tuple
        By axis a file's path and its `Record`.

    Raises
    ------
    InputError
        Other time steps, or headers that name other events or stations.
    """
    (_, (path, first)), *others = components.items()
    longest = max(len(record.acceleration) for _, record in components.values())
    for _, (other, record) in others:
        if record.time_step != first.time_step:
            wrong = f"expected the time step of {path}, {first.time_step:g} s, found {record.time_step:g} s"
            raise InputError(other, "", wrong)
        for name in ("event", "station"):
            mine, its = (one.metadata.get(name, "").rpartition(",") for one in (first, record))
            # PEER's event ends with the component, behind the last comma
            mine, its = (one[0] or one[2] for one in (mine, its))
            if mine and its and mine.strip().lower() != its.strip().lower():
                raise InputError(other, name, f"expected that of {path}, '{mine}', found '{its}'")
    joined = {}
    for axis, (path, record) in components.items():
        short = longest - len(record.acceleration)
        rests = f"{path}: rest for {short * record.time_step:g} s behind its end" if short else ""
        joined[axis] = replace(
            record,
            acceleration=np.pad(record.acceleration, (0, short)),
            assumed="; ".join(filter(None, (record.assumed, rests))),
        )
    return joined


def _horizontal(chosen, where):
    """Records by axis; none along x or y is vertical by its header."""
    for axis in set(chosen) & {"x", "y"}:
        if found := chosen[axis].vertical():
            raise InputError(
                where, axis,
                f"expected a horizontal component, found '{found}'; `convert-motion --column z=1` makes it z",
            )  # fmt: skip
    return chosen
