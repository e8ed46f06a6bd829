"""Phases of a test: quiet, strong and after. Missing effects differ by the phase in which they first show."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

QUIET, STRONG, AFTER = "quiet", "strong", "after"
PHASES = (QUIET, STRONG, AFTER)
ONSET_NOISE = 5.0  # standard deviations of the measurement
TURN_NOISE = 8.0  # standard deviations from turn to turn: noise is there at both ends
_READINGS_IN_A_ROW = 3  # readings in a row that must be beyond: 15 ms at 200 Hz, and no single wrong reading
_REST_SPEED = 0.02  # of the base's peak velocity


@dataclass(frozen=True)
class Phases:
    """Onsets of the joints, and the phases of a test.

    Attributes
    ----------
    slip_onset, rotation_onset : float64 array, shape (n_joints, 2)
        First time at which slip along x, rotation about y goes beyond five standard deviations to the positive
        and to the negative side [s]; infinite where it never does or nobody can know.
    quiet, strong, after : bool arrays, shape (n_times,)
        Before the first onset of any joint (and before the base rests); from then on while the base moves; while
        the base rests for good. They share no time and leave none out.
    """

    slip_onset: np.ndarray
    rotation_onset: np.ndarray
    quiet: np.ndarray
    strong: np.ndarray
    after: np.ndarray

    def mask(self, phase):
        """Times of the phase of this name."""
        return {QUIET: self.quiet, STRONG: self.strong, AFTER: self.after}[phase]


def find_phases(histories):
    """`Phases` of a test, with the onset of every joint.

    Parameters
    ----------
    histories : xarray.Dataset
        From `joint_histories`.

    Notes
    -----
    Onset needs three readings in a row, of which the first counts. With white noise of 2000 readings and 20
    channels a false onset has a chance below 1e-14. The base rests once its velocity stays within 2 % of its peak.
    A joint that only rocks elastically in its contact has no onset until it exceeds the noise as well.
    """
    time = histories["time"].to_numpy()
    slip = histories["slip"].sel(tangent="x").transpose("time", "joint").to_numpy()
    rotation = histories["rotation"].sel(axis="y").transpose("time", "joint").to_numpy()
    slip_onset = _onsets(time, slip, histories["slip_noise"].sel(tangent="x").to_numpy())
    rotation_onset = _onsets(time, rotation, histories["rotation_noise"].sel(axis="y").to_numpy())
    first = min(slip_onset.min(), rotation_onset.min())
    after = time > _rest_from(time, histories["velocity"].to_numpy())
    quiet = (time < first) & ~after
    return Phases(slip_onset, rotation_onset, quiet, ~quiet & ~after, after)


def known_values(values):
    """History (n_times,) with gaps, NaN as at the end of a run cut short, filled and single wrong readings taken out.

    Linear across gaps, the last value held to the end, then the median of three neighbours; zero if nothing is known.
    """
    known = np.isfinite(values)
    if not known.any():
        return np.zeros(len(values))
    places = np.arange(len(values))
    return median_filter(np.interp(places, places[known], values[known]), size=3, mode="nearest")


def _onsets(time, values, noise):
    """First times beyond the noise to each side, (n_joints, 2) [s]."""
    found = np.full((values.shape[1], 2), np.inf)
    for joint in range(values.shape[1]):
        for side, sign in enumerate((1.0, -1.0)):
            with np.errstate(invalid="ignore"):
                beyond = sign * values[:, joint] > ONSET_NOISE * noise[joint]
            run = np.convolve(beyond, np.ones(_READINGS_IN_A_ROW), mode="valid") > _READINGS_IN_A_ROW - 0.5
            if run.any():
                found[joint, side] = time[np.argmax(run)]
    return found


def _rest_from(time, velocity):
    """Last time at which the base still moves [s]; before the first if it never does."""
    speed = np.abs(velocity)
    moving = speed > _REST_SPEED * speed.max()
    return time[np.flatnonzero(moving)[-1]] if moving.any() else time[0] - 1.0
