"""Motions that samples draw: records of a folder or a table, each as strong as it is or scaled to an intensity."""

import re
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
from pydantic import Field, model_validator

from blockshake.dynamics.intensity import motion_figures, response_spectrum
from blockshake.dynamics.load_motion import load_motion, scaled
from blockshake.dynamics.record_choice import TargetSpectrum, choose
from blockshake.errors import InputError
from blockshake.files import content_digest, named_file, read_foreign_text, shipped_names
from blockshake.tables.numbers import plain_number
from blockshake.tables.table_file import csv_records
from blockshake.tables.units import unit_size
from blockshake.validation import Positive, Strict

_FILE, _FACTORS, _EVENT, _OTHERS = "file", ("scale", "level"), "event", ("y", "z")
_BEGINS = "record_start"  # s, attribute of a corrected motion
_NO_MOTIONS = (".json", ".md", ".pdf", ".vt2", ".dt2")  # what lies with records in a folder


def _are_numbers(values):
    return isinstance(values, (list, tuple)) and all(type(one) in (int, float) for one in values)


class Intensity(Strict):
    """Measure of how strong a motion is along x, and the levels that motions are scaled to."""

    measure: Literal["pga", "pgv", "sa"] = Field(
        "pga",
        description="peak ground acceleration [m/s2], peak ground velocity [m/s], or pseudo-acceleration at 5 % "
        "damping [m/s2], along x",
    )
    period: Positive | None = Field(None, description="of `sa`, which needs it [s]")
    levels: tuple[Positive, ...] = Field(
        (),
        description="rising, in `unit`: every sample is scaled to one of them, in turn; none leaves each motion as "
        "strong as it is, or as its table or `spectrum` states",
    )
    unit: Literal["m/s2", "cm/s2", "g", "m/s", "cm/s"] | None = Field(
        None,
        description="of the levels; by default m/s2, and m/s of `pgv`",
        exclude_if=lambda given: given is None,  # levels are SI once they are read
    )
    spectrum: TargetSpectrum | None = Field(
        None,
        description="records are chosen to it, a scale each and at most one of an event; none: all are drawn",
        exclude_if=lambda given: given is None,
    )

    @model_validator(mode="before")
    @classmethod
    def _in_si(cls, given: Any):
        """Levels in SI, so that a mapping that is read again is the same."""
        if (
            not isinstance(given, dict)
            or given.get("unit") is None
            or not _are_numbers(given.get("levels", ()))
        ):
            return given
        kind = "velocity" if given.get("measure") == "pgv" else "acceleration"
        size = float(unit_size(kind, str(given["unit"]), "", "unit"))
        return given | {"unit": None, "levels": [size * level for level in given.get("levels", ())]}

    @model_validator(mode="after")
    def _is_whole(self):
        if (self.measure == "sa") != (self.period is not None):
            raise ValueError("expected `period` with the measure sa, and with no other")
        if any(high <= low for low, high in zip(self.levels, self.levels[1:], strict=False)):
            raise ValueError("expected levels that rise")
        return self

    def of(self, motion):
        """The measure of a motion [m/s2 or m/s]."""
        if self.measure == "sa":
            return float(response_spectrum(motion, [self.period])[0])
        return motion_figures(motion)[{"pga": "peak_acceleration", "pgv": "peak_velocity"}[self.measure]]


class SetRecord(NamedTuple):
    """A motion of a set: name and path of its file, its factor, and the level that it is scaled to, if any.

    ``event`` where a table tells it; ``components``: axis and path of the files of other components.
    """

    name: str
    path: str
    scale: float = 1.0
    level: float | None = None
    event: str | None = None
    components: tuple = ()


def is_record_set(source):
    """Whether a path is a folder, or a CSV table with a column ``file``."""
    path = Path(source)
    if path.suffix.lower() != ".csv" or not path.is_file():
        return path.is_dir()
    header, _, _ = read_foreign_text(path).partition("\n")
    return _FILE in [cell.strip(' "') for cell in re.split("[,;\t]", header)]


def record_files(source):
    """Files of a set of records, its table first, or the one of a motion: paths."""
    table = [Path(source)] if is_record_set(source) and Path(source).is_file() else []
    records = read_records(source)
    others = [Path(path) for record in records for _, path in record.components]
    return [*table, *(named_file("motions", record.path) for record in records), *others]


def read_records(source):
    """`SetRecord` of a folder, by name; of a table, row by row; or of the one motion that ``source`` is.

    Parameters
    ----------
    source : str or path
        A folder, each file of which is a motion (names that begin with a dot, metadata, texts about the records, and
        PEER's velocities and displacements of the same records are passed over); a CSV table with the
        column ``file``, a path from the table's folder or a shipped name, and optionally ``scale`` [1] or ``level``, in
        the SI unit of the measure, ``event``, and ``y`` and ``z``, files of the record's other components; or what
        `load_motion` reads.

    Raises
    ------
    InputError
        An empty folder or table, another column, a row of another length, a file that is not there, a number that is
        not above zero.
    """
    path = Path(source)
    if not is_record_set(path):
        return (SetRecord(path.stem, str(source)),)
    if path.is_dir():
        files = (file for file in path.iterdir() if file.is_file() and not file.name.startswith("."))
        records = [
            SetRecord(file.name, str(file))
            for file in sorted(files)
            if file.suffix.lower() not in _NO_MOTIONS
        ]
    else:
        records = [_record(path, f"row {number}", row) for number, row in enumerate(csv_records(path), 1)]
    if not records:
        raise InputError(path, "", "expected at least one record")
    return tuple(records)


def _record(table, place, cells):
    for name in cells:
        if name not in (_FILE, *_FACTORS, _EVENT, *_OTHERS):
            expected = "expected the columns file and, of each, scale or level, event, y and z"
            raise InputError(table, name, expected)
    if cells.keys() >= set(_FACTORS):
        raise InputError(table, "level", "expected one of scale and level: a level sets the scale")
    name, event = cells.pop(_FILE), cells.pop(_EVENT, "").strip() or None
    path = name if name in shipped_names("motions") else str(table.parent / name)
    others = {axis: cells.pop(axis).strip() for axis in _OTHERS if axis in cells}
    components = tuple((axis, str(table.parent / other)) for axis, other in others.items() if other)
    for key, file in ((_FILE, path), *components):
        if not named_file("motions", file).is_file():
            raise InputError(table, f"{place}, {key}", f"expected a file below {table.parent}, not '{file}'")
    numbers = {key: float(plain_number(cell) or "nan") for key, cell in cells.items()}
    for key, value in numbers.items():
        if not 0.0 < value < np.inf:
            raise InputError(table, f"{place}, {key}", f"expected a number above 0, not '{cells[key]}'")
    return SetRecord(Path(name).name, path, **numbers, event=event, components=components)


@dataclass(frozen=True)
class DrawnMotions:
    """Motions of a case, one for each of its samples."""

    records: tuple  # of SetRecord
    baseline: str | float  # str or float; as for `load_motion`
    scale: float  # multiplies every motion, after any level [1]
    intensity: Intensity
    loaded: dict = field(default_factory=dict)  # motions that were read already, by path and baseline

    @classmethod
    def of(cls, case, loaded=None):
        """Drawn motions of a case of a study, a mapping with ``motion``, ``baseline``, ``scale`` and ``intensity``.

        Raises
        ------
        InputError
            As `read_records`, and levels both in the table and in the case.
        """
        records, target = read_records(case["motion"]), Intensity(**(case.get("intensity") or {}))
        if target.levels and any(one.level or one.scale != 1.0 for one in records):
            raise InputError(case["motion"], "", "expected no scale and no level with intensity.levels")
        drawn = cls(records, case["baseline"], case["scale"], target, {} if loaded is None else loaded)
        if target.spectrum is None:
            return drawn
        motions = [drawn._read(record) for record in records]
        chosen = choose(target.spectrum, records, motions, case["motion"], bool(target.levels))
        return replace(drawn, records=chosen)

    def draw(self, sample, seed):
        """`SetRecord` of a sample by its number.

        Notes
        -----
        Samples take the levels in turn. Those of one level go through all records in a random order before any comes
        twice, so that any first samples of a design are as even over levels and records as they can be. The order
        depends on ``seed``, the names of the records and the level's place.
        """
        levels = self.intensity.levels or (None,)
        turn, place = divmod(int(sample), len(levels))
        turn, within = divmod(turn, len(self.records))
        digest = content_digest("records", seed, place, turn, [record.name for record in self.records])
        raw = np.random.PCG64(int(digest, 16)).random_raw(len(self.records))
        record = self.records[int(np.argsort(raw, kind="stable")[within])]
        return record._replace(level=levels[place] or record.level)

    def motion(self, record):
        """`GroundMotion` of a record, at its level or with its scale, times that of the case.

        All records of a set begin at one time: those without a zero pad, or with a shorter one, rest until then.
        """
        motion, factor = self._read(record), record.scale
        if record.level is not None:
            own = self.intensity.of(motion)
            if own == 0.0:
                raise InputError(record.path, "", "expected a motion along x, to be scaled to a level")
            factor = record.level / own
        return scaled(self._in_step(motion), factor * self.scale, record.path)

    def _in_step(self, motion):
        start = max(self._read(one).attributes.get(_BEGINS, 0.0) for one in self.records)
        late = start - motion.attributes.get(_BEGINS, 0.0)
        if late == 0.0:
            return motion
        return replace(motion.delayed(late), attributes={**motion.attributes, _BEGINS: start})

    def _read(self, record):
        key = record.path, self.baseline
        if key not in self.loaded:
            self.loaded[key] = load_motion(
                record.path, baseline=self.baseline, components=dict(record.components)
            )
        return self.loaded[key]

    def weakest_own(self):
        """Smallest intensity of the records as they are, before any level."""
        return min(self.intensity.of(self._read(one)) for one in self.records)

    def strongest(self):
        """Generator of every record's motion, at the highest level."""
        (highest,) = self.intensity.levels[-1:] or (None,)
        yield from (self.motion(one._replace(level=highest or one.level)) for one in self.records)
