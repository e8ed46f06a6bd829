"""Gain of a campaign's extended model: the sealed tests are opened and predicted by four ensembles."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.features.measured_readings import measured_readings, reading_of
from blockshake.diagnosis.gain.consequence import consequence
from blockshake.diagnosis.gain.discrepancy import Condition, fit_discrepancy, members_with_discrepancy
from blockshake.diagnosis.gain.extended_runs import EXTENDED, RECALIBRATED
from blockshake.diagnosis.gain.gain import CampaignGain, gain_of_verdict, gain_on
from blockshake.diagnosis.gain.law_gain import law_contrast, law_gain
from blockshake.diagnosis.gain.sealed_prediction import tamed_test
from blockshake.diagnosis.inference.library_scores import runs_of
from blockshake.diagnosis.libraries.candidates import NOMINAL
from blockshake.diagnosis.libraries.plan import sealed_tests
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_test
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.measurement.motion.compared_curves import histories_at
from blockshake.parity.parity import check_parity

DISCREPANCY = "discrepancy"
_KINDS = (NOMINAL, RECALIBRATED, EXTENDED)
_OF_PARAMETERS = ("prior", "posterior", "narrowing", "skill", "chance", "informed", "held")


def campaign_gain(campaign, readings, tables, runs, broken):
    """Gain on the sealed tests against three rivals, and the consequence of the extension for the user.

    Parameters
    ----------
    campaign : Campaign
    readings : xarray.Dataset
        From `measured_readings`, of open tests.
    tables : list of dict of str to xarray.Dataset
        By open test and solver: features of the library.
    runs : dict of str to xarray.Dataset
        By solver: from `extended_runs`.
    broken : sequence of str
        Laws of the joints that the open tests break.

    Returns
    -------
    CampaignGain
        ``scores`` from `gain_on` and `law_gain`; and along ``model`` and ``parameter`` what the open tests tell of
        the nominal parameters, as of `Recalibration.informed`, NaN and false of a parameter that a solver has not.
        ``consequences`` from `consequence`, along ``test``; and ``drift_history(kind, quantile, time, body)`` of the
        ensembles with ``drift_measured(time, body)`` [m].
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
    tests, of_laws, consequences = [], {}, []
    sealed = _sealed_readings(campaign, float(next(iter(runs.values()))["time"][-1]))
    for name in map(str, sealed["test"].values):
        reading = reading_of(sealed, name)
        ensembles = {kind: {model: _runs(one, kind, name) for model, one in runs.items()} for kind in _KINDS}
        test = tamed_test(name, reading, ensembles)
        of_laws[name] = reading, ensembles
        test.members[DISCREPANCY] = {
            model: members_with_discrepancy(discrepancy, _condition(campaign, name), test.features, one)
            for model, one in test.members[NOMINAL].items()
        }
        tests.append(test)
        consequences.append(consequence(reading, ensembles).merge(_histories(reading, ensembles)))
    scores, laws = gain_on(tests), law_gain(of_laws, broken)
    summary = gain_of_verdict(scores, sum(one.sizes["run"] for one in runs.values()))
    return CampaignGain(
        summary.model_copy(update={"laws": law_contrast(laws)}),
        scores.merge(laws).merge(_parameters(runs)),
        xr.concat(consequences, dim="test", join="outer").assign_coords(test=[test.name for test in tests]),
    )


def _sealed_readings(campaign, longest):
    """Sealed tests without their sensors' faults, read off as far as they were simulated."""
    names = sealed_tests(campaign)
    tests = {name: load_test(campaign, name) for name in names}
    findings = check_parity(tests, load_structure(campaign.structure), campaign.sensors).findings
    return measured_readings(campaign, names, findings, longest)


def _parameters(runs):
    """Information of the open tests on the nominal parameters, by solver."""
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
        drift = xr.concat([one[["drift"]] for one in by_model.values()], dim="run", join="outer")
        drift = histories_at(drift, reading["time"].to_numpy())["drift"]
        drift = drift.drop_vars(["kind", "test", "draw", "status"])
        rows.append(drift.quantile((0.05, 0.5, 0.95), dim="run", skipna=True))
    history = xr.concat(rows, dim="kind").assign_coords(kind=list(ensembles)).astype(np.float32)
    return xr.Dataset({"drift_history": history, "drift_measured": reading["drift"]})
