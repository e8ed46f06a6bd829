"""Readings without the faults that were found."""

from blockshake.measurement.campaigns.campaign import load_test
from blockshake.measurement.campaigns.clocks import simulation_start, since
from blockshake.measurement.motion.fall import find_fall, until_fall
from blockshake.parity.kinds.registry import KINDS


def load_corrected_test(campaign, name, structure, findings):
    """Load a test of a campaign, without the faults that were found, until a block falls; see `judged_readings`."""
    test = load_test(campaign, name, structure)
    test = until_fall(test, find_fall(test, structure, campaign.sensors))
    return judged_readings(test, name, structure, findings)


def judged_readings(test, name, structure, findings):
    """A test without the faults that were found, its times from `simulation_start` on.

    Times count as those of the tests that are simulated with it; what was read before is left out.
    """
    test = corrected(test, name, structure, findings)
    return since(test, simulation_start(test["time"].to_numpy()))


def corrected(test, name, structure, findings):
    """Take the findings out of one test's readings, kind by kind in the order of the registry.

    Parameters
    ----------
    test : xarray.Dataset
        As read.
    name : str
        Of the test: findings of other tests do not touch it.
    structure : Structure
    findings : sequence of Finding

    Returns
    -------
    xarray.Dataset
        The test without these faults. The optical clock stays: the accelerometers' times are moved onto it.
    """
    test = test.transpose("time", "marker", "axis", ...).copy(deep=True)
    for kind in KINDS.values():
        mine = [
            finding for finding in findings if finding.quantity == kind.quantity and name in finding.tests
        ]
        if mine and kind.correct:
            kind.correct(test, mine, structure)
    return test
