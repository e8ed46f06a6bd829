"""The plan of a diagnosis: its open tests, and those of them that are simulated."""

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from blockshake.diagnosis.nominal.nominal_model import MODELS
from blockshake.diagnosis.nominal.planned_test import planned_motion, planned_sealed, planned_test
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import PACKAGE, content_digest
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Campaign, load_campaign
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.measurement.campaigns.open_readings import open_test_names

_CHECKOUT = PACKAGE.parents[1].resolve()
_SECONDS = 0.05  # of one core: to simulate and judge a second of a test of one block, mean of both solvers
ENSEMBLES_OF_SEALED_TEST = 4  # nominal, recalibrated, extended, placebo


@dataclass(frozen=True)
class Effort:
    """Amounts of simulation."""

    tests: int  # open tests at most that are simulated
    draws: int  # nominal models of each open test, by each solver
    members: int  # of every ensemble that predicts a sealed test, by each solver
    twins: int  # by which it is measured how long a test can be predicted, by each solver
    outcomes: int  # simulations per test with a binary outcome
    clean: int  # nominal models at most of all open tests together, by each solver, that are judged as if measured
    clean_seconds: float = np.inf  # of one core, that these may take by `_SECONDS`


EFFORTS = {
    "quick": Effort(tests=0, draws=0, members=0, twins=0, outcomes=4, clean=2, clean_seconds=30.0),
    "standard": Effort(tests=3, draws=40, members=12, twins=4, outcomes=8, clean=10),
    "deep": Effort(tests=12, draws=80, members=40, twins=8, outcomes=16, clean=40),
}


@dataclass(frozen=True)
class Plan:
    """Simulations of a campaign."""

    campaign: Campaign
    effort: Effort
    open: list  # of str; tests that are judged by
    simulated: list  # of str; those of them that are simulated

    @cached_property
    def tests(self):
        """Those of them that are simulated, `PlannedTest` by name."""
        return {name: planned_test(self.campaign, name, self._structure) for name in self.simulated}

    @cached_property
    def opened(self):
        """All open tests as they are simulated, `PlannedTest` by name; none of a campaign whose motions are not known.

        Free flight and outcomes have none either.
        """
        campaign = self.campaign
        if not campaign.kind.ensembles:
            return {}
        if any(commanded_motion(campaign, campaign.tests[name]) is None for name in self.open):
            return {}
        return {name: planned_test(campaign, name, self._structure) for name in self.open}

    @cached_property
    def clean(self):
        """Nominal models of all open tests together, by each solver, that are judged as if they had been measured."""
        free = int((~self._structure.driven).sum())
        seconds = _SECONDS * free * sum(test.duration for test in self.opened.values())
        if not seconds:
            return 0
        return int(min(self.effort.clean, max(self.effort.clean_seconds / (len(MODELS) * seconds), 1.0)))

    @property
    def sealed(self):
        """Sealed tests as they are simulated, by name; empty where nothing is simulated."""
        names = self.campaign.sealed if self.simulated else ()
        return {name: planned_sealed(self.campaign, name, self.tests, self._structure) for name in names}

    @property
    def selecting(self):
        """Names of the simulated tests to select by."""
        return [name for name in self.simulated if self.campaign.tests[name].role == "select"]

    @cached_property
    def _structure(self):
        return load_structure(self.campaign.structure)

    @property
    def runs(self):
        """Simulated tests in all nominal ensembles, twins with them."""
        return len(MODELS) * len(self.simulated) * (self.effort.draws + self.effort.twins)

    @property
    def runs_of_cause(self):
        """Simulated tests at most, once a cause was found: of the open tests with it, and of the sealed ones."""
        of_sealed = ENSEMBLES_OF_SEALED_TEST * self.effort.members + self.effort.twins
        sealed = len(self.campaign.sealed) if self.simulated else 0
        return len(MODELS) * (len(self.simulated) * self.effort.draws + sealed * of_sealed)


def plan_diagnosis(folder, effort):
    """Plan of the diagnosis of a campaign's folder at one of `EFFORTS`."""
    if effort not in EFFORTS:
        raise InputError("effort", str(effort), f"expected one of {', '.join(EFFORTS)}")
    campaign, effort = load_campaign(folder), EFFORTS[effort]
    names = open_tests(campaign)
    chosen = simulated_tests(campaign, names, effort.tests) if campaign.kind.ensembles else []
    for name in chosen:
        planned_motion(campaign, name)  # which no job should be the first to miss
    return Plan(campaign, effort, names, chosen)


def open_tests(campaign):
    """Names of the tests that a diagnosis judges by, in the campaign's order; none is sealed, none a copy of another.

    Raises
    ------
    InputError
        All tests are sealed.
    """
    if not campaign.open:
        raise InputError(
            campaign.folder / "campaign.yaml",
            "tests",
            "expected a test with the role fit or select, found none",
        )
    return open_test_names(campaign) if campaign.kind.ensembles else list(campaign.open)


def simulated_tests(campaign, names, most):
    """Those of the open tests that are simulated, in the campaign's order.

    Those to select by, the strongest of each motion, then the others, by falling scale: where nothing moves, nothing is
    known.
    """
    falling = sorted((campaign.tests[name] for name in names), key=lambda test: (-abs(test.scale), test.name))
    strongest = {}
    for test in falling:
        strongest.setdefault(test.motion, test)
    select = [test for test in falling if test.role == "select"]
    order = dict.fromkeys(test.name for test in [*select, *strongest.values(), *falling])
    chosen = list(order)[:most]
    return [name for name in names if name in chosen]


def result_name(folder, without=()):
    """Name of a campaign's results: the folder's, with digits of its path unless it lies in the checkout."""
    path = Path(folder).resolve()
    name = path.name if _CHECKOUT in path.parents else f"{path.name}-{content_digest(str(path))[:6]}"
    return "-without-".join([re.sub(r"[^A-Za-z0-9._-]", "-", name), *without])


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
