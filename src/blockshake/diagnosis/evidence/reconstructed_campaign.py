"""A campaign from its files to the tests as the sensors show them: every file is read once."""

from typing import NamedTuple

from blockshake.errors import InputError
from blockshake.forces.seen.reconstructed_test import reconstruct_test, why_not_reconstructed
from blockshake.measurement.campaigns.initial_poses import initial_poses
from blockshake.measurement.campaigns.open_readings import read_open_tests, read_sealed_tests
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.sensors.found_noise import found_noise
from blockshake.parity.correction import judged_readings
from blockshake.parity.parity import Parity, campaign_parity


class ReconstructedCampaign(NamedTuple):
    """Tests of a campaign as they are judged."""

    parity: Parity  # findings on the sensors, falls of blocks, and gaps
    tests: list  # of SeenTest; faults of sensors and outliers taken out, until a block falls
    unseen: dict  # str to str; reason why no forces can be read of a test, by its name


def reconstruct_campaign(campaign, without=()):
    """`ReconstructedCampaign` of the open tests of a `Campaign`.

    Sensors' effects ``without`` are left out, as if nobody had thought of them.

    Raises
    ------
    InputError
        No open test, or a file that `load_test` refuses.
    """
    if not campaign.open:
        expected = "expected a test with the role fit or select, found none"
        raise InputError(campaign.folder / "campaign.yaml", "tests", expected)
    return _seen(campaign, read_open_tests(campaign, list(campaign.open)), without)


def reconstruct_sealed(campaign):
    """`ReconstructedCampaign` of the sealed tests: for the gain alone, once all is decided."""
    return _seen(campaign, read_sealed_tests(campaign), ())


def found_sensors(campaign, readings):
    """`Sensors` of a `Campaign` with the noise that its readings show."""
    clear = {
        name: without_outliers(test, initial_poses(readings.structure, test))
        for name, test in readings.tests.items()
    }
    return found_noise(clear, readings.structure, campaign.sensors)


def _seen(campaign, readings, without):
    sensors = found_sensors(campaign, readings)
    parity = campaign_parity(readings, sensors, without)
    tests, unseen = [], {}
    for name, test in readings.tests.items():
        structure = initial_poses(readings.structure, test)
        judged = judged_readings(test, name, readings.structure, parity.findings)
        reason = why_not_reconstructed(judged, structure)
        if reason:
            unseen[name] = reason
        else:
            tests.append(reconstruct_test(name, without_outliers(judged, structure), structure, sensors))
    return ReconstructedCampaign(parity, tests, unseen)
