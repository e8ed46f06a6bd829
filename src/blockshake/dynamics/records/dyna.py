"""ESM and ITACA "DYNA 1.2" ASCII: header lines ``KEY: value``, then one value a line."""

from blockshake.dynamics.records.header_checks import HeaderChecks
from blockshake.dynamics.records.record import SPECTRUM, Record, free_values, positive_number
from blockshake.errors import InputError
from blockshake.tables.units import unit_size

# header key -> name in our outputs
_METADATA = {
    "EVENT_NAME": "event",
    "EVENT_ID": "event_id",
    "EVENT_DATE_YYYYMMDD": "event_date",
    "MAGNITUDE_W": "moment_magnitude",
    "EPICENTRAL_DISTANCE_KM": "epicentral_distance_km",
    "NETWORK": "network",
    "STATION_CODE": "station",
    "STREAM": "stream",
    "PROCESSING": "processing",
    "LOW_CUT_FREQUENCY_HZ": "low_cut_frequency",
    "HIGH_CUT_FREQUENCY_HZ": "high_cut_frequency",
    "DATA_LICENSE": "licence",
    "DATA_CITATION": "citation",
}


def is_dyna(text):
    """Whether a text looks like a DYNA file."""
    return any(
        line.startswith(("SAMPLING_INTERVAL_S:", "HEADER_FORMAT: DYNA")) for line in text.split("\n")[:80]
    )


def read_dyna(text, where):
    """Records, a list of one, from the text of an ESM or ITACA file.

    The header is read by key, never by line number: the 64 lines of version 1.2 differ between
    providers in order and number.

    Raises
    ------
    InputError
        A needed key is missing, wrong or twice, the data are not accelerations, a value is not a finite
        number, their number differs from ``NDATA``, or the length, the peak or its time from the header's.
    """
    lines = text.split("\n")
    header = {}
    first = len(lines)
    for index, line in enumerate(lines):
        key, colon, value = line.partition(":")
        if not colon:
            first = index
            break
        if header.setdefault(key.strip().upper(), value.strip()) != value.strip():
            wrong = "expected this key once, found two values"
            raise InputError(where, f"line {index + 1}, {key.strip()}", wrong)
    for key in ("SAMPLING_INTERVAL_S", "NDATA", "UNITS", "DATA_TYPE"):
        if not header.get(key):
            raise InputError(where, key, "expected this key in the header, with a value")
    if not header["DATA_TYPE"].upper().endswith("ACCELERATION") or SPECTRUM.search(header["DATA_TYPE"]):
        raise InputError(where, "DATA_TYPE", f"expected ACCELERATION, found '{header['DATA_TYPE']}'")
    unit = float(unit_size("acceleration", header["UNITS"], where, "UNITS"))
    step = positive_number(header["SAMPLING_INTERVAL_S"], where, "SAMPLING_INTERVAL_S")
    count = positive_number(header["NDATA"], where, "NDATA", int)
    values = unit * free_values(lines, first, count, where, "NDATA")
    checks = HeaderChecks(where, values, step)
    checks.length("DURATION_S", header.get("DURATION_S"))
    for key in header:
        if key.startswith("PGA_"):
            checks.peak(
                key, header[key], float(unit_size("acceleration", key.removeprefix("PGA_"), where, key))
            )
    checks.peak_time("TIME_PGA_S", header.get("TIME_PGA_S"))
    metadata = {name: header[key] for key, name in _METADATA.items() if header.get(key)}
    return [Record(values, step, "ESM/ITACA DYNA 1.2", checks.made, metadata=metadata)]
