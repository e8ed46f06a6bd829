"""CPU time of simulations on this machine, by trying them."""

import time

import numpy as np

from blockshake.dynamics.motion import GroundMotion, MotionTable
from blockshake.simulation.simulate import simulate

_LONGEST = 10.0  # CPU s; a run that takes longer is tried in part, where few are requested
_MANY = 50  # runs; trying one of so many costs 2 % of them
_PARTS = 0.2, 0.4  # s of strong motion; the second less the first is free of a run's set-up


def run_seconds(structure, motion, settings, duration, runs):
    """CPU seconds of one simulation.

    Parameters
    ----------
    structure : Structure
    motion : GroundMotion
        Scaled.
    settings : dict
        ``model``, ``parameters`` and ``time_step`` of `simulate`.
    duration : float
        [s]
    runs : int
        How many such simulations are requested.

    Returns
    -------
    float
        [s], without the loading of compiled kernels.

    Notes
    -----
    A run that would take longer than 10 s is tried in its strongest part alone where fewer than 50 are requested, and
    counted as if all of it were as strong. That is off: in the paper's study it gave 0.6 (rigid blocks, configuration
    4) to 2.3 times (elastic blocks, configuration 2) the CPU time of the whole run.
    """

    def seconds(shaken, until):
        return cpu_seconds(
            lambda: simulate(structure, shaken, duration=until, accelerometers=False, **settings)
        )

    strong = from_strongest(motion)
    seconds(strong, 0.01)  # loads the kernels
    if runs >= _MANY:
        return seconds(motion, duration)
    first, second = (seconds(strong, min(part, duration)) for part in _PARTS)
    rate = (second - first) / (_PARTS[1] - _PARTS[0])
    return seconds(motion, duration) if rate * duration < _LONGEST else rate * duration


def from_strongest(motion):
    """Motion from its strongest acceleration on, seen by an observer who moves as the table then does."""
    breaks, coefficients = motion.table
    start = int(np.abs(motion.evaluate(breaks, 2)[:-1, :3]).max(axis=1).argmax())
    kept, since = coefficients[start:].copy(), (breaks[start:-1] - breaks[start])[:, None]
    place, velocity = kept[0, :, 0].copy(), kept[0, :, 1].copy()
    kept[:, :, 0] -= place + velocity * since
    kept[:, :, 1] -= velocity
    return GroundMotion(motion.name, MotionTable(breaks[start:] - breaks[start], kept), motion.kind)


def cpu_seconds(call):
    """CPU seconds that a call takes."""
    started = time.process_time()
    call()
    return time.process_time() - started
