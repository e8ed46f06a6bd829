"""Features of a test: one deterministic value for each entry of the feature table."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.features.excursions import decay, largest_swing
from blockshake.diagnosis.features.feature_table import BANDS, kind
from blockshake.diagnosis.features.joint_features import joint_features, slope, spike_features, told
from blockshake.diagnosis.features.phases import ONSET_NOISE, TURN_NOISE, find_phases, known_values
from blockshake.diagnosis.features.top_motion import band_levels, delay


def features(histories):
    """Features of one test.

    Parameters
    ----------
    histories : xarray.Dataset
        From `joint_histories`, of a measured or a simulated test.

    Returns
    -------
    xarray.Dataset
        Along ``feature``: ``value``; ``censored``, bool, where it could not be told and the table's value stands for
        it; ``error``, the standard deviation of a regression's slope under coloured residuals, 0 for the others.
        Coordinates ``unit`` and ``joint``, the joint's name or ``""``. Never NaN. Features are left out whole where
        the markers cannot tell them (a body with one marker, a direction that is not measured), for measured and
        simulated tests alike.
    """
    phases = find_phases(histories)
    regressors = np.column_stack(
        [histories[name].to_numpy() for name in ("acceleration", "velocity", "displacement")]
    )
    found, joints = {}, []
    for joint, name in enumerate(histories["joint"].values):
        one = histories.isel(joint=joint)
        if not np.isfinite(one["slip"].sel(tangent="x")).any():
            continue
        onsets = phases.slip_onset[joint], phases.rotation_onset[joint]
        own = joint_features(one, onsets, phases.quiet, regressors) | _spikes(one)
        found |= {f"joint{joint + 1}.{key}": value for key, value in own.items()}
        joints += [str(name)] * len(own)
    found |= _base(histories, regressors) | _top(histories, phases)
    values, censored, errors = zip(*found.values(), strict=True)
    return xr.Dataset(
        {
            "value": ("feature", np.array(values, dtype=float)),
            "censored": ("feature", np.array(censored, dtype=bool)),
            "error": ("feature", np.array(errors, dtype=float)),
        },
        {
            "feature": list(found),
            "unit": ("feature", [kind(name).unit for name in found]),
            "joint": ("feature", joints + [""] * (len(found) - len(joints))),
        },
    )


def _spikes(histories):
    """Spike features where an accelerometer of the upper body reads along x."""
    upper = str(histories["upper"].values)
    if "accelerometer" not in histories:
        return {}
    own = (histories["channel_body"].to_numpy() == upper) & (histories["channel_axis"].to_numpy() == "x")
    readings = histories["accelerometer"].to_numpy()[:, own]
    if not np.isfinite(readings).any():
        return {}
    one = histories.sel(body=upper)
    return spike_features(
        histories["time"].to_numpy(),
        known_values(one["body_displacement"].sel(axis="x").to_numpy()),
        float(one["body_displacement_noise"].sel(axis="x")),
        histories["time_acc"].to_numpy(),
        readings[:, 0],
    )


def _base(histories, regressors):
    moved = histories["base_displacement"]
    vertical, lateral = (moved.sel(axis=axis).to_numpy() for axis in "zy")
    found = {}
    if np.isfinite(vertical).any():
        found |= {
            "base.vertical.acceleration": slope(vertical, regressors, 0),
            "base.vertical.displacement": slope(vertical, regressors, 2),
            "base.vertical.peak": told(np.abs(known_values(vertical)).max()),
        }
    if np.isfinite(lateral).any():
        found["base.lateral.displacement"] = slope(lateral, regressors, 2)
    turned = histories["base_rotation"]
    if np.isfinite(turned).any():
        pitch, yaw = (turned.sel(axis=axis).to_numpy() for axis in "yz")
        found |= {
            "base.pitch.acceleration": slope(pitch, regressors, 0),
            "base.pitch.velocity": slope(pitch, regressors, 1),
            "base.yaw.acceleration": slope(yaw, regressors, 0),
        }
    return found


def _top(histories, phases):
    """Features of the highest block whose rotation, or else whose motion along x, is known, and of the whole test."""
    time = histories["time"].to_numpy()
    first = min(phases.slip_onset.min(), phases.rotation_onset.min())
    found = {"onset.time": told(first if np.isfinite(first) else None, otherwise=time[-1])}
    # against itself the table has no noise
    free = histories["body_displacement_noise"].sel(axis="x").to_numpy() > 0.0
    moving = free & np.isfinite(histories["body_displacement"].sel(axis="x")).any("time").to_numpy()
    turning = moving & np.isfinite(histories["body_rotation"].sel(axis="y")).any("time").to_numpy()
    told_of = turning if turning.any() else moving
    height = histories["height"].to_numpy()
    if not told_of.any():
        return found
    top = histories.isel(body=int(np.argmax(np.where(told_of, height, -np.inf))))
    x = known_values(top["body_displacement"].sel(axis="x").to_numpy())
    x_noise = float(top["body_displacement_noise"].sel(axis="x"))
    found |= {
        "top.displacement.peak+": told(max(x.max(), 0.0)),
        "top.displacement.peak-": told(min(x.min(), 0.0)),
    }
    for name, values in (
        ("top.lateral.peak", top["body_displacement"].sel(axis="y")),
        ("top.yaw.peak", top["body_rotation"].sel(axis="z")),
    ):
        if np.isfinite(values).any():
            found[name] = told(np.abs(known_values(values.to_numpy())).max())
    if turning.any():
        found |= _rocking(top, phases, time)
    levels = band_levels(time, x, x_noise, BANDS)
    found |= {f"top.band{number}": told(level) for number, level in enumerate(levels, start=1)}
    return found | _delay(histories, phases, np.where(told_of, height, np.inf), x, x_noise)


def _rocking(top, phases, time):
    """Features of the top block's rotation about y."""
    rotation = known_values(top["body_rotation"].sel(axis="y").to_numpy())
    noise = float(top["body_rotation_noise"].sel(axis="y"))
    tail = decay(time[phases.after], rotation[phases.after], TURN_NOISE * noise)
    period, half_cycles, decrement = tail if tail else (None, None, None)
    rocked = np.abs(rotation).max() > ONSET_NOISE * noise
    return {
        "top.swing": told(largest_swing(time, rotation) if rocked else None),
        "top.period": told(period),
        "top.half_cycles": told(half_cycles),
        "top.decrement": told(decrement),
    }


def _delay(histories, phases, height, x, x_noise):
    """Correlation and lag of the top against the lowest body that is known, where there are two."""
    time = histories["time"].to_numpy()
    known = np.flatnonzero(
        np.isfinite(height) & (histories["body_displacement_noise"].sel(axis="x").to_numpy() > 0.0)
    )
    if len(known) < 2:
        return {}
    lowest = histories.isel(body=int(known[np.argmin(height[known])]))
    low = known_values(lowest["body_displacement"].sel(axis="x").to_numpy())
    low_noise = float(lowest["body_displacement_noise"].sel(axis="x"))
    strong = phases.strong
    heard = strong.any() and all(
        np.abs(values[strong]).max() > ONSET_NOISE * sigma
        for values, sigma in ((x, x_noise), (low, low_noise))
    )
    lag, correlation = delay(time[strong], low[strong], x[strong]) if heard else (None, None)
    return {"top.correlation": told(correlation), "top.delay": told(lag)}
