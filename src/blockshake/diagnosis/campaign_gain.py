"""The gain of a campaign's extended model: sealed tests read at last, and predicted by four ensembles."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.consequence import consequence
from blockshake.diagnosis.discrepancy import Condition, fit_discrepancy, members_with_discrepancy
from blockshake.diagnosis.extended_runs import EXTENDED, NOMINAL, RECALIBRATED
from blockshake.diagnosis.gain import gain_on
from blockshake.diagnosis.library_scores import runs_of
from blockshake.diagnosis.measured_readings import reading_of
from blockshake.diagnosis.sealed_test import tamed_test
from blockshake.measurement.commanded_motion import commanded_motion

DISCREPANCY = "discrepancy"
_KINDS = (NOMINAL, RECALIBRATED, EXTENDED)
_OF_PARAMETERS = ("prior", "posterior", "narrowing", "skill", "chance", "informed", "held")


def campaign_gain(campaign, readings, tables, sealed, runs):
    """Gain on the sealed tests, the discrepancy that is its rival, and what the extension means for the user.

    Parameters
    ----------
    campaign : Campaign
    readings, sealed : xarray.Dataset
        From `measured_readings`, of open and of sealed tests.
    tables : list of dict of str to xarray.Dataset
        By open test and solver: features of the library.
    runs : dict of str to xarray.Dataset
        By solver: from `extended_runs`.

    Returns
    -------
    gain : xarray.Dataset
        From `gain_on`; and along ``model`` and ``parameter`` what the open tests tell of the nominal parameters, as of
        `Recalibration.informed`, NaN and false of a parameter that a solver has not.
    consequences : xarray.Dataset
        From `consequence`, along ``test``; and ``drift_history(kind, quantile, time, body)`` of the ensembles with
        ``drift_measured(time, body)`` [m].
    """
    conditions, names, measured, members = [], [], [], []
    for table, name in zip(tables, map(str, readings["test"].values), strict=True):
        nominal = {NOMINAL: {model: runs_of(one) for model, one in table.items()}}
        test = tamed_test(name, reading_of(readings, name), nominal)
        conditions.append(_condition(campaign, name))
        names.append(test.features)
        measured.append(test.measured)
        members.append(np.concatenate(list(test.members[NOMINAL].values())))
    discrepancy = fit_discrepancy(conditions, names, measured, members)
    tests, consequences = [], []
    for name in map(str, sealed["test"].values):
        reading = reading_of(sealed, name)
        ensembles = {kind: {model: _runs(one, kind, name) for model, one in runs.items()} for kind in _KINDS}
        test = tamed_test(name, reading, ensembles)
        test.members[DISCREPANCY] = {
            model: members_with_discrepancy(discrepancy, _condition(campaign, name), test.features, one)
            for model, one in test.members[NOMINAL].items()
        }
        tests.append(test)
        consequences.append(consequence(reading, ensembles).merge(_histories(reading, ensembles)))
    return gain_on(tests).merge(_parameters(runs)), xr.concat(
        consequences, dim="test", join="outer"
    ).assign_coords(test=[test.name for test in tests])


def _parameters(runs):
    """What the open tests tell of the nominal parameters, by solver."""
    parts = [one[list(_OF_PARAMETERS)] for one in runs.values()]
    return xr.concat(
        parts, dim="model", join="outer", coords="minimal", compat="override", fill_value={"informed": False}
    ).assign_coords(model=list(runs))


def _runs(runs, kind, test):
    chosen = (runs["kind"].to_numpy() == kind) & (runs["test"].to_numpy() == test)
    return runs.isel(run=np.flatnonzero(chosen))


def _condition(campaign, name):
    motion = commanded_motion(campaign, campaign.tests[name])
    peak = np.abs(motion.evaluate(motion.table.breaks, derivative=2)[:, 0]).max()
    return Condition(campaign.tests[name].motion, float(peak))


def _histories(reading, ensembles):
    """Quantiles of the drift by ensemble, both solvers together, and the measured one."""
    rows = []
    for by_model in ensembles.values():
        drift = xr.concat([one["drift"] for one in by_model.values()], dim="run", join="outer")
        drift = drift.sel(time=reading["time"], method="nearest").assign_coords(time=reading["time"])
        drift = drift.drop_vars(["kind", "test", "draw", "status"])
        rows.append(drift.quantile((0.05, 0.5, 0.95), dim="run", skipna=True))
    history = xr.concat(rows, dim="kind").assign_coords(kind=list(ensembles)).astype(np.float32)
    return xr.Dataset({"drift_history": history, "drift_measured": reading["drift"]})
