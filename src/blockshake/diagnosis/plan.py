"""What a diagnosis simulates: which tests, with which sensors, how often."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from blockshake.diagnosis.candidates import candidates
from blockshake.diagnosis.null_model import MODELS
from blockshake.diagnosis.planned_test import PlannedTest
from blockshake.diagnosis.repeated_readings import without_repeats
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import PACKAGE, content_digest
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaign import Campaign, load_campaign, load_test
from blockshake.measurement.commanded_motion import commanded_motion

_CHECKOUT = PACKAGE.parents[1].resolve()
_FEWEST_TESTS = 2
_FEWEST_OWN = 2


@dataclass(frozen=True)
class Effort:
    """How much is simulated.

    Attributes
    ----------
    runs : int
        Simulated tests at most.
    tests : int
        Tests at most that libraries are made of.
    nominal_draws, own_draws : int
        Draws of the nominal model and, at most, with each candidate, by each solver and test.
    further_draws : int
        With the cause, once one is found: its size is known badly from those of a candidate.
    members : int
        Of every ensemble that a sealed test is predicted with, by each solver.
    twins : int
        By which the predictability of an open test is measured, by each solver.
    """

    runs: int
    tests: int
    nominal_draws: int
    own_draws: int
    further_draws: int
    members: int
    twins: int


EFFORTS = {
    "quick": Effort(runs=400, tests=2, nominal_draws=20, own_draws=4, further_draws=0, members=0, twins=3),
    "standard": Effort(
        runs=2000, tests=3, nominal_draws=40, own_draws=6, further_draws=12, members=12, twins=8
    ),
    "deep": Effort(
        runs=12000, tests=12, nominal_draws=80, own_draws=12, further_draws=12, members=40, twins=12
    ),
}
_ENSEMBLES = 3  # that a sealed test is predicted with: nominal, recalibrated, extended


def open_tests(campaign, effort):
    """Names of the tests that a diagnosis judges by, in the campaign's order; none is sealed, none a copy of another.

    The strongest of each motion, then the weakest of all, where the blocks may not move yet, then the others by
    falling scale: as many as the effort has.

    Raises
    ------
    InputError
        Fewer than two tests that are not sealed.
    """
    free = [test.name for test in campaign.tests.values() if test.role != "sealed"]
    free = [campaign.tests[name] for name in without_repeats(campaign, free)]
    if len(free) < _FEWEST_TESTS:
        raise InputError(
            campaign.folder / "campaign.yaml",
            "tests",
            f"expected at least {_FEWEST_TESTS} different tests with the role fit or select, found {len(free)}: "
            "an effect is told from chance by its being the same in several tests",
        )
    falling = sorted(free, key=lambda test: (-abs(test.scale), test.name))
    strongest = {}
    for test in falling:
        strongest.setdefault(test.motion, test)
    order = [*strongest.values(), falling[-1], *falling]
    chosen = {test.name for test in list(dict.fromkeys(order))[: effort.tests]}
    return [test.name for test in free if test.name in chosen]


def sealed_tests(campaign):
    """Names of the sealed tests."""
    return [test.name for test in campaign.tests.values() if test.role == "sealed"]


def own_draws(effort, candidates, tests, sealed):
    """Draws with each candidate that the number of runs allows, by each solver and test.

    Parameters
    ----------
    effort : Effort
    candidates, tests, sealed : int
        Their numbers.

    Raises
    ------
    InputError
        Not even two.
    """
    solvers = len(MODELS)
    spent = solvers * (
        tests * (effort.nominal_draws + effort.further_draws + 1 + effort.twins)
        + sealed * _ENSEMBLES * effort.members
    )
    count = min(effort.own_draws, (effort.runs - spent) // (solvers * tests * candidates))
    if count < _FEWEST_OWN:
        raise InputError(
            "effort",
            "",
            f"expected more than {effort.runs} runs for {candidates} candidates and {tests} tests: try a larger effort",
        )
    return count


def planned_test(campaign, name):
    """A test that is not sealed as libraries simulate it: as long and with the sensors that were read in it.

    Raises
    ------
    InputError
        A commanded motion that is neither shipped nor in the campaign's folder, or bad readings.
    """
    test = load_test(campaign, name)
    time = test["time"].to_numpy()
    return PlannedTest(
        structure=campaign.structure,
        motion=_commanded(campaign, name),
        duration=float(np.round(time[-1] - time[0], 3)),
        sensors=campaign.sensors,
        markers=tuple(map(str, test["marker"].values)),
        channels=tuple(map(str, test["channel"].values)) if "accelerometer" in test else (),
    )


def planned_sealed(campaign, name, like):
    """A sealed test as it is simulated, its file unread: as long and with the sensors as a test that was read."""
    return PlannedTest(
        structure=campaign.structure,
        motion=_commanded(campaign, name),
        duration=like.duration,
        sensors=campaign.sensors,
        markers=like.markers,
        channels=like.channels,
    )


def _commanded(campaign, name):
    motion = commanded_motion(campaign, campaign.tests[name])
    if motion is None:
        raise InputError(
            campaign.folder / "campaign.yaml",
            f"tests.{name}.motion",
            f"expected a shipped motion or a file in the folder, found {campaign.tests[name].motion}",
        )
    return motion


@dataclass(frozen=True)
class Plan:
    """All that is simulated for a campaign before its readings are judged.

    Attributes
    ----------
    campaign : Campaign
    effort : Effort
    tests : dict of str to PlannedTest
        By name, of the open tests that are judged by.
    candidates : list of Candidate
    own_draws : int
        Draws with each candidate.
    effects : list of str
        Names of the effects that are considered.
    """

    campaign: Campaign
    effort: Effort
    tests: dict
    candidates: list
    own_draws: int
    effects: list

    @property
    def runs(self):
        """Simulated tests in all libraries, twins with them."""
        return (
            len(MODELS)
            * len(self.tests)
            * (self.effort.nominal_draws + self.own_draws * len(self.candidates) + 1 + self.effort.twins)
        )

    @property
    def further_runs(self):
        """Simulated tests with a cause that was found, beyond those of the libraries."""
        return len(MODELS) * len(self.tests) * self.effort.further_draws

    def caveats(self, causes):
        """Why no gain was measured, where there are causes."""
        if not causes:
            return []
        if not sealed_tests(self.campaign):
            return ["no gain was measured: there is no sealed test"]
        return ["no gain was measured: an extension is not simulated at quick effort"]

    def library(self, test, source):
        """Name of the library of a test: equal content, equal name."""
        return content_digest(self.tests[test].digest(), self.effort.nominal_draws, self.own_draws, source)

    def calibration(self, source):
        """Name of the calibration of the libraries together."""
        libraries = [self.library(test, source) for test in self.tests]
        return content_digest(libraries, self.effects, source)


def plan_diagnosis(folder, effort, without=()):
    """Plan of a campaign's diagnosis.

    Parameters
    ----------
    folder : str or path
        Of the campaign.
    effort : str
        One of `EFFORTS`.
    without : sequence of str
        Effects that are left out, as if nobody had thought of them.

    Raises
    ------
    InputError
    """
    if effort not in EFFORTS:
        raise InputError("effort", str(effort), f"expected one of {', '.join(EFFORTS)}")
    campaign = load_campaign(folder)
    names = open_tests(campaign, EFFORTS[effort])
    tests = {name: planned_test(campaign, name) for name in names}
    everywhere = candidates(load_structure(campaign.structure))
    count = own_draws(EFFORTS[effort], len(everywhere), len(names), len(sealed_tests(campaign)))
    return Plan(campaign, EFFORTS[effort], tests, everywhere, count, considered(without))


def result_name(folder, without=()):
    """Name of a campaign's results: the folder's, with digits of its path unless it lies in the checkout."""
    path = Path(folder).resolve()
    name = path.name if _CHECKOUT in path.parents else f"{path.name}-{content_digest(str(path))[:6]}"
    return "-without-".join([re.sub(r"[^A-Za-z0-9._-]", "-", name), *without])


def plan_of_library(library, folders, effort, source):
    """Plan and test of the first of several campaigns that has a library.

    Parameters
    ----------
    library : str
        Name, as of `Plan.library`.
    folders : sequence of str
        Of campaigns.
    effort, source : str

    Returns
    -------
    plan : Plan
    test : str
    """
    for folder in folders:
        plan = plan_diagnosis(folder, effort)
        for test in plan.tests:
            if plan.library(test, source) == library:
                return plan, test
    raise InputError("library", library, f"expected the library of a test of {', '.join(folders)}")


def considered(without=()):
    """Names of the effects that a diagnosis considers.

    Raises
    ------
    InputError
        A name to leave out that is not in the registry.
    """
    for name in without:
        if name not in EFFECTS:
            raise InputError("without", str(name), f"expected one of {', '.join(EFFECTS)}")
    return [name for name in EFFECTS if name not in without]
