"""Misfit of the nominal model, test by test: joint, phase, quantity and size."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.features.measured_readings import reading_of
from blockshake.diagnosis.features.reading import HISTORIES
from blockshake.diagnosis.misfit.curve_scores import curve_scores, joint_curves
from blockshake.diagnosis.misfit.residual_atlas import code_word, residual_atlas
from blockshake.diagnosis.misfit.whole_curve import whole_curve_probability
from blockshake.measurement.motion.compared_curves import histories_at

_QUANTILES = (0.05, 0.5, 0.95)  # quantiles of the ensemble
_LONGEST_DROPOUT = 40  # readings at an end that a dropout may lose; more is a run cut short
_STRIDE = 4  # readings, of which one enters the test of whole curves: 50 a second


def misfit(readings, ensembles):
    """Measured histories of all joints held against the nominal ensemble of both solvers.

    Parameters
    ----------
    readings : xarray.Dataset
        From `measured_readings`.
    ensembles : dict of str to list of xarray.Dataset
        By test: histories of nominal draws, one dataset a solver, from `library`.

    Returns
    -------
    xarray.Dataset
        Along ``test``: ``residual``, ``measured``, ``mean``, ``sd`` and ``limit`` as of `residual_atlas`;
        ``intensity``, the base's peak acceleration [m/s2]; along ``quantile`` and ``time`` the ensemble's ``slip``,
        ``rotation``, ``opening`` and ``drift``; along ``curve`` what `curve_scores` gives; ``p_curves``, chance of
        curves as extreme, all tests at once (`whole_curve_probability`). Attributes ``phase``, ``symmetry``,
        ``profile``, ``law``, ``joint`` and ``quantity``: the code word.
    """
    atlases, curves, bands, all_measured, all_simulated = [], [], [], {}, {}
    names = [str(name) for name in readings["test"].values]
    for name in names:
        reading = reading_of(readings, name)
        members = xr.concat([one[list(HISTORIES)] for one in ensembles[name]], dim="draw", join="outer")
        members = histories_at(members, reading["time"].to_numpy())
        members = members.transpose("draw", "time", ...).assign_coords(draw=np.arange(members.sizes["draw"]))
        members = members.map(_without_dropouts)
        atlases.append(residual_atlas(reading, members))
        measured, simulated = joint_curves(reading, name), joint_curves(members, name)
        curves.append(curve_scores(measured, simulated))
        all_measured |= {key: one[::_STRIDE] for key, one in measured.items()}
        all_simulated |= {key: one[:, ::_STRIDE] for key, one in simulated.items()}
        bands.append(members.quantile(_QUANTILES, dim="draw", skipna=True).astype(np.float32))
    word = code_word(atlases)
    found = xr.concat(atlases, dim="test", join="outer", combine_attrs="drop_conflicts")
    found = found.merge(xr.concat(bands, dim="test", join="outer")).assign(
        p_curves=whole_curve_probability(all_measured, all_simulated),
        intensity=("test", [atlas.attrs["intensity"] for atlas in atlases], {"units": "m/s2"}),
    )
    scores = xr.concat(curves, dim="curve").rename({"quantile": "reference"})
    return found.merge(scores).assign_coords(test=names).assign_attrs(vars(word))


def where(found):
    """The place of the largest misfit in words."""
    if found.attrs["phase"] == "none":
        return "no cell of the residual atlas is beyond its limit"
    phase = {
        "quiet": "before the first onset",
        "strong": "while shaken strongly",
        "after": "after the shaking",
    }
    sides = {"both": "to both sides", "one-sided": "to one side"}
    return (
        f"{found.attrs['quantity']} of {found.attrs['joint']}, {phase[found.attrs['phase']]}, "
        f"{sides[found.attrs['symmetry']]}"
    )


def _without_dropouts(histories):
    """Histories, time second, with what a dropout lost filled; what a run that was cut short lacks stays NaN."""
    values = histories.to_numpy().copy()
    times = np.arange(values.shape[1])
    for draw in np.ndindex(values.shape[0], *values.shape[2:]):
        one = values[(draw[0], slice(None), *draw[1:])]
        known = np.flatnonzero(np.isfinite(one))
        if len(known) and len(known) < len(one):
            end = len(one) if len(one) - 1 - known[-1] <= _LONGEST_DROPOUT else known[-1] + 1
            one[:end] = np.interp(times[:end], known, one[known])
    return histories.copy(data=values)
