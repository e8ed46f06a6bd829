"""Small made-up files of each record format, with known content."""

import numpy as np

STEP = 0.01


def series(count=500):
    """A wavelet in the units of a file, rounded to what the formats hold."""
    time = STEP * np.arange(count)
    return np.round(80.0 * np.sin(2.0 * np.pi * 1.5 * time) * np.exp(-((time - 2.5) ** 2)), 3)


def dyna(values, **changes):
    header = {f"USER{number}": "" for number in range(1, 65)}
    known = {
        "EVENT_NAME": "MADE UP",
        "EVENT_ID": "XX-2000-0001",
        "EVENT_TIME_HHMMSS": "01:02:03",
        "MAGNITUDE_W": "6.3",
        "EPICENTRAL_DISTANCE_KM": "25.0",
        "STATION_CODE": "ABC",
        "SAMPLING_INTERVAL_S": f"{STEP:.6f}",
        "NDATA": str(len(values)),
        "STREAM": "HNE",
        "UNITS": "cm/s^2",
        "HEADER_FORMAT": "DYNA 1.2",
        "DATA_TYPE": "ACCELERATION",
        "DATA_LICENSE": "CC BY 4.0",
        **changes,
    }
    lines = [f"{key}: {value}" for key, value in known.items() if value is not None]
    lines += [f"{key}: " for key in list(header)[: 64 - len(lines)]]
    return "\n".join([*lines, *(f"{value:.6f}" for value in values)]) + "\n"


def at2(values, units="G", sizes=None):
    lines = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        "MADE UP, 1/1/2000, NOWHERE, 90",
        f"ACCELERATION TIME SERIES IN UNITS OF {units}",
        sizes or f"NPTS=  {len(values):5d}, DT=   {STEP:.4f} SEC,",
    ]
    for start in range(0, len(values), 5):
        lines.append("".join(f"{value:15.7E}" for value in values[start : start + 5]))
    return "\n".join(lines) + "\n"


def cosmos(values, units="cm/s^2 (4)", channels=1, interval=1000.0 * STEP):
    real = np.full(100, -999.0)
    real[33] = interval
    lines = ["Corrected acceleration    (Format v01.20 with 13 text lines) Src: made up", "Made up event"]
    lines += [f"text {number}" for number in range(3, 14)]
    lines += [" 100 Integer-header values follow on  10 lines, Format= (10I8)"]
    lines += ["".join(f"{-999:8d}" for _ in range(10))] * 10
    lines += [" 100 Real-header values follow on  20 lines, Format= (5F15.6)"]
    lines += ["".join(f"{value:15.6f}" for value in real[start : start + 5]) for start in range(0, 100, 5)]
    lines += ['   1 Comment line(s) follow, each starting with a "|":', "| made up"]
    seconds = round(STEP * len(values))
    for _ in range(channels):
        for kind in ("acceleration", "velocity"):
            lines += [f"   {len(values)} {kind} pts, approx  {seconds} secs, units={units},Format=(8F9.3)"]
            shown = values if kind == "acceleration" else np.zeros_like(values)
            for start in range(0, len(values), 8):
                lines.append("".join(f"{value:9.3f}" for value in shown[start : start + 8]))
        lines += ["End-of-data for Chan  1 acceleration"]
    return "\n".join(lines) + "\n"
