"""Records made up with a known exact displacement, in PEER's format."""

import numpy as np

G = 9.80665  # m/s2
STEP = 0.02  # s
ROWS = 1501
TIME = STEP * np.arange(ROWS)
SIZE = 0.05  # m, of the wavelet's displacement


def wavelet(start):
    """Displacement ``SIZE sin^4(pi x)``, x = (t - start) / 0.8 s, and its acceleration, by calculus."""
    x = np.clip((TIME - start) / 0.8, 0.0, 1.0)
    sine, cosine = np.sin(np.pi * x), np.cos(np.pi * x)
    return SIZE * sine**4, SIZE * (np.pi / 0.8) ** 2 * 4.0 * sine**2 * (3.0 * cosine**2 - sine**2)


def printed(values, digits=7, fixed=False, cut=False):
    """Texts of values: so many significant digits, or decimals where ``fixed``; rounded, or ``cut`` off."""
    if fixed:
        values = np.trunc(values * 10.0**digits) / 10.0**digits if cut else values
        return [f"{value:12.{digits}f}" for value in values]
    if cut:
        last = 10.0 ** (np.floor(np.log10(np.where(values == 0.0, 1.0, np.abs(values)))) + 1 - digits)
        values = np.trunc(values / last) * last
    return [f"{value:16.{digits - 1}E}" for value in values]


def write_at2(path, acceleration, step=STEP, **style):
    """AT2 file of an acceleration [m/s2]; its path."""
    texts = printed(acceleration / G, **style)
    lines = [
        "MADE UP",
        "MADE UP, 1/1/2000, NOWHERE, 90",
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {len(texts)}, DT= {step:.4f} SEC",
        *("".join(texts[row : row + 5]) for row in range(0, len(texts), 5)),
    ]
    path.write_text("\n".join(lines) + "\n")
    return path
