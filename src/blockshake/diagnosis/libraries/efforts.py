"""Efforts of a diagnosis: how much is simulated, of which open tests, with how many draws of each candidate."""

from dataclasses import dataclass

from blockshake.diagnosis.libraries.null_model import MODELS
from blockshake.diagnosis.libraries.repeated_readings import without_repeats
from blockshake.errors import InputError

_OPEN_TESTS_NEEDED = 2
_OWN_DRAWS_NEEDED = 2
ENSEMBLES_OF_SEALED_TEST = 3  # nominal, recalibrated, extended


@dataclass(frozen=True)
class Effort:
    """Amounts of simulation.

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
    "quick": Effort(runs=400, tests=2, nominal_draws=12, own_draws=2, further_draws=0, members=0, twins=3),
    "standard": Effort(
        runs=2000, tests=3, nominal_draws=40, own_draws=2, further_draws=12, members=12, twins=8
    ),
    "deep": Effort(
        runs=12000, tests=12, nominal_draws=80, own_draws=12, further_draws=12, members=40, twins=12
    ),
}


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
    if len(free) < _OPEN_TESTS_NEEDED:
        raise InputError(
            campaign.folder / "campaign.yaml",
            "tests",
            f"expected at least {_OPEN_TESTS_NEEDED} different tests with the role fit or select, found {len(free)}: "
            "an effect is told from chance by its being the same in several tests",
        )
    falling = sorted(free, key=lambda test: (-abs(test.scale), test.name))
    strongest = {}
    for test in falling:
        strongest.setdefault(test.motion, test)
    order = [*strongest.values(), falling[-1], *falling]
    chosen = {test.name for test in list(dict.fromkeys(order))[: effort.tests]}
    return [test.name for test in free if test.name in chosen]


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
        + sealed * ENSEMBLES_OF_SEALED_TEST * effort.members
    )
    count = min(effort.own_draws, (effort.runs - spent) // (solvers * tests * candidates))
    if count < _OWN_DRAWS_NEEDED:
        raise InputError(
            "effort",
            "",
            f"expected more than {effort.runs} runs for {candidates} candidates and {tests} tests: try a larger effort",
        )
    return count
