"""Ensembles by one solver before and after an extension, on sealed tests."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.gain.extension import extended_members, open_features, open_responses
from blockshake.diagnosis.gain.recalibration import posterior_draws
from blockshake.diagnosis.libraries.candidates import NOMINAL
from blockshake.diagnosis.libraries.designed_test import PlannedTest, kept_reading
from blockshake.diagnosis.libraries.null_model import draw_nominal
from blockshake.diagnosis.libraries.plan import planned_motion, sealed_tests

RECALIBRATED, EXTENDED = "recalibrated", "extended"


def nominal_draws(plan, model):
    """Nominal models of a plan's libraries by one solver, in their order."""
    like = next(iter(plan.tests.values()))
    return [draw_nominal(like.structure, model, k) for k in range(plan.effort.nominal_draws)]


def members_with_cause(plan, model, decision, size, library, left):
    """Members of the model that a decision's causes extend.

    Parameters
    ----------
    plan : Plan
    model : str
        Solver.
    decision : Decision
        Its first cause extends the model, of a combination both causes do.
    size : CauseSize
        Of the first cause.
    library : ScoreLibrary
        Of the first cause, from `library_of_cause`.
    left : list of float64 array, shape (n_features,)
        The part of the measured features that the first cause has to explain: from `without_second`.

    Returns
    -------
    list of (Draw, list of dict)
        With the effects as `simulated_test` is given them.
    """
    by_key = {candidate.key: candidate for candidate in plan.candidates}
    cause, *others = (by_key[decision.places[effect]] for effect in decision.causes)
    members = extended_members(
        cause,
        (np.array(size.sizes), np.array(size.posterior)),
        nominal_draws(plan, model),
        open_features(library, model),
        np.concatenate(left),
        open_responses(library, model, cause.key),
        plan.effort.members,
    )
    if decision.decision != "combination":
        return members
    (second,) = others
    beside = decision.sizes[second.effect]
    return [
        (draw, [*effects, second.as_effect(second.values_at(beside, number))])
        for number, (draw, effects) in enumerate(members)
    ]


def planned_sealed(campaign, name, like):
    """A sealed test as it is simulated, its file unread: as long and with the sensors as a test that was read."""
    return PlannedTest(
        structure=like.structure,
        motion=planned_motion(campaign, name),
        duration=like.duration,
        sensors=campaign.sensors,
        markers=like.markers,
        channels=like.channels,
        unread=like.unread,
        clock=like.clock._replace(first=0.0),
    )


def extended_runs(plan, model, extended, known, features, store, source, progress):
    """Simulated tests of the nominal, the recalibrated and the extended model.

    Parameters
    ----------
    plan : Plan
    model : str
        Solver.
    extended : list of (Draw, list of dict)
        Members of the extended model, from `members_with_cause` or `members_with_force`.
    known : float64 array, shape (n_draws, n_features)
        From `open_features`.
    features : list of float64 array, shape (n_features,)
        Measured in the open tests, tamed.
    store, source, progress
        As of `library`.

    Returns
    -------
    xarray.Dataset
        Along ``run``: ``value(run, feature)``, ``drift(run, time, body)`` and ``law_value(run, law)`` as from
        `read_off`; coordinates ``kind``,
        ``test``, ``draw``, ``status``. Along ``parameter``: what the tests tell of the nominal parameters without the
        cause, as of `Recalibration.informed`.
    """
    draws, count = nominal_draws(plan, model), plan.effort.members
    recalibration = posterior_draws(draws, known, np.concatenate(features))
    members = {
        NOMINAL: [(draw, []) for draw in draws[:count]],
        RECALIBRATED: [(draw, []) for draw in recalibration.draws[:count]],
        EXTENDED: extended,
    }
    like = next(iter(plan.tests.values()))
    sealed = {name: planned_sealed(plan.campaign, name, like) for name in sealed_tests(plan.campaign)}
    jobs = [(kind, name, planned) for kind in members for name, planned in sealed.items()]
    parts, total = [], len(jobs) * count
    for kind, name, planned in jobs:
        for number, (draw, effects) in enumerate(members[kind]):
            reading, how = kept_reading(planned, draw, effects, store, source)
            status = reading["status"].item()
            labels = {"kind": kind, "test": name, "draw": number, "status": status}
            one = reading[["value", "drift", "law_value"]].reset_coords(drop=True).expand_dims("run")
            parts.append(one.assign_coords({label: ("run", [value]) for label, value in labels.items()}))
            progress(f"{name} {model} {kind} {len(parts)}/{total} {how}: {status}")
    runs = xr.concat(parts, dim="run", coords="minimal", compat="override", join="outer", data_vars="minimal")
    return runs.merge(recalibration.informed).assign_attrs(model=model)
