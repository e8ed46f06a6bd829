"""Members of the recalibrated, the extended and the placebo model, by one solver."""

from dataclasses import dataclass

import xarray as xr

from blockshake.diagnosis.answer.extension import can_extend, extended_experiment
from blockshake.diagnosis.gain.recalibration import features_of, posterior_draws
from blockshake.diagnosis.misfit.judged_test import judged_test
from blockshake.diagnosis.nominal.ensemble import NOMINAL, TWIN, Member, nominal_members, simulate_members
from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.effects.places import blocks, joints
from blockshake.files import content_digest

RECALIBRATED, EXTENDED, PLACEBO = "recalibrated", "extended", "placebo"


@dataclass(frozen=True)
class Extension:
    """Causes that act in a test, each with its member of one number: a change of an `Experiment`."""

    causes: tuple
    number: int
    test: str

    @property
    def digest(self):
        """Of all that the change follows from."""
        acting = [
            [cause.name, cause.place, cause.members[self.number % len(cause.members)], cause.when]
            for cause in self.causes
        ]
        return content_digest(acting, self.test if any(cause.outside for cause in self.causes) else "")

    def __call__(self, experiment):
        for cause in self.causes:
            experiment = extended_experiment(experiment, cause, self.number, self.test)
        return experiment


def acting_causes(decision):
    """Causes that extend the model: of every part of the readings the likeliest, where a model can hold it."""
    return tuple(cause for cause in decision.extending if can_extend(cause))


def placebo_of(causes, structure):
    """The causes with the same sizes at other places; empty where one of them has no other place.

    Places are mirrored: the highest block for the lowest, the joint above for the one below. A gain over this placebo
    is that of the place that the readings speak for: any cause of this kind and size would have the rest of it, were
    it anywhere in the structure.
    """
    moved = []
    for cause in causes:
        key = next((name for name in ("joint", "body") if name in cause.place), None)
        if key is None:
            return ()
        every = [one[key] for one in (joints if key == "joint" else blocks)(structure)]
        here = [sorted(one) for one in every].index(sorted(cause.place[key]))
        other = len(every) - 1 - here
        other = other if other != here else len(every) - 1
        if other == here:
            return ()
        moved.append(cause.model_copy(update={"place": {**cause.place, key: every[other]}}))
    return tuple(moved)


def extended_runs(plan, model, causes, nominal, measured, store, source, progress):
    """Simulated sealed tests of the nominal, the recalibrated, the extended and the placebo model.

    Parameters
    ----------
    plan : Plan
    model : str
        Solver.
    causes : tuple of Cause
        From `acting_causes`.
    nominal : dict of str to xarray.Dataset
        By open test: its nominal ensemble by this solver.
    measured : dict of str to xarray.Dataset
        By open test: from `read_histories`.
    store, source, progress
        As of `simulate_members`.

    Returns
    -------
    xarray.Dataset
        As from `simulate_members`, with twins. Along ``parameter``: what the open tests tell of the nominal
        parameters without the cause, as of `Recalibration.informed`.

    Notes
    -----
    All but the nominal model are conditioned on the open tests, each beside what it has: the extended model and the
    placebo as well, from simulations of the open tests with the cause. Member k of each is nominal draw k, so that two
    of them differ by their causes and their conditioning alone.
    """
    structure = next(iter(plan.tests.values())).structure
    draws = [draw_nominal(structure, model, number) for number in range(plan.effort.draws)]
    recalibration = _conditioned(draws, nominal, measured, NOMINAL)
    drawn = {RECALIBRATED: (recalibration.draws, ())}
    for kind, acting in ((EXTENDED, causes), (PLACEBO, placebo_of(causes, structure))):
        if not acting:
            continue
        ensembles = {}
        for test, planned in plan.tests.items():
            members = _members(kind, test, planned, draws, acting)
            runs = simulate_members(members, store, source, progress)
            twins = nominal[test].isel(run=nominal[test]["kind"].to_numpy() == TWIN)
            ensembles[test] = xr.concat([runs, twins], dim="run", join="outer", combine_attrs="override")
        drawn[kind] = _conditioned(draws, ensembles, measured, kind).draws, acting
    members = []
    for test, planned in plan.sealed.items():
        members += nominal_members(test, planned, model, plan.effort.draws, plan.effort.twins)
        for kind, (own, acting) in drawn.items():
            members += _members(kind, test, planned, own, acting)
    runs = simulate_members(members, store, source, progress)
    return runs.merge(recalibration.informed, combine_attrs="override")


def _members(kind, test, planned, draws, causes):
    return [
        Member(kind, number, test, planned, draw, Extension(causes, number, test) if causes else None)
        for number, draw in enumerate(draws)
    ]


def _conditioned(draws, ensembles, measured, kind):
    """`Recalibration` of draws whose ensembles of open tests are of one kind."""
    tests = [judged_test(name, measured[name], [one], (kind,)) for name, one in ensembles.items()]
    return posterior_draws(draws, *features_of(tests))
