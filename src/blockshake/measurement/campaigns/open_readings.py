"""Readings of the open tests of a campaign: every file is read once, and a sealed one never."""

from typing import NamedTuple

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.structure import Structure, load_structure
from blockshake.measurement.campaigns.campaign import load_test
from blockshake.measurement.campaigns.recorded_test import read_test
from blockshake.measurement.motion.fall import find_fall, until_fall


class OpenReadings(NamedTuple):
    """Tests of a campaign by name as their files have them, until a block falls, and each `Fall` by the test's name.

    Tests with the same readings count once, the first of them.
    """

    structure: Structure
    tests: dict
    falls: dict


def read_open_tests(campaign, names):
    """`OpenReadings` of the named tests.

    Raises
    ------
    InputError
        A name that is not in the campaign, or of a sealed test: its file is not opened.

    Notes
    -----
    Noise makes two tests differ in every reading, however alike they are. Equal readings are one test under two names,
    and evidence that counts them twice would be as sure of one test as of two.
    """
    for name in names:
        if name not in campaign.open:
            raise InputError(campaign.folder, f"tests.{name}", f"expected one of {', '.join(campaign.open)}")
    return _readings(campaign, names)


def open_test_names(campaign):
    """Names of the tests of `read_open_tests`, for whoever needs no more of them."""
    structure = load_structure(campaign.structure)
    names = reversed(campaign.open)
    first = {
        _content(read_test(campaign.folder / campaign.tests[name].file, structure)): name for name in names
    }
    return [name for name in campaign.open if name in first.values()]


def read_sealed_tests(campaign):
    """`OpenReadings` of the sealed tests: for the gain alone, once all is decided."""
    return _readings(campaign, list(campaign.sealed))


def _readings(campaign, names):
    structure = load_structure(campaign.structure)
    tests, falls, known = {}, {}, set()
    for name in names:
        test = load_test(campaign, name, structure)
        content = _content(test)
        if content in known:
            continue
        known.add(content)
        fall = find_fall(test, structure, campaign.sensors)
        tests[name] = until_fall(test, fall)
        if fall:
            falls[name] = fall
    return OpenReadings(structure, tests, falls)


def _content(test):
    """Displacements of the markers by name, as bytes; gaps are equal."""
    values = test["marker_displacement"].transpose("time", "marker", "axis").sortby("marker").to_numpy()
    return (np.round(values, 12) + 0.0).tobytes()  # no minus zero
