"""A ground motion from a shipped name or from a file of any known format, and where it comes from."""

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from blockshake.dynamics.baseline import AUTO, NONE, correct_baseline
from blockshake.dynamics.motion import CHANNELS, PITCH, GroundMotion, check_finite, ground_motion
from blockshake.dynamics.records.at2 import is_at2, read_at2
from blockshake.dynamics.records.contract_csv import kept_attributes, motion_of_arrays, read_motion_csv
from blockshake.dynamics.records.cosmos import is_cosmos, read_cosmos
from blockshake.dynamics.records.csmip import is_csmip, read_csmip
from blockshake.dynamics.records.dyna import is_dyna, read_dyna
from blockshake.dynamics.records.joined_rows import joined_rows
from blockshake.dynamics.records.knet import is_knet, read_knet
from blockshake.dynamics.records.record import chosen_records, one_motion
from blockshake.dynamics.records.smc import is_smc, read_smc
from blockshake.dynamics.records.times import gap_words
from blockshake.dynamics.synthetic_motion import load_synthetic, synthesise
from blockshake.errors import Argument, InputError
from blockshake.files import AnyPath, named_file, read_foreign_text

# content decides; the ending only where a broken file of that format should say what it lacks
_RECORD_FORMATS = (
    (is_dyna, ".asc", read_dyna),
    (is_cosmos, ".v2c", read_cosmos),
    (is_csmip, ".v2", read_csmip),
    (is_knet, ".knt", read_knet),
    (is_smc, ".smc", read_smc),
    (is_at2, ".at2", read_at2),
)


_ARRAYS = "arrays"  # what a message calls them
# a name, a path, arrays by the names of columns (or a table of pandas), or a motion
MotionSource: TypeAlias = AnyPath | Mapping[str, Any] | GroundMotion


def load_motion(
    source: MotionSource,
    scale: float = 1.0,
    baseline: str | float = AUTO,
    channels: Mapping[str, str] | None = None,
    name: str | None = None,
    components: Mapping[str, AnyPath] | None = None,
) -> GroundMotion:
    """Ground motion from a shipped name, a file or arrays.

    Parameters
    ----------
    source : str, path, mapping of str to array, or GroundMotion
        ``alkion``, ``basso-tirreno`` (synthetic), a CSV of the project, a record in ESM/ITACA DYNA
        1.2, PEER AT2, COSMOS V2, CSMIP V2, K-NET/KiK-net ASCII or SMC, or the YAML of a synthetic motion. Content tells
        the format. Arrays by the names of the CSV's columns, such as ``time_s`` and ``acceleration_x``, in SI, also as
        a table of pandas. A motion that is there already keeps its baseline.
    scale : float
        Multiplies every column, not 0 [1].
    baseline : str or float
        ``auto``, ``none`` or a corner frequency [Hz], as `correct_baseline` takes it: by default a record that does not
        end at rest is corrected, and a CSV never is.
    channels : dict of str to str, optional
        By axis (``x``, ``y``, ``z``) the name of a record's channel, or its number in the file, from 1; a minus before
        it reverses the channel. By default the only channel is x.
    name : str, optional
        That results use; by default that of the file, or ``arrays``.
    components : dict of str to path, optional
        By axis the files of the other components of a record or a CSV, of one channel each; a minus before a path
        reverses.

    Returns
    -------
    GroundMotion
        Its time starts at zero: what the file gives as its first time is in the attribute
        ``first_time`` where it is another. The attributes of a record tell its ``format``, the entries of its header
        that were ``checked`` against the values, and what was ``assumed``; ``baseline`` and, of a corrected motion,
        ``record_start`` are those of `correct_baseline`.

    Raises
    ------
    InputError
        A table that turns by more than pi/2, a missing file, unknown name, unknown format or unit, NaN, time that does
        not increase, a gap in even rows, mixed kinds, too few rows, a file cut short, a header that contradicts its
        values, several channels where none is named, a scale that is 0 or not finite, a displacement beyond all
        numbers, a correction that cannot be made.

    Examples
    --------
    >>> import blockshake
    >>> blockshake.load_motion("alkion", scale=1.5)
    <GroundMotion alkion: 25 s, given as acceleration>
    >>> pulse = {"time_s": [0.0, 0.1, 0.2], "acceleration_x": [0.0, 3.0, 0.0]}
    >>> blockshake.load_motion(pulse, name="pulse")
    <GroundMotion pulse: 0.2 s, given as acceleration>
    """
    where = source if isinstance(source, (str, PathLike)) else getattr(source, "name", _ARRAYS)
    if not np.isfinite(scale) or scale == 0.0:
        raise InputError(where, "scale", f"expected a finite number other than 0, found {scale}")
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # looked at below
        if isinstance(source, GroundMotion):
            motion = source
        else:
            motion = _read(source, baseline, channels, components or {})
    return scaled(motion if name is None else replace(motion, name=name), scale, where)


def scaled(motion, scale, source):
    """A motion with every column multiplied by a finite scale; an `InputError` names ``source`` if that is too much.

    Too much is a displacement beyond all numbers, or a pitch beyond pi/2: no table turns so far.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # looked at below
        motion = motion if scale == 1.0 else motion.scaled(scale)
    check_finite(motion, source)
    pitch = motion.evaluate(motion.table.breaks)[:, PITCH]
    far = np.flatnonzero(np.abs(pitch) > 0.5 * np.pi)
    if len(far):
        wrong = (
            f"expected at most pi/2 rad, found {pitch[far[0]]:.4g} rad at {motion.table.breaks[far[0]]:.4g} s"
        )
        raise InputError(source, "pitch_y", f"{wrong}; perhaps given in degrees")
    return motion


def _read(source, baseline, channels, components):
    if not isinstance(source, (str, PathLike)):
        _check_no_record(channels, components, _ARRAYS)
        motion = _motion_of_rows(motion_of_arrays(source, _ARRAYS), _ARRAYS, "Python")
        return correct_baseline(motion, baseline, _ARRAYS)
    path = named_file("motions", source)
    if path.suffix.lower() in (".yaml", ".yml"):
        _check_no_record(channels, components, path)
        if baseline not in (AUTO, NONE):
            wrong = f"expected {AUTO} or {NONE} of a synthetic motion, which ends at rest"
            raise InputError(path, "baseline", wrong)
        return synthesise(load_synthetic(path))
    text = read_foreign_text(path)
    records = _records(text, path)
    if records:
        chosen = {axis: (path, record) for axis, record in chosen_records(records, channels, path).items()}
        for axis, other in components.items():
            if axis in chosen:
                raise InputError(
                    Argument("components"), axis, f"expected no second one; {chosen[axis][0]} is {axis}"
                )
            chosen[axis] = _component(axis, str(other))
        return _record_motion(one_motion(chosen), path, baseline, channels, components)
    is_csv = "time_s" in text.partition("\n")[0] or path.suffix.lower() == ".csv"
    _check_no_record(channels, {} if is_csv else components, path)
    if is_csv:
        rows = read_motion_csv(text, path)
        rests = []
        if components:
            *rows, rests = _joined_csv(rows, path, components)
        motion = _motion_of_rows(rows, path.name, "csv")
        kept = motion.attributes | kept_attributes(path, text)
        if components:
            kept["components"] = ", ".join(filter(None, (kept.get("components"), _named(components))))
        if rests:
            kept["assumed"] = "; ".join(rests)
        return correct_baseline(replace(motion, attributes=kept), baseline, path)
    raise InputError(
        path, "",
        "expected a motion CSV (time_s, acceleration_x, ...), ESM/ITACA DYNA 1.2, PEER AT2, COSMOS V2, CSMIP V2, "
        "K-NET/KiK-net ASCII or SMC; `blockshake convert-motion` reads other tables, "
        "and with --step values without times",
    )  # fmt: skip


def _records(text, path):
    """`Record` of every channel of a file of a known format; none of another file."""
    ending = path.suffix.lower()
    readers = [read for recognises, _, read in _RECORD_FORMATS if recognises(text)]
    readers += [read for _, begin, read in _RECORD_FORMATS if ending.startswith(begin)]
    return readers[0](text, path) if readers else []


def _component(axis, source):
    """Path and `Record` of the component along an axis."""
    path = Path(source.removeprefix("-"))
    records = _records(read_foreign_text(path), path)
    if not records:
        raise InputError(path, "", "expected a record of a known format, as a component of another one")
    channel = {axis: "-1" if source.startswith("-") else "1"} if len(records) == 1 else None
    return path, chosen_records(records, channel, path)[axis]


def _joined_csv(rows, path, components):
    """Times, columns and kind of a CSV with others of one column as its components, and words on shorter ones."""
    time, columns, kind = rows
    parts = {axis: (path, time, values) for axis, values in columns.items()}
    for axis, source in components.items():
        if axis not in CHANNELS[:PITCH]:
            raise InputError(Argument("components"), axis, f"expected {', '.join(CHANNELS[:PITCH])}")
        if axis in parts:
            raise InputError(Argument("components"), axis, f"expected no second one; {path} is {axis}")
        other = Path(str(source).removeprefix("-"))
        times, found, its = read_motion_csv(read_foreign_text(other), other)
        if len(found) != 1 or its != kind:
            wrong = f"expected one column of {kind}, as a component of {path}, found {its} {', '.join(found)}"
            raise InputError(other, "", wrong)
        (values,) = found.values()
        parts[axis] = other, times, -values + 0.0 if str(source).startswith("-") else values
    time, columns, rests = joined_rows(parts, kind)
    return time, columns, kind, rests


def _named(components):
    return ", ".join(f"{axis}: {Path(other).name}" for axis, other in components.items())


def _motion_of_rows(rows, source, form):
    """Motion of times, columns and kind, as of `read_motion_csv`."""
    time, columns, kind = rows
    attributes = {"source": source, "format": form, "synthetic": False}
    attributes |= {"checked": "times", "assumed": "nothing"}
    if words := gap_words(time):
        attributes["gaps"] = words
    if time[0] != 0.0:
        attributes["first_time"] = float(time[0])
    return ground_motion(Path(source).stem, time - time[0], columns, kind, attributes)


def _check_no_record(channels, components, path):
    if channels:
        wrong = f"expected for a record, or with --unit for a table; {path} is neither"
        raise InputError(Argument("channels"), "", wrong)
    if components:
        raise InputError(
            Argument("components"), "", f"expected with a record or a CSV of the project; {path} is none"
        )


def _record_motion(records, path, baseline, channels, components):
    first = next(iter(records.values()))
    columns = {axis: record.acceleration for axis, record in records.items()}
    time = first.time_step * np.arange(len(first.acceleration))
    attributes = {"source": path.name, "format": first.format, "synthetic": False}
    assumed = [] if channels or components else ["a component along x"]
    assumed += dict.fromkeys(record.assumed for record in records.values())
    attributes |= {"checked": first.checked, "assumed": "; ".join(filter(None, assumed)) or "nothing"}
    if components:
        attributes["components"] = _named(components)
    if any(record.channel for record in records.values()):
        attributes["channels"] = ", ".join(f"{axis}: {record.channel}" for axis, record in records.items())
    motion = ground_motion(path.stem, time, columns, "acceleration", {**attributes, **first.metadata})
    check_finite(motion, path)
    return correct_baseline(motion, baseline, path, published=True)


def provenance(attributes):
    """One line for reports and checks: source and format of a motion, assumptions, and the treatment of its baseline.

    ``attributes``: of a `GroundMotion`; one without ``source`` is of arrays.
    """
    words = attributes.get("source", "arrays")
    if attributes.get("format", "synthetic") != "synthetic":
        words += f" ({attributes['format']})"
    if attributes.get("assumed"):
        words += f"; assumed: {attributes['assumed']}"
    return words + (f"; baseline: {attributes['baseline']}" if "baseline" in attributes else "")


def plain_attributes(attributes):
    """Attributes as netCDF can hold them: truth values as 0 and 1, all else that is no number as text."""
    plain = {name: int(value) if isinstance(value, bool) else value for name, value in attributes.items()}
    return {name: value if isinstance(value, (float, int)) else str(value) for name, value in plain.items()}
