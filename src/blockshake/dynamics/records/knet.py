"""K-NET and KiK-net ASCII of NIED, Japan: seventeen header lines, then whole numbers times a scale factor in gal."""

import re

from blockshake.dynamics.records.header_checks import HeaderChecks
from blockshake.dynamics.records.record import Record, free_values, positive_number
from blockshake.errors import InputError
from blockshake.tables.units import unit_size

_KEYS = (
    "Origin Time", "Lat.", "Long.", "Depth. (km)", "Mag.", "Station Code", "Station Lat.", "Station Long.",
    "Station Height(m)", "Record Time", "Sampling Freq(Hz)", "Duration Time(s)", "Dir.", "Scale Factor",
    "Max. Acc. (gal)", "Last Correction", "Memo.",
)  # fmt: skip
_HERTZ = re.compile(r"\s*Hz$", re.IGNORECASE)
_SCALE = re.compile(r"([^\s(]+)\s*\(([^)]*)\)\s*/\s*(\S+)")
_KIK_NET_VERTICAL = ("3", "6")  # directions of KiK-net, in the borehole and at the surface
_METADATA = {"Origin Time": "event", "Mag.": "magnitude", "Station Code": "station", "Dir.": "stream"}


def is_knet(text):
    """Whether a text looks like a K-NET or KiK-net file."""
    return text.lstrip().startswith(_KEYS[0])


def read_knet(text, where):
    """Records, a list of one, from the text of a K-NET or KiK-net file.

    The values keep the sensor's offset, which the file's peak is free of.

    Raises
    ------
    InputError
        A needed header line is missing or wrong, a value is not a finite number, or the number of values or the peak
        contradicts the header.
    """
    lines = text.split("\n")
    header, first = {}, len(lines)
    for index, line in enumerate(lines):
        if not header and not line.strip():
            continue
        key = next((key for key in _KEYS if line.startswith(key)), None)
        if key is None:
            first = index
            break
        if header.setdefault(key, line.removeprefix(key).strip()) != line.removeprefix(key).strip():
            raise InputError(where, f"line {index + 1}, {key}", "expected this line once, found two values")
    frequency, duration, scale = (_KEYS[number] for number in (10, 11, 13))
    for key in (frequency, duration, scale):
        if not header.get(key):
            raise InputError(where, key, "expected this line in the header, with a value")
    step = 1.0 / positive_number(_HERTZ.sub("", header[frequency]), where, frequency)
    factor = _SCALE.fullmatch(header[scale])
    if not factor:
        raise InputError(where, scale, f"expected such as 2000(gal)/8388608, found '{header[scale]}'")
    unit = float(unit_size("acceleration", factor.group(2), where, scale))
    unit *= positive_number(factor.group(1), where, scale) / positive_number(factor.group(3), where, scale)
    count = round(positive_number(header[duration], where, duration) / step)
    values = unit * free_values(lines, first, count, where, duration)
    checks = HeaderChecks(where, values, step)
    checks.peak("Max. Acc. (gal)", header.get("Max. Acc. (gal)"), 0.01)
    metadata = {name: header[key] for key, name in _METADATA.items() if header.get(key)}
    if metadata.get("stream") in _KIK_NET_VERTICAL:
        metadata["stream"] += ", U-D"
    return [Record(values, step, "K-NET/KiK-net ASCII", checks.made, metadata=metadata)]
