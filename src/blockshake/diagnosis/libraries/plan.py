"""The plan of a diagnosis: simulated tests, their sensors and candidates, and the number of draws."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.libraries.candidates import candidates
from blockshake.diagnosis.libraries.designed_test import Clock, PlannedTest
from blockshake.diagnosis.libraries.efforts import EFFORTS, Effort, open_tests, own_draws
from blockshake.diagnosis.libraries.null_model import MODELS
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import PACKAGE, content_digest
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Campaign, load_campaign, load_test
from blockshake.measurement.campaigns.command_clock import reading_rate, simulation_start, since
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.measurement.sensors import accelerometers
from blockshake.measurement.sensors.markers import unread_directions

_SAME_READING = 1e-3  # steps, within which two readings are at one time
_CHECKOUT = PACKAGE.parents[1].resolve()


def sealed_tests(campaign):
    """Names of the sealed tests."""
    return [test.name for test in campaign.tests.values() if test.role == "sealed"]


def planned_test(campaign, name, structure):
    """A test that is not sealed as libraries simulate it: as long and with the sensors that were read in it.

    Of a test in which a block falls it is the part before.

    Raises
    ------
    InputError
        A commanded motion that is neither shipped nor in the campaign's folder, or bad readings.
    """
    test = load_test(campaign, name)
    test = until_fall(test, find_fall(test, structure, campaign.sensors))
    late = -simulation_start(test["time"].to_numpy())
    test = since(test, -late)
    time, rate = test["time"].to_numpy(), reading_rate(test["time"].to_numpy())
    return PlannedTest(
        structure=structure,
        motion=planned_motion(campaign, name),
        duration=float(np.ceil(time[-1] * rate - _SAME_READING) / rate),
        sensors=campaign.sensors,
        markers=tuple(map(str, test["marker"].values)),
        channels=tuple(map(str, test["channel"].values)) if "accelerometer" in test else (),
        unread=tuple(unread_directions(test)),
        clock=Clock(
            late,
            rate,
            reading_rate(test["time_acc"].to_numpy()) if "accelerometer" in test else accelerometers.RATE,
            float(time[0]),
        ),
    )


def planned_motion(campaign, name):
    """Commanded `Motion` of a test.

    Raises
    ------
    InputError
        It is neither shipped nor in the campaign's folder.
    """
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
    """Simulations of a campaign that are due before its readings are judged.

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

    def library(self, test, source):
        """Name of the library of a test: equal content and sources that both solvers share, equal name."""
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
    structure = load_structure(campaign.structure)
    tests = {name: planned_test(campaign, name, structure) for name in names}
    everywhere = candidates(structure)
    count = own_draws(EFFORTS[effort], len(everywhere), len(names), len(sealed_tests(campaign)))
    return Plan(campaign, EFFORTS[effort], tests, everywhere, count, considered(without))


def result_name(folder, without=()):
    """Name of a campaign's results: the folder's, with digits of its path unless it lies in the checkout."""
    path = Path(folder).resolve()
    name = path.name if _CHECKOUT in path.parents else f"{path.name}-{content_digest(str(path))[:6]}"
    return "-without-".join([re.sub(r"[^A-Za-z0-9._-]", "-", name), *without])


class PlannedLibrary(NamedTuple):
    """The plan of a campaign, and the name of the test that a library is of."""

    plan: Plan
    test: str


def plan_of_library(library, folders, effort, source):
    """`PlannedLibrary`: plan and test of the first of several campaigns that has a library.

    Parameters
    ----------
    library : str
        Name, as of `Plan.library`.
    folders : sequence of str
        Of campaigns.
    effort, source : str
    """
    for folder in folders:
        plan = plan_diagnosis(folder, effort)
        for test in plan.tests:
            if plan.library(test, source) == library:
                return PlannedLibrary(plan, test)
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
