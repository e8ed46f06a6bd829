"""Records too short to show how their own noise scatters: what they cannot tell is not judged."""

import numpy as np
import pytest
from synthetic_campaigns import make_tests, structure_of_three

from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.parity.parity import check_parity
from blockshake.parity.regression import regression


def _shortened(tests, start, length):
    """The tests from a time on for a length [s], their readings counted from the first one."""
    short = {}
    for name, test in tests.items():
        rows = {
            clock: (test[clock].to_numpy() >= start) & (test[clock].to_numpy() <= start + length)
            for clock in ("time", "time_acc")
        }
        test = test.isel(rows)
        moved = test["marker_displacement"] - test["marker_displacement"].isel(time=0)
        short[name] = test.assign(marker_displacement=moved)
    return short


@pytest.fixture(scope="module")
def creeping():
    """Tests whose optical frame goes away by 1 mm/s: beyond any tolerance within half a second."""
    structure = structure_of_three()
    return structure, make_tests(structure, 7, mounting=1e-3, marker_drift=(0.0, 1e-3, 0.0))


@pytest.mark.parametrize("length", [0.3, 0.7, 0.99, 1.0, 2.0])
@pytest.mark.parametrize("start", [0.0, 3.0])
def test_a_short_record_has_no_drift_of_the_frame(creeping, length, start):
    structure, tests = creeping
    parity = check_parity(_shortened(tests, start, length), structure, Sensors())
    assert [finding.where for finding in parity.findings if finding.quantity == "drift"] == []


def test_the_same_drift_is_named_in_the_whole_record(creeping):
    structure, tests = creeping
    named = {finding.where for finding in check_parity(tests, structure, Sensors()).findings}
    assert named == {("optical frame",)}


@pytest.mark.parametrize(("length", "told"), [(1.4, False), (2.0, True)])
def test_fewer_than_four_segments_tell_no_error(length, told):
    """Residuals of one segment sum to zero: an error by them would be nothing, and any size beyond chance."""
    since = np.arange(0.0, length, 0.005)
    values = 0.1 * since + np.random.default_rng(3).normal(0.0, 1e-3, len(since))
    size = regression([(since[:, None], values, since)], 0.5)
    assert (size is not None) == told
    if told:
        assert abs(size.estimate[0] - 0.1) < 4.0 * np.sqrt(size.covariance[0, 0])


def test_what_a_short_record_cannot_show_is_said(creeping):
    structure, tests = creeping
    lines = check_parity(_shortened(tests, 0.0, 1.0), structure, Sensors()).gaps
    assert lines["t1"] == ["a record of 1 s is too short to show a drift of the optical frame"]
    assert check_parity(_shortened(tests, 0.0, 3.5), structure, Sensors()).gaps["t1"] == []


def test_a_body_that_is_never_read_in_a_test_is_not_checked_there(clean_tests, three):
    """Two of four markers are lost: what is left of them is no pose."""
    lost = clean_tests["t2"].copy(deep=True)
    lost["marker_displacement"].loc[{"marker": ["block-3-face", "block-3-upper"]}] = np.nan
    parity = check_parity(clean_tests | {"t2": lost}, three, Sensors())
    assert parity.findings == ()
    assert np.isfinite(parity.markers["noise"]).all()
