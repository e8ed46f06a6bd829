"""Parsers of motion files, one a format, that know nothing of the package: the columns that a file states, in SI."""

import csv
import io
import math
import re

import numpy as np

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"
_UNITS = {
    "cms2": 0.01, "cmss": 0.01, "cms-2": 0.01, "gal": 0.01, "gals": 0.01, "ms2": 1.0, "mss": 1.0, "ms-2": 1.0,
    "mms2": 0.001, "mmss": 0.001, "g": 9.80665, "gs": 9.80665, "mg": 9.80665e-3, "%g": 9.80665e-2,
}  # fmt: skip


def text_of(content):
    """Text of bytes as programs write them."""
    for encoding in (
        ("utf-16",) if content[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "cp1252", "latin-1")
    ):
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    return content.decode("latin-1")


def stated_columns(name, content):
    """Times from zero and columns by name, as the digits of the file say.

    Raises
    ------
    ValueError, IndexError, AttributeError, KeyError
        The file states nothing that can be read.
    """
    return _PARSERS[name](re.sub("\r\n?", "\n", text_of(content)))


def _number(text):
    text = text.strip()
    if not re.fullmatch(_NUMBER, text, re.ASCII):
        raise ValueError(text)
    return float(re.sub("[dD]", "e", text))


def _unit(text):
    """Size of the unit that a text begins with."""
    words = text.split()
    for count in range(min(5, len(words)), 0, -1):
        letters = re.sub(r"\(\s*\d+\s*\)\s*$", "", " ".join(words[:count]).lower().replace("²", "2"))
        letters = re.sub(r"[^a-z0-9%-]", "", letters).replace("sec", "s")
        if letters in _UNITS:
            return _UNITS[letters]
    raise ValueError(text)


def _even(values, step):
    return step * np.arange(len(values)), {"acceleration_x": np.array(values)}


def _csv(text):
    table = [
        [cell.strip() for cell in row] for row in csv.reader(io.StringIO(text)) if any(map(str.strip, row))
    ]
    columns = {
        name: np.array([_number(row[place]) for row in table[1:]]) for place, name in enumerate(table[0])
    }
    time = columns.pop("time_s")
    return time - time[0], columns


def _at2(text):
    lines = text.split("\n")
    last = next(place for place, line in enumerate(lines) if place > 2 and "NPTS" in line.upper())
    unit = _unit(
        re.search(r"accel.*?units?\b\s*(?:of|in|[:=])?\s*(.*)", lines[last - 1], re.IGNORECASE).group(1)
    )
    count = int(re.search(r"npts\s*=\s*([^\s,;]+)", lines[last], re.IGNORECASE).group(1).removesuffix("."))
    step = re.search(r"\bdt\s*=\s*([^\s,;]+?)(?=m?sec\b|[\s,;]|$)[\s,;]*([a-z]*)", lines[last], re.IGNORECASE)
    size = {"s": 1.0, "sec": 1.0, "": 1.0, "npts": 1.0, "min": 60.0, "ms": 1e-3}[step.group(2).lower()]
    values = [unit * _number(text) for text in re.findall(_NUMBER, "\n".join(lines[last + 1 :]))]
    if len(values) != count:
        raise ValueError(count)
    return _even(values, size * _number(step.group(1)))


def _dyna(text):
    lines = text.split("\n")
    last = next(place for place, line in enumerate(lines) if ":" not in line)
    header = dict(line.split(":", 1) for line in lines[:last])
    header = {key.strip().upper(): value.strip() for key, value in header.items()}
    values = [_unit(header["UNITS"]) * _number(text) for text in re.findall(_NUMBER, "\n".join(lines[last:]))]
    if len(values) != int(header["NDATA"]):
        raise ValueError(header["NDATA"])
    return _even(values, _number(header["SAMPLING_INTERVAL_S"]))


def _cut(lines, width):
    """Cells of lines at a fixed width."""
    return [line[start : start + width] for line in lines for start in range(0, len(line.rstrip()), width)]


def _series(lines, place, count):
    """Values below a line, eight a line."""
    cells = [cell for line in lines[place + 1 : place + 1 + math.ceil(count / 8)] for cell in line.split()]
    if len(cells) != count:
        raise ValueError(count)
    return [_number(cell) for cell in cells]


def _cosmos(text):
    lines = text.split("\n")
    place = next(
        number
        for number, line in enumerate(lines)
        if re.match(r"\s*\d+ +acceleration p", line, re.IGNORECASE)
    )
    reals = max(number for number, line in enumerate(lines[:place]) if "real-header" in line.lower())
    cells = _cut(lines[reals + 1 : reals + 21], 15)
    count = int(lines[place].split()[0])
    step = _number(cells[61]) / 1000.0 if _number(cells[61]) != -999.0 else _number(cells[62]) / count
    unit = _unit(re.search(r"units\s*=\s*(.+?)\s*,", lines[place], re.IGNORECASE).group(1))
    return _even([unit * value for value in _series(lines, place, count)], step)


def _csmip(text):
    lines = text.split("\n")
    said = [
        re.match(r"\s*(\d+) points of accel\S* data .*? at +(\S+) +sec, *in *([^(]*)", line, re.IGNORECASE)
        for line in lines
    ]
    place = next(number for number, match in enumerate(said) if match)
    values = _series(lines, place, int(said[place].group(1)))
    return _even([_unit(said[place].group(3)) * value for value in values], _number(said[place].group(2)))


def _knet(text):
    lines = text.split("\n")
    last = next(place for place, line in enumerate(lines) if re.match(r"\s*[-\d]", line))
    said = {key: next(line[len(key) :] for line in lines[:last] if line.startswith(key)) for key in (
        "Sampling Freq(Hz)", "Scale Factor", "Duration Time(s)")}  # fmt: skip
    frequency = _number(re.sub("hz$", "", said["Sampling Freq(Hz)"].strip().lower()))
    over, unit, under = re.fullmatch(r"\s*(.+?)\s*\((.*)\)\s*/\s*(.*?)\s*", said["Scale Factor"]).groups()
    values = [_unit(unit) * _number(over) / _number(under) * _number(text) for text in
              re.findall(_NUMBER, "\n".join(lines[last:]))]  # fmt: skip
    if len(values) != round(_number(said["Duration Time(s)"]) * frequency):
        raise ValueError(frequency)
    return _even(values, 1.0 / frequency)


def _smc(text):
    lines = text.split("\n")
    whole, real = _cut(lines[11:17], 10), _cut(lines[17:27], 15)
    first, count = 27 + int(_number(whole[15])), int(_number(whole[16]))
    cells = _cut(lines[first : first + math.ceil(count / 8)], 10)
    if len(cells) != count:
        raise ValueError(count)
    return _even([0.01 * _number(cell) for cell in cells], 1.0 / _number(real[1]))


def _table(text):
    """Times and displacements in mm with decimal commas between semicolons, below their names."""
    table = [
        [cell.strip() for cell in row] for row in csv.reader(io.StringIO(text), delimiter=";") if any(row)
    ]
    columns = {}
    for name in ("Zeit", "Weg"):
        cells = [row[table[0].index(name)] for row in table[1:]]
        if any("." in cell for cell in cells):
            raise ValueError("a point is no decimal sign")
        columns[name] = np.array([_number(cell.replace(",", ".")) for cell in cells])
    return columns["Zeit"] - columns["Zeit"][0], {"displacement_x": 0.001 * columns["Weg"]}


_PARSERS = {
    "m.csv": _csv, "m.asc": _dyna, "m.at2": _at2, "m.v2c": _cosmos, "m.v2": _csmip, "m.ew": _knet, "m.smc": _smc,
    "t.txt": _table,
}  # fmt: skip
