"""A stack under one cycle of sine by LS-DEM, and its readings."""

import numpy as np
from kicked_block import RATE, leans, zeros

from blockshake.dynamics.motion import ground_motion
from blockshake.dynamics.system import Status
from blockshake.simulation.energy_residual import energy_residual
from blockshake.solvers.ls_dem.driver import simulate_ls_dem

SHAKING = {
    "acceleration": 2.5,
    "frequency": 1.5,
    "duration": 4.0,
}  # m/s2, Hz, s: rocks configuration 1, topples it not
OBSERVABLES = ("peak_drift", "peak_rotation", "upright_time", "end_drift", "energy_residual")
_ROWS = 400  # of the sine


def shaken_stack(structure, parameters, time_step, acceleration, frequency, duration):
    """Shake a structure by one sine of ground acceleration along x.

    Parameters
    ----------
    structure : Structure
    parameters : LsDemParameters
    time_step : float
        [s]
    acceleration, frequency : float
        Amplitude [m/s2] and frequency [Hz] of the one cycle, which begins towards +x.
    duration : float
        Window; the ground rests after the cycle [s].

    Returns
    -------
    dict of str to float
        ``sink`` of the highest body in the equilibrium that the run starts from [m]; of its displacement along x
        relative to the first driven body, the drift: ``peak_drift`` [m], ``upright_time`` of its first zero
        after the peak [s] and ``end_drift`` at the end of the window [m]; ``peak_rotation`` of the lowest free
        body about y [rad]; ``energy_residual`` [1]. NaN where the run did not complete, but for the sink.
    """
    times = np.arange(round(duration * RATE) + 1) / RATE
    run = simulate_ls_dem(structure, sine(acceleration, frequency), parameters, times, time_step)
    free = np.flatnonzero(~structure.driven)
    height = structure.position[free, 2]
    top, lowest = free[np.argmax(height)], free[np.argmin(height)]
    base = int(np.flatnonzero(structure.driven)[0])
    read = {"sink": float(structure.position[top, 2] - run.position[0, top, 2])} | dict.fromkeys(
        OBSERVABLES, np.nan
    )
    if run.status != Status.COMPLETED:
        return read
    along = run.position[:, :, 0] - structure.position[:, 0]
    drift = along[:, top] - along[:, base]
    peak = int(np.argmax(np.abs(drift)))
    upright = zeros(times[peak:], drift[peak:])
    return read | {
        "peak_drift": float(np.abs(drift[peak])),
        "peak_rotation": float(np.abs(leans(run.orientation[:, lowest])).max()),
        "upright_time": float(upright[0]) if len(upright) else np.nan,
        "end_drift": float(drift[-1]),
        "energy_residual": energy_residual(run.energy),
    }


def sine(acceleration, frequency):
    """One cycle of ground acceleration along x, after which the ground is at rest again elsewhere."""
    time = np.linspace(0.0, 1.0 / frequency, _ROWS + 1)
    values = acceleration * np.sin(2.0 * np.pi * frequency * time)
    return ground_motion("sine", time, {"x": values}, "acceleration")
