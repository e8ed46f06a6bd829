"""Histories of measured tests of a campaign, without their sensors' faults."""

from blockshake.diagnosis.nominal.histories import read_histories
from blockshake.geometry.structure import load_structure
from blockshake.parity.correction import load_corrected_test


def measured_histories(campaign, names, findings):
    """Histories of tests by name, from `read_histories`.

    Parameters
    ----------
    campaign : Campaign
    names : iterable of str
        A sealed test is read only where the gain is measured.
    findings : sequence of Finding
        Sensor faults that are taken out first.
    """
    structure = load_structure(campaign.structure)
    return {
        name: read_histories(
            load_corrected_test(campaign, name, structure, findings), structure, campaign.sensors
        )
        for name in names
    }
