"""Tests of a campaign as they are judged: each file read once, sensors checked, their faults taken out, forces seen."""

from dataclasses import replace
from typing import NamedTuple

from blockshake.errors import InputError
from blockshake.forces.seen.seen_test import see_test
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_test
from blockshake.measurement.campaigns.command_clock import simulation_start, since
from blockshake.measurement.campaigns.repeats import without_repeats
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.measurement.motion.outliers import without_outliers
from blockshake.parity.correction import corrected
from blockshake.parity.parity import Parity, check_parity


class SeenCampaign(NamedTuple):
    """Checks of the sensors, and the tests as `SeenTest`, in the order of the campaign."""

    parity: Parity
    tests: list


def see_open_tests(campaign, without=()):
    """`SeenCampaign` of the tests that are not sealed; of equal readings the first test stays.

    Parameters
    ----------
    campaign : Campaign
    without : sequence of str
        Effects that are left out, as if nobody had thought of them: the readings keep these faults.

    Raises
    ------
    InputError
        No such test, or bad readings.
    """
    names = [test.name for test in campaign.tests.values() if test.role != "sealed"]
    if not names:
        raise InputError(
            campaign.folder / "campaign.yaml",
            "tests",
            "expected a test with the role fit or select, found none",
        )
    return _see(campaign, without_repeats({name: load_test(campaign, name) for name in names}), without)


def see_sealed_tests(campaign):
    """`SeenCampaign` of the sealed tests."""
    sealed = [test.name for test in campaign.tests.values() if test.role == "sealed"]
    return _see(campaign, {name: load_test(campaign, name) for name in sealed}, ())


def _see(campaign, tests, without):
    structure, sensors = load_structure(campaign.structure), campaign.sensors
    falls = {name: find_fall(test, structure, sensors) for name, test in tests.items()}
    tests = {name: until_fall(test, falls[name]) for name, test in tests.items()}
    parity = check_parity(tests, structure, sensors)
    findings = tuple(one for one in parity.findings if one.effect not in without)
    seen = []
    for name, test in tests.items():
        sound = corrected(test, name, structure, findings)
        sound = without_outliers(since(sound, simulation_start(sound["time"].to_numpy())), structure)
        seen.append(see_test(name, sound, structure, sensors))
    fell = {name: fall for name, fall in falls.items() if fall}
    return SeenCampaign(replace(parity, findings=findings, falls=fell), seen)
