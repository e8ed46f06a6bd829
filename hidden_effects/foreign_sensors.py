"""Sensors of laboratories that are not ours: noise that is white and slow, uneven by axis, grows, and is quantised.

Nothing here is drawn from the ranges of `blockshake.measurement.sensors.instruments`, nor from those of `case_noise`.
"""

import numpy as np
from case_noise import ACCELEROMETER_NOISE, MARKER_NOISE
from scipy.signal import lfilter

_STREAM = 7
_WHITE = 0.3  # of the cases have noise that is white, alike along all axes, and no more
_GAP = 15  # readings that a gap loses in the mean
_OFFSET = 0.05  # m/s2, of an accelerometer channel


def true_sensors(seed, gains=False):
    """Sensors of a case, drawn by its seed.

    Parameters
    ----------
    seed : int
    gains : bool
        Whether gains vary too: of the optical system, of each marker, of each accelerometer channel.

    Returns
    -------
    dict
        ``marker`` and ``channel``: ``size`` over the stated noise [1], by axis of markers; ``slow``, the share of the
        variance that is slow, and ``memory`` of that share [s]; ``growth``, standard deviation by reading [1];
        ``quantum`` [m, m/s2]; ``gaps``, share of the markers' readings that are lost; ``gain``, standard deviations of
        the gains.
    """
    generator = np.random.default_rng([seed, _STREAM])
    white, found = bool(generator.random() < _WHITE), {}
    for kind, stated in (("marker", MARKER_NOISE), ("channel", ACCELEROMETER_NOISE)):
        size = float(generator.uniform(0.9, 1.15))
        depth, slow = float(generator.uniform(1.0, 1.8)), float(generator.uniform(0.05, 0.35))
        memory = float(np.exp(generator.uniform(np.log(0.03), np.log(0.3))))
        growth = float(generator.uniform(0.0, 4e-4 if kind == "marker" else 4e-3))
        quantum = stated * float(generator.choice([0.0, 0.25, 0.5, 1.0]))
        found[kind] = {
            "size": [size, size * depth if kind == "marker" else size, size],
            "slow": slow, "memory": memory, "growth": growth, "quantum": quantum,
        }  # fmt: skip
        if white:
            found[kind] |= {"size": [size] * 3, "slow": 0.0, "growth": 0.0, "quantum": 0.0}
    found["gaps"] = 0.0 if white else float(generator.choice([0.0, 0.005, 0.02]))
    sizes = {"system": 2e-3, "marker": 3e-4, "channel": 3e-3}
    found["gain"] = sizes if gains else dict.fromkeys(sizes, 0.0)
    return found


def read(test, sensors, seed, number):
    """A test's readings, in place of the exact ones that it holds.

    Parameters
    ----------
    test : xarray.Dataset
        As in a campaign's test file.
    sensors : dict
        `true_sensors`.
    seed, number : int
        Of the case, and of the test: gains are those of the case, noise is that of the test.
    """
    gains = np.random.default_rng([seed, _STREAM, 0])
    generator = np.random.default_rng([seed, _STREAM, 1 + number])
    exact = test["marker_displacement"].to_numpy()
    sizes = sensors["gain"]
    scale = (1.0 + sizes["system"] * gains.standard_normal()) * (
        1.0 + sizes["marker"] * gains.standard_normal(exact.shape[1])
    )
    step = float(np.diff(test["time"].to_numpy()[:2])[0])
    seen = _seen(exact * scale[:, None], sensors["marker"], MARKER_NOISE, step, generator)
    first = test["marker_initial_position"].to_numpy() + seen[0]
    seen -= seen[:1]
    seen[_gaps(generator, exact.shape[:2], sensors["gaps"])] = np.nan
    test["marker_displacement"].values[:] = seen
    test["marker_initial_position"].values[:] = first
    exact = test["accelerometer"].to_numpy()
    scale = 1.0 + sizes["channel"] * gains.standard_normal(exact.shape[1])
    exact = exact * scale + _OFFSET * gains.standard_normal(exact.shape[1])
    step = float(np.diff(test["time_acc"].to_numpy()[:2])[0])
    # a channel grows with what it feels with gravity
    test["accelerometer"].values[:] = _seen(
        exact[..., None], sensors["channel"], ACCELEROMETER_NOISE, step, generator, exact[:1, :, None]
    )[..., 0]
    return test


def _seen(exact, sensor, stated, step, generator, rest=0.0):
    """Values (n_times, n_sensors, n_axes) with noise, white and slow, then quantised."""
    white, slow = generator.standard_normal((2, *exact.shape))
    kept = np.exp(-step / sensor["memory"])
    slow[1:] *= np.sqrt(1.0 - kept**2)
    slow = lfilter([1.0], [1.0, -kept], slow, axis=0)
    share = sensor["slow"]
    size = stated * np.array(sensor["size"][: exact.shape[2]])
    size = np.hypot(size, sensor["growth"] * (exact - rest))
    seen = exact + size * (np.sqrt(1.0 - share) * white + np.sqrt(share) * slow)
    quantum = sensor["quantum"]
    return np.round(seen / quantum) * quantum if quantum else seen


def _gaps(generator, shape, share):
    """Readings that are lost in runs of geometric length, never the first."""
    lost = np.zeros(shape, dtype=bool)
    for row, marker in np.argwhere(generator.random(shape) < share / _GAP):
        lost[max(row, 1) : row + generator.geometric(1.0 / _GAP), marker] = True
    return lost
