"""Members of the recalibrated, the extended and the placebo model, by one solver."""

from dataclasses import dataclass

import xarray as xr

from blockshake.diagnosis.gain.recalibration import features_of, posterior_draws
from blockshake.diagnosis.misfit.judged_test import judged_test
from blockshake.diagnosis.nominal.ensemble import (
    EXTENDED,
    NOMINAL,
    PLACEBO,
    RECALIBRATED,
    Member,
    nominal_members,
    simulate_members,
)
from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.places import blocks, joints
from blockshake.effects.registry import EFFECTS
from blockshake.files import content_digest


@dataclass(frozen=True)
class Extension:
    """Causes that act in a test, each with its member of one number: a change of an `Experiment`."""

    causes: tuple
    number: int
    test: str

    @property
    def digest(self):
        """Digest of all that the change follows from."""
        acting = [
            [cause.name, cause.place, cause.members[self.number % len(cause.members)], cause.when]
            for cause in self.causes
        ]
        return content_digest(acting, self.test if any(cause.outside for cause in self.causes) else "")

    def __call__(self, experiment):
        """The experiment with the causes in it."""
        for cause in self.causes:
            experiment = extended_experiment(experiment, cause, self.number, self.test)
        return experiment


def acting_causes(decision):
    """Causes that extend the model: of every part of the readings the most probable, where a model can hold it."""
    return tuple(cause for cause in decision.extending if can_extend(cause))


def placebo_of(causes, structure):
    """The causes with the same sizes where the readings say that they are not; empty where one has no such place.

    Of the places that the readings tell from the cause's own it is the farthest along the structure. The gain over this
    placebo is that of the place: the rest any cause of this kind and size would have, wherever it is.
    """
    moved = []
    for cause in causes:
        key = next((name for name in ("joint", "body") if name in cause.place), None)
        if key is None:
            return ()
        every = [entry[key] for entry in (joints if key == "joint" else blocks)(structure)]
        near = {name.partition("@")[0] for name in cause.places}
        here = [sorted(entry) for entry in every].index(sorted(cause.place[key]))
        others = [number for number, entry in enumerate(every) if not near & _names(entry)]
        if not others:
            return ()
        farthest = max(others, key=lambda number: abs(number - here))
        moved.append(cause.model_copy(update={"place": {**cause.place, key: every[farthest]}}))
    return tuple(moved)


def _names(place):
    """How the decision may call a body or a joint."""
    return {place} if isinstance(place, str) else {"-".join(place), "-".join(place[::-1])}


def extended_runs(plan, model, causes, nominal, measured, store):
    """Simulated sealed tests of the nominal, the recalibrated, the extended and the placebo model.

    Parameters
    ----------
    plan : Plan
    model : str
        Solver.
    causes : tuple of Cause
        From `acting_causes`, at least one.
    nominal : dict of str to xarray.Dataset
        By open test: its nominal ensemble by this solver.
    measured : dict of str to xarray.Dataset
        By open test: from `read_histories`.
    store : Store

    Returns
    -------
    xarray.Dataset
        As from `simulate_members`, with twins; of the open tests to select by the nominal and the extended members, not
        conditioned. Attribute ``simulated``: number of tests, the open ones with the cause among them.

    Notes
    -----
    The recalibrated and the extended model are conditioned on the open tests, each given what it has: the latter from
    simulations of the open tests with the cause. The placebo is the extended model with the cause elsewhere. Member k
    of each is nominal draw k, so that two of them differ by their causes and their conditioning alone.
    """
    structure = next(iter(plan.tests.values())).structure
    draws = [draw_nominal(structure, model, number) for number in range(plan.effort.draws)]
    ensembles = {
        test: _with_it(
            [simulate_members(_members(EXTENDED, test, planned, draws, causes), store), nominal[test]]
        )
        for test, planned in plan.tests.items()
    }
    extended = _conditioned(draws, ensembles, measured, EXTENDED)
    drawn = {
        RECALIBRATED: (_conditioned(draws, nominal, measured, NOMINAL), ()),
        EXTENDED: (extended, causes),
    }
    if placebo := placebo_of(causes, structure):
        drawn[PLACEBO] = extended, placebo
    members = []
    for test, planned in plan.sealed.items():
        count = plan.effort.members
        members += nominal_members(test, planned, model, count, plan.effort.twins)
        for kind, (conditioned, acting) in drawn.items():
            members += _members(kind, test, planned, conditioned[:count], acting)
    runs = _with_it([simulate_members(members, store), *(ensembles[test] for test in plan.selecting)])
    return runs.assign_attrs(simulated=len(members) + len(plan.tests) * plan.effort.draws)


def _members(kind, test, planned, draws, causes):
    return [
        Member(kind, number, test, planned, draw, Extension(causes, number, test) if causes else None)
        for number, draw in enumerate(draws)
    ]


def _with_it(ensembles):
    """Runs of several ensembles of one solver, one after the other."""
    return xr.concat(
        ensembles, dim="run", join="outer", coords="minimal", compat="override", combine_attrs="override"
    )


def _conditioned(draws, ensembles, measured, kind):
    """Draws conditioned on open tests, whose ensembles are of one kind."""
    tests = [judged_test(name, measured[name], [ensemble], (kind,)) for name, ensemble in ensembles.items()]
    return posterior_draws(draws, *features_of(tests))


def can_extend(cause):
    """Whether a model can hold a `Cause`, and whether the cause acts in tests that are still to come."""
    if not cause.members:
        return False
    if not cause.outside:
        return True
    form = FORMS[cause.name]
    return form.act is not None and form.lasts(cause.when)


def extended_experiment(experiment, cause, number, test):
    """`Experiment` with the member ``number`` of a cause in it, counted from the start again where there are fewer.

    ``test``, a name: a form from outside may act in some tests alone.
    """
    values = cause.members[number % len(cause.members)]
    if cause.outside:
        form = FORMS[cause.name]
        sizes = (values[key] for key in form.units)
        return form.act(experiment, *sizes, cause.place, cause.when, test)
    effect = EFFECTS[cause.name]
    extend = effect.extends or effect.act
    return extend(experiment, values, cause.place)
