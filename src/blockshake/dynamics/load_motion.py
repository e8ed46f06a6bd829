"""A ground motion from a name that ships with the program or from a file of any known format."""

import numpy as np

from blockshake.dynamics.baseline import AUTO, NONE, settle
from blockshake.dynamics.motion import check_finite, ground_motion
from blockshake.dynamics.records.at2 import is_at2, read_at2
from blockshake.dynamics.records.contract_csv import read_motion_csv
from blockshake.dynamics.records.cosmos import is_cosmos, read_cosmos
from blockshake.dynamics.records.dyna import is_dyna, read_dyna
from blockshake.dynamics.synthetic_motion import synthesise
from blockshake.dynamics.synthetic_schema import load_synthetic
from blockshake.errors import InputError
from blockshake.files import named_file, read_text

# content decides; the ending only where a broken file of that format should say what it lacks
_RECORD_FORMATS = (
    (is_dyna, ".asc", read_dyna),
    (is_cosmos, ".v2", read_cosmos),
    (is_at2, ".at2", read_at2),
)


def load_motion(source, scale=1.0, baseline=AUTO):
    """Ground motion from a shipped name or a file.

    Parameters
    ----------
    source : str or path
        ``alkion``, ``basso-tirreno`` (synthetic), a CSV of the project, a record in ESM/ITACA DYNA
        1.2, PEER AT2 or COSMOS V2, or the YAML of a synthetic motion. Content tells the format.
    scale : float
        Multiplies every column [1].
    baseline : str or float
        ``auto``, ``none`` or a corner frequency [Hz], as `settle` takes it: by default a record that does not end at
        rest is corrected, and a CSV never is.

    Returns
    -------
    GroundMotion
        Its time starts at zero: what the file gives as its first time is in the attribute
        ``first_time`` where it is another. A record's component becomes x. The attributes ``baseline`` and, of a
        corrected motion, ``record_start`` are those of `settle`.

    Raises
    ------
    InputError
        Missing file, unknown name, unknown format or unit, NaN, time that does not increase,
        mixed kinds, too few rows, a file cut short, a scale that is not a finite number, a displacement beyond all
        numbers, a correction that cannot be made.
    """
    if not np.isfinite(scale):
        raise InputError(source, "scale", f"expected a finite number, found {scale}")
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # looked at below
        motion = _read(named_file("motions", source), baseline)
        motion = motion if scale == 1.0 else motion.scaled(scale)
    check_finite(motion, source)
    return motion


def _read(path, baseline):
    if path.suffix.lower() in (".yaml", ".yml"):
        if baseline not in (AUTO, NONE):
            raise InputError(
                path, "baseline", f"expected {AUTO} or {NONE} of a synthetic motion, which ends at rest"
            )
        return synthesise(load_synthetic(path))
    text = read_text(path)
    for recognises, _, read in _RECORD_FORMATS:
        if recognises(text):
            return _record_motion(read(text, path), path, baseline)
    for _, ending, read in _RECORD_FORMATS:
        if path.suffix.lower().startswith(ending):
            return _record_motion(read(text, path), path, baseline)
    if "time_s" in text.partition("\n")[0] or path.suffix.lower() == ".csv":
        return settle(_csv_motion(text, path), baseline, path)
    raise InputError(
        path,
        "",
        "expected a motion CSV (time_s, acceleration_x, ...), ESM/ITACA DYNA 1.2, PEER AT2 or COSMOS V2",
    )


def _csv_motion(text, path):
    time, columns, kind = read_motion_csv(text, path)
    attributes = {"source": path.name, "format": "csv", "synthetic": False}
    if time[0] != 0.0:
        attributes["first_time"] = float(time[0])
    return ground_motion(path.stem, time - time[0], columns, kind, attributes)


def _record_motion(record, path, baseline):
    time = record.time_step * np.arange(len(record.acceleration))
    attributes = {"source": path.name, "format": record.format, "synthetic": False, **record.metadata}
    motion = ground_motion(path.stem, time, {"x": record.acceleration}, "acceleration", attributes)
    check_finite(motion, path)
    return settle(motion, baseline, path, published=True)
