"""Forty made-up records of twenty events, to try the study of the statue with: ``python records.py FOLDER``.

Coloured noise under an envelope; no earthquake made them. Each has two horizontal components and its event.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

COUNT, STEP, LENGTH = 40, 0.01, 10.0  # records; s, s


def record(number):
    """Accelerations of one record along x and y, a table [m/s2]."""
    draw = np.random.default_rng(number)
    time = np.arange(round(LENGTH / STEP) + 1) * STEP
    frequency = np.fft.rfftfreq(len(time), STEP)
    corner, ground = np.exp(draw.normal(np.log(0.4), 0.4)), np.exp(draw.normal(np.log(4.0), 0.3))  # Hz
    frequency[0] = frequency[1]
    shape = 1.0 / (1.0 + (corner / frequency) ** 6) / (1.0 + (frequency / ground) ** 4) / frequency**2
    envelope = np.clip(time / 1.5, 0.0, 1.0) ** 3 * np.exp(-np.clip(time - 3.0, 0.0, None) / 1.5)
    columns = {"time_s": time}
    for axis, share in (("x", 1.0), ("y", 0.8)):
        displacement = envelope * np.fft.irfft(shape * np.fft.rfft(draw.normal(size=len(time))), len(time))
        acceleration = np.gradient(np.gradient(displacement, STEP), STEP)  # at rest at both ends
        strength = share * 2.0 * np.exp(draw.normal(0.0, 0.3)) / np.abs(acceleration).max()
        columns[f"acceleration_{axis}"] = strength * acceleration
    return pd.DataFrame(columns)


def main(folder):
    """Write the records and ``set.csv``, which names the event of each."""
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(COUNT):
        record(number).round(5).to_csv(folder / f"record-{number + 1:02}.csv", index=False)
    files = [f"record-{number + 1:02}.csv" for number in range(COUNT)]
    events = [f"event {number // 2 + 1}" for number in range(COUNT)]
    pd.DataFrame({"file": files, "event": events}).to_csv(folder / "set.csv", index=False)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "records"))
