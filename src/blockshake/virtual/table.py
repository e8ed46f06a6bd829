"""A table that does not quite follow its command, as real ones do not."""

import numpy as np
from pydantic import Field
from scipy.interpolate import CubicSpline
from scipy.signal import lsim

from blockshake.effects.registry import with_effect
from blockshake.validation import Finite, Positive, Strict


class TableErrors(Strict):
    """How the table errs; the defaults follow the command exactly."""

    gain: Positive = Field(1.0, description="displacement along x over the command, far below the corner [1]")
    high: Finite = Field(0.0, description="by how much more or less that is far above the corner [1]")
    corner: Positive = Field(2.0, description="frequency between the two [Hz]")
    pitch: Finite = Field(0.0, description="static pitch by acceleration along x [rad s2/m]")


def followed(experiment, table):
    """The experiment on a table that errs.

    Parameters
    ----------
    experiment : Experiment
    table : TableErrors

    Returns
    -------
    Experiment

    Notes
    -----
    ``H(f) = gain + high i f / (f_c + i f)`` on the displacement along x: the gain goes over from one value to the other
    around the corner frequency, with the phase of a first-order filter. The pitch is that of the effect `table-pitch`.
    """
    breaks = experiment.motion.table.breaks
    times = np.linspace(breaks[0], breaks[-1], round(np.ptp(breaks) / np.diff(breaks).min()) + 1)
    command = experiment.motion.evaluate(times)[:, 0]
    command = command - command[0]
    omega = 2.0 * np.pi * table.corner
    _, slow, _ = lsim(([omega], [1.0, omega]), command, times)
    change = np.interp(breaks, times, (table.gain - 1.0) * command + table.high * (command - slow))
    experiment = experiment.with_motion(0, CubicSpline(breaks, change).c[::-1].T)
    if table.pitch == 0.0:
        return experiment
    return with_effect(experiment, "table-pitch", {"coefficient": table.pitch}, {})
