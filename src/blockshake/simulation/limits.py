"""Limits of a run, held against the settings before anything is computed or allocated."""

import numpy as np

from blockshake.errors import Argument, InputError
from blockshake.measurement.sensors.accelerometers import FINE_RATE, accelerometer_channels
from blockshake.simulation.models import model_of

LARGEST_RUN = 8 * 2**30  # bytes, of the numbers in a run file, or in memory
MOST_STEPS = 1e11  # days of computing
LONGEST_STEP = 0.01  # s


def has_fine_record(structure):
    """Whether a structure has sensors that are read from a record at `FINE_RATE`."""
    return bool(structure.file.accelerometers or structure.file.displacement_transducers)


def check_limits(structure, model, time_step, duration, output_rate, fine, in_memory):
    """Refuse a run that cannot end, cannot be held, or is not of its model.

    The structure has the parameters of the run; ``time_step`` and ``duration`` [s], ``output_rate`` [Hz]; ``fine``:
    sensors are read from a record at `FINE_RATE`, which is held in memory or on disk.

    Raises
    ------
    InputError
        A number that is not positive, an output rate without a row after the start, a step longer than an impact, more
        than `MOST_STEPS` steps, more than `LARGEST_RUN` bytes, or a free block whose material lacks a property that the
        model is named after.
    """
    for name, value in (("time_step", time_step), ("duration", duration), ("output_rate", output_rate)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(Argument(name), "", f"expected a positive number, not {value}")
    if duration * output_rate < 1.0 - 1e-9:
        wrong = f"expected at least {1.0 / duration:g} Hz of {duration:g} s, not {output_rate:g}"
        raise InputError(Argument("output_rate"), "", f"{wrong}: a run ends at its last row")
    if time_step > LONGEST_STEP:
        wrong = f"expected at most {LONGEST_STEP:g} s, not {time_step:g}: impacts last less"
        raise InputError(Argument("time_step"), "", wrong)
    if duration / time_step > MOST_STEPS:
        wrong = f"expected at most {MOST_STEPS:.0e} steps, not {duration / time_step:.2g}"
        raise InputError(Argument("time_step"), "", f"{wrong}: {duration:g} s in steps of {time_step:g} s")
    rows = duration * output_rate, duration * FINE_RATE * fine
    size = run_bytes(structure, *rows, in_memory)
    if size > LARGEST_RUN:
        rate, name = (FINE_RATE, "duration") if rows[1] > rows[0] else (output_rate, "output_rate")
        wrong = f"expected a run of at most {LARGEST_RUN / 1e9:.2g} GB, not {size / 1e9:.2g} GB"
        raise InputError(Argument(name), "", f"{wrong}: {duration:g} s at {rate:g} Hz")
    for name in model_of(model).needed:
        for body in structure.file.bodies:
            if not (body.driven or getattr(structure.file.materials[body.material], name)):
                key = f"materials.{body.material}.{name}"
                raise InputError(structure.source, key, f"expected above 0 for {model}, not 0")


def run_bytes(structure, rows, fine_rows, in_memory):
    """Bytes of the numbers of a run, from the numbers of its rows and of the states that sensors are read from."""
    state = 13 * len(structure.mass) + 7 + 3 * np.count_nonzero(np.triu(structure.touching))
    read = len(accelerometer_channels(structure)) + len(structure.file.displacement_transducers)
    markers = 3 * len(structure.file.markers)
    return 8.0 * (rows * (state + markers) + fine_rows * (read + state * in_memory))
