"""The wave speed as the paper's words have it: read once all blocks of the tower move at a similar velocity."""

import numpy as np
import xarray as xr

TOLERANCES = (0.1, 0.2, 0.3)  # largest difference between the blocks that counts as similar, over the step


def read_at_similar_velocity(waves):
    """Wave speed from the lag of the displacement curves at the first instant at which all blocks move alike.

    Parameters
    ----------
    waves : xarray.Dataset
        From `wave_tests`.

    Returns
    -------
    xarray.Dataset
        Over (direction, within): ``time`` of that instant [s]; ``wave_speed`` [m/s]; ``stiffness_ratio`` [1],
        stiffness that gives the target speed by this reading over that of the study. NaN where the blocks never move
        so much alike while the test lasts.

    Notes
    -----
    Zhou et al. (2023), section Model Calibration and Fig. 9: the speed is the height over the lag, once the slopes of
    the curves are near-identical. "Similar" is read as velocities within a tolerance of each other, all above half
    of the step's; the lag is that of two lines with the blocks' mean slope. Every time goes with the root of the
    inverse of the stiffness, so that the stiffness that gives the target goes with the square of the speeds' ratio.
    """
    step = waves.attrs["step_velocity"]
    readings = [_read(waves.sel(direction=one), step) for one in waves["direction"].values]
    shape = ("direction", "within")
    time, speed = (np.array(values) for values in zip(*readings, strict=True))
    target = waves["target_wave_speed"].to_numpy()[:, None]
    return xr.Dataset(
        {
            "time": (shape, time),
            "wave_speed": (shape, speed),
            "stiffness_ratio": (shape, (target / speed) ** 2),
        },
        coords={"direction": waves["direction"].values, "within": list(TOLERANCES)},
    )


def _read(test, step):
    """Instants [s] and wave speeds [m/s] of one direction by tolerance."""
    test = test.dropna("time", subset=["velocity"])
    velocity, displacement = (
        test[name].transpose("time", "block").to_numpy() for name in ("velocity", "displacement")
    )
    height = float(test["wave_speed"]) * float(test["arrival"][-1] - test["arrival"][0])
    slowest, fastest = velocity.min(axis=1), velocity.max(axis=1)
    times, speeds = [], []
    for tolerance in TOLERANCES:
        alike = (fastest - slowest <= tolerance * step) & (slowest > 0.5 * step)
        at = int(np.argmax(alike))
        lag = (displacement[at, 0] - displacement[at, -1]) / velocity[at].mean() if alike.any() else np.nan
        times.append(float(test["time"][at]) if alike.any() else np.nan)
        speeds.append(height / lag)
    return times, speeds
