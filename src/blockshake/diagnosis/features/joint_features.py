"""Features of one joint and of the body above it. The feature table gives the meaning of each."""

import numpy as np
from scipy.ndimage import median_filter

from blockshake.diagnosis.features.coloured_regression import coloured_regression
from blockshake.diagnosis.features.excursions import growth, steps, turning_acceleration
from blockshake.diagnosis.features.phases import ONSET_NOISE, TURN_NOISE, known_values
from blockshake.study.ensembles.ensemble import RESIDUAL_WINDOW

_SPIKES = 5
_SPIKES_APART = 0.05  # s between spikes
_MEDIAN_WINDOW = 0.1  # s
_ROCKING_READINGS_NEEDED = 10  # readings to one side


def told(value, otherwise=0.0):
    """A value with its censoring mark and the error 0. None stands for a value that is not defined."""
    return (float(otherwise), True, 0.0) if value is None else (float(value), False, 0.0)


def slope(response, regressors, place):
    """Slope of one of the regressors beside the others, censored where there are too few readings."""
    coefficients, errors = coloured_regression(response, regressors)
    known = np.isfinite(errors[place])
    return (float(coefficients[place]), False, float(errors[place])) if known else (0.0, True, 0.0)


def joint_features(histories, onsets, quiet, regressors):
    """Features of one joint from its motion.

    Parameters
    ----------
    histories : xarray.Dataset
        From `joint_histories`, one joint of it.
    onsets : (float64 array, float64 array), each shape (2,)
        Of slip and rotation to the positive and the negative side [s].
    quiet : bool array, shape (n_times,)
    regressors : float64 array, shape (n_times, 3)
        Acceleration, velocity and displacement of the base.

    Returns
    -------
    dict of str to (value, censored, error)
        By the names of `JOINT_FEATURES`; without those of the opening where that is not measured.
    """
    time, acceleration = histories["time"].to_numpy(), regressors[:, 0]
    read = [histories["slip"].sel(tangent="x"), histories["rotation"].sel(axis="y"), histories["opening"]]
    noise = [
        float(histories["slip_noise"].sel(tangent="x")),
        float(histories["rotation_noise"].sel(axis="y")),
    ]
    there = np.isfinite(read[0].to_numpy())
    whole = there[-1] or there[time > time[-1] - RESIDUAL_WINDOW].any()
    slip, rotation, opening = (known_values(values.to_numpy()) for values in read)
    found = {
        "slip.quiet.acceleration": slope(np.where(there, slip, np.nan)[quiet], regressors[quiet], 0),
        "slip.quiet.displacement": slope(np.where(there, slip, np.nan)[quiet], regressors[quiet], 2),
        "rotation.quiet.acceleration": slope(np.where(there, rotation, np.nan)[quiet], regressors[quiet], 0),
        "slip.onset": _onset(time, np.abs(acceleration), onsets[0].min()),
        # inertia pushes a block against the acceleration of its base
        "rotation.onset+": _onset(time, -acceleration, onsets[1][0]),
        "rotation.onset-": _onset(time, acceleration, onsets[1][1]),
    }
    for name, values, sigma in (("slip", slip, noise[0]), ("rotation", rotation, noise[1])):
        high, low = max(values.max(), 0.0), min(values.min(), 0.0)
        last = values[time >= time[-1] - RESIDUAL_WINDOW].mean()
        moved = max(high, -low) > ONSET_NOISE * sigma
        found |= {
            f"{name}.peak+": told(high),
            f"{name}.peak-": told(low),
            f"{name}.residual": (float(last), not whole, 0.0),
            f"{name}.asymmetry": told((high + low) / (high - low) if moved else None),
        }
    rocking = there & (np.abs(rotation) > ONSET_NOISE * noise[1])
    if np.isfinite(read[2]).any():
        for side, sign in (("+", 1.0), ("-", -1.0)):
            found[f"pivot{side}"] = told(_pivot(sign * rotation, opening, rocking & (sign * rotation > 0.0)))
        found["slip.rotation"] = told(
            _leakage(slip - opening * np.tan(0.5 * rotation), rotation, rocking, noise[1])
        )
    threshold = TURN_NOISE * noise[0]
    found["slip.path"] = told(np.abs(steps(slip, threshold)[1]).sum())
    found["slip.growth"] = told(growth(slip, acceleration, threshold))
    upper = histories["body"].values.tolist().index(str(histories["upper"].values))
    moved = known_values(histories["body_displacement"].isel(body=upper).sel(axis="x").to_numpy())
    sigma = float(histories["body_displacement_noise"].isel(body=upper).sel(axis="x"))
    found["turning"] = told(turning_acceleration(time, moved, TURN_NOISE * sigma))
    return found


def spike_features(time, displacement, noise, time_acc, readings):
    """Spikes of an accelerometer along x against the displacement of its body.

    Parameters
    ----------
    time, displacement : float64 arrays, shape (n_times,)
        Of the body against the base [s, m].
    noise : float
        Of a displacement [m].
    time_acc, readings : float64 arrays, shape (n_readings,)
        [s, m/s2]

    Returns
    -------
    dict of str to (value, censored, error)
        By the names of `SPIKE_FEATURES`.
    """
    rate = (len(time_acc) - 1) / (time_acc[-1] - time_acc[0])
    filled = np.interp(time_acc, time_acc[np.isfinite(readings)], readings[np.isfinite(readings)])
    height = np.abs(
        filled - median_filter(filled, size=2 * round(0.5 * _MEDIAN_WINDOW * rate) + 1, mode="nearest")
    )
    places, left = [], height.copy()
    for _ in range(_SPIKES):
        places.append(int(np.argmax(left)))
        left[np.abs(time_acc - time_acc[places[-1]]) < _SPIKES_APART] = 0.0
    there = np.abs(np.interp(time_acc[places], time, displacement))
    scatter = there.std() / there.mean() if there.mean() > ONSET_NOISE * noise else None
    return {"spike.largest": told(height.max()), "spike.scatter": told(scatter, otherwise=1.0)}


def _onset(time, drive, onset):
    """Largest drive until the onset, of the whole test where there was none."""
    return float(drive[time <= onset].max()), not np.isfinite(onset), 0.0


def _pivot(rotation, opening, rocking):
    """Opening over positive rotation through the origin [m]."""
    if rocking.sum() < _ROCKING_READINGS_NEEDED:
        return None
    turned = np.sin(rotation[rocking])
    return (turned * opening[rocking]).sum() / (turned**2).sum()


def _leakage(slip, rotation, rocking, noise):
    """Slope of a slip over rotation beside a constant [m]; None for rotations that hardly differ."""
    if rocking.sum() < 2 * _ROCKING_READINGS_NEEDED or np.ptp(rotation[rocking]) < 4.0 * ONSET_NOISE * noise:
        return None
    turned = rotation[rocking] - rotation[rocking].mean()
    return (turned * slip[rocking]).sum() / (turned**2).sum()
