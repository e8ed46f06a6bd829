"""Figures of the joints of a run, a number each: compression, uplift, slip."""

import numpy as np
import xarray as xr

from blockshake.measurement.motion.joint_coordinates import find_joints
from blockshake.simulation.run_histories import run_histories

RARELY = 0.01  # share of the time for which a joint is pressed harder; the peaks of impacts are briefer


def joint_figures(run, structure):
    """Largest compression, uplift and slip of every joint that a structure has at its start.

    Parameters
    ----------
    run : xarray.Dataset
        A run file.
    structure : Structure
        The run's.

    Returns
    -------
    xarray.Dataset
        ``joint_compression(joint)``: normal force that is exceeded for 1 % of the time [N]; ``joint_uplift`` and
        ``joint_slip(joint)``: largest opening and slip at the middle of the face, as of `run_histories` [m]. NaN where
        a joint is not known there. Coordinate ``joint``, ``lower-upper``, from the foundation up.

    Notes
    -----
    The largest normal force of all is that of an impact: it lasts a few milliseconds, and depends on the stiffness of
    the contact and on the instants at which a run is written.
    """
    histories = run_histories(run, structure)
    pairs, _ = find_joints(structure)
    names = structure.body_names
    # a run names a pair in the order in which its bodies met
    touched = zip(histories["lower"].values, histories["upper"].values, strict=True)
    places = {frozenset(pair): place for place, pair in enumerate(touched)}
    rows = [places.get(frozenset((names[lower], names[upper]))) for lower, upper in pairs]

    def figure(name, statistic):
        values = histories[name].to_numpy()
        return [np.nan if row is None else statistic(values[:, row]) for row in rows]

    return xr.Dataset(
        {
            name: ("joint", figure(history, statistic), {"units": units, "long_name": long_name})
            for name, (history, statistic, units, long_name) in _FIGURES.items()
        },
        coords={"joint": np.array([f"{names[lower]}-{names[upper]}" for lower, upper in pairs], dtype=str)},
    )


def _rarely_exceeded(values):
    return float(np.nanquantile(values, 1.0 - RARELY)) if np.isfinite(values).any() else np.nan


def _largest(values):
    return float(np.nanmax(values)) if np.isfinite(values).any() else np.nan


# history of `run_histories`, statistic over time, unit and name of every figure
_FIGURES = {
    "joint_compression": ("normal_force", _rarely_exceeded, "N", "normal force exceeded for 1 % of the time"),
    "joint_uplift": ("uplift", _largest, "m", "largest opening at the middle of the face"),
    "joint_slip": ("slip", _largest, "m", "largest slip at the middle of the face"),
}
JOINT_FIGURES = tuple(_FIGURES)
