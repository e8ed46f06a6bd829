"""Small made-up files of each record format, with known content; nothing of the package helps to write them."""

import numpy as np

STEP = 0.01
COUNT = 500


def series(count=COUNT):
    """A wavelet in the units of a file, rounded to what the formats hold; its peak is below zero."""
    time = STEP * np.arange(count)
    return np.round(-80.0 * np.cos(2.0 * np.pi * 1.5 * (time - 2.53)) * np.exp(-((time - 2.5) ** 2)), 3)


def peak_of(values):
    """Value of largest magnitude, and its time."""
    place = int(np.argmax(np.abs(values)))
    return float(values[place]), place * STEP


def rows(cells, columns):
    """Cells as lines of some columns."""
    return ["".join(cells[start : start + columns]) for start in range(0, len(cells), columns)]


def dyna(values, **changes):
    header = {f"USER{number}": "" for number in range(1, 65)}
    peak, time = peak_of(values)
    known = {
        "EVENT_NAME": "MADE UP",
        "EVENT_ID": "XX-2000-0001",
        "EVENT_TIME_HHMMSS": "01:02:03",
        "MAGNITUDE_W": "6.3",
        "EPICENTRAL_DISTANCE_KM": "25.0",
        "STATION_CODE": "ABC",
        "SAMPLING_INTERVAL_S": f"{STEP:.6f}",
        "NDATA": str(len(values)),
        "DURATION_S": f"{STEP * len(values):.3f}",
        "STREAM": "HNE",
        "UNITS": "cm/s^2",
        "PGA_CM/S^2": f"{peak:.6f}",
        "TIME_PGA_S": f"{time:.6f}",
        "HEADER_FORMAT": "DYNA 1.2",
        "DATA_TYPE": "ACCELERATION",
        "DATA_LICENSE": "CC BY 4.0",
        **changes,
    }
    lines = [f"{key}: {value}" for key, value in known.items() if value is not None]
    lines += [f"{key}: " for key in list(header)[: 64 - len(lines)]]
    return "\n".join([*lines, *(f"{value:.6f}" for value in values)]) + "\n"


def at2(values, units="G", sizes=None, cells=None):
    lines = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        "MADE UP, 1/1/2000, NOWHERE, 90",
        f"ACCELERATION TIME SERIES IN UNITS OF {units}",
        sizes or f"NPTS=  {len(values):5d}, DT=   {STEP:.4f} SEC,",
        *rows(cells or [f"{value:15.7E}" for value in values], 5),
    ]
    return "\n".join(lines) + "\n"


def cosmos(
    values,
    units="cm/s^2 (4)",
    channels=1,
    entries=(),
    approx=None,
    count=None,
    layout="8F9.3",
    text="",
    of=1.0,
):
    """``entries`` of the real header replace those that hold; ``of`` is the unit of the values in cm/s2."""
    peak, time = peak_of(values)
    real = np.full(100, -999.0)
    real[33:35] = 0.005, STEP * len(values)  # of the raw record
    real[61:65] = 1000.0 * STEP, STEP * len(values), peak, time
    for number, value in dict(entries).items():
        real[number - 1] = value
    columns, width = int(layout.split("F")[0]), int(layout.split("F")[1].split(".")[0])
    decimals = int(layout.split(".")[1])
    lines = []
    for channel in range(1, channels + 1):
        lines += [
            "Corrected acceleration    (Format v01.20 with 13 text lines) Src: made up",
            "Made up event",
        ]
        lines += [f"text {number}" for number in range(3, 9)]
        lines += [f"Sta Chan {channel:3d}: {90 * channel} Deg  (Rcrdr Chan {channel:2d}) Location: ground"]
        lines += [
            f"Raw record length = {STEP * len(values):7.3f} sec, Uncor max =    101730, at   1.000 sec."
        ]
        lines += [f"Processed: made up, Max = {of * peak:9.3f} cm/sec2 at {time:8.3f} sec", text, "text 13"]
        lines += [" 100 Integer-header values follow on  10 lines, Format= (10I8)"]
        lines += ["".join(f"{-999:8d}" for _ in range(10))] * 10
        lines += [" 100 Real-header values follow on  20 lines, Format= (5F15.6)"]
        lines += rows([f"{value:15.6f}" for value in real], 5)
        lines += ['   1 Comment line(s) follow, each starting with a "|":', "| made up"]
        seconds = round(STEP * len(values)) if approx is None else approx
        for kind in ("acceleration", "velocity"):
            lines += [
                f"   {count or len(values)} {kind} pts, approx  {seconds} secs, units={units},Format=({layout})"
            ]
            shown = values * (1.0 + 0.5 * (channel - 1)) if kind == "acceleration" else np.zeros_like(values)
            lines += rows([f"{value:{width}.{decimals}f}" for value in shown], columns)
        lines += [f"End-of-data for Chan  {channel} acceleration"]
        real[63] *= (1.0 + 0.5 * channel) / (1.0 + 0.5 * (channel - 1))
        peak = real[63]
    return "\n".join(lines) + "\n"


def csmip(values, units=", in cm/sec2. (8f10.5)", channels=1, **changes):
    """Text and reals of the newer files; ``changes`` replace the parts that contradict something."""
    lines = []
    for channel in range(1, channels + 1):
        shown = values * (1.0 + 0.5 * (channel - 1))
        peak, time = peak_of(shown)
        said = {
            "count": len(values), "points": len(values), "step": f"{STEP:.3f}", "interval": f"{STEP:.3f}",
            "peak": f"{peak:.3f}", "time": f"{time:.3f}", "reals": {}, "width": 10, "columns": 8, "decimals": 5,
            **changes,
        }  # fmt: skip
        real = np.full(100, -999.0)
        real[52:54] = 0.005, STEP * len(values)  # of the raw record
        real[59:61] = STEP * len(values), STEP
        real[64:66] = time, peak
        for number, value in said["reals"].items():
            real[number - 1] = value
        lines += [
            f"Corrected accelerogram   made up           Chan  {channel}: {90 * channel} Deg    from   "
        ]
        lines += ["Uncorrected Accelerogram Data             Processed: made up", "Record of a made up event"]
        lines += [f"text {number}" for number in range(4, 12)]
        lines += [f"                        Record length = {STEP * len(values) + 3.0:.3f} sec.", "text 13"]
        lines += [
            "RMS accel of (uncor) record  =        .   Chn. metadata effective date: 08/10/05",
            "text 15",
        ]
        lines += [
            f"{said['points']:6d} points of instrument- and baseline-corrected accel, veloc and displ data "
        ]
        lines += [f"At equally-spaced intervals of    {said['interval']}  sec."]
        lines += [f"Peak acceleration = {said['peak']:>9}    cm/sec/sec  at   {said['time']}   sec."]
        lines += ["Peak   velocity   =     3.150      cm/sec    at   30.650   sec.", *["text"] * 6]
        lines += rows([f"{number:5d}" for number in range(100)], 16)
        lines += rows([f"{value:10.5f}" for value in real], 8)
        for kind in ("accel", "veloc", "displ"):
            lines += [
                f"{said['count']:6d} points of {kind} data equally spaced at {said['step']} sec{units}    "
            ]
            cells = shown if kind == "accel" else np.zeros_like(values)
            lines += rows(
                [f"{value:{said['width']}.{said['decimals']}f}" for value in cells], said["columns"]
            )
        lines += [f"/&  ----------  End of data for channel  {channel}  ----------"]
    return "\n".join(lines) + "\n"


KNET_SCALE = 2000.0 / 8388608.0  # gal


def knet(counts, direction="E-W", **changes):
    """``counts`` are whole numbers with an offset, as the recorder gives them."""
    known = {
        "Origin Time": "2000/01/01 00:00:00", "Lat.": "41.0", "Long.": "142.5", "Depth. (km)": "30", "Mag.": "6.2",
        "Station Code": "ABC001", "Station Lat.": "41.4087", "Station Long.": "141.4486", "Station Height(m)": "30",
        "Record Time": "2000/01/01 00:00:37", "Sampling Freq(Hz)": f"{round(1.0 / STEP)}Hz",
        "Duration Time(s)": f"{round(len(counts) * STEP)}", "Dir.": direction, "Scale Factor": "2000(gal)/8388608",
        "Max. Acc. (gal)": f"{KNET_SCALE * np.abs(counts - np.mean(counts)).max():.3f}",
        "Last Correction": "2000/01/01 00:00:37", "Memo.": "", **changes,
    }  # fmt: skip
    lines = [f"{key:<18}{value}" for key, value in known.items() if value is not None]
    return "\n".join([*lines, *rows([f"{count:8d} " for count in counts], 8)]) + "\n"


def _e1(value, digits):
    """A number with an exponent of one digit, as Fortran's 1PE10.4E1."""
    mantissa, exponent = f"{value:.{digits}E}".split("E")
    return f"{mantissa}E{int(exponent):+d}".rjust(digits + 6)


def smc(values, kind="2 CORRECTED ACCELEROGRAM", whole=(), real=(), precise=False, peak=None):
    """``whole`` and ``real`` replace numbers of the headers, by their place from 1."""
    wholes = np.full(48, -32768)
    wholes[[15, 16]] = 2, len(values)
    reals = np.full(50, 1.7e38)
    reals[1] = 1.0 / STEP
    reals[28:32] = (
        STEP * np.argmax(values), values.max(), STEP * np.argmin(values), values.min(),
    )  # fmt: skip
    if precise:
        wholes[46] = 8
    for number, value in dict(whole).items():
        wholes[number - 1] = value
    for number, value in dict(real).items():
        reals[number - 1] = value
    lines = [
        kind.ljust(80),
        "*",
        "ABC",
        "     2000   1   1    0000 Nowhere",
        "Moment Mag=      7.1 Ms=      7.1",
    ]
    lines += ["station = Made up                         component=    360"]
    lines += [f"epicentral dist =     89.0       pk     = {peak or f'{np.abs(values).max():8.1f}'}"]
    lines += ["inst type=SMA-1      data source = USGS", "*", "*", "*"]
    lines += rows([f"{value:10d}" for value in wholes], 8)
    lines += rows([f"{value:15.7E}" for value in reals], 5)
    lines += ["|", "|made up"]
    lines += rows([_e1(value, 7 if precise else 4) for value in values], 5 if precise else 8)
    return "\n".join(lines) + "\n"
