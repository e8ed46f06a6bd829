"""A marker that stops at the end of its range before its noise is added: named with its range, and nothing else."""

import numpy as np
import pytest
from synthetic_campaigns import make_tests

from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.parity.parity import check_parity

NOISE = 1e-4  # m
MARKER = "block-2-upper"


def _limited(tests, share, bend):
    """Tests whose marker stops along x at a share of its largest displacement, and that end [m]."""
    end = share * float(max(np.nanmax(np.abs(_along_x(test))) for test in tests.values()))
    generator, changed = np.random.default_rng(5), {}
    for name, test in tests.items():
        moved = np.clip(_along_x(test) / end, -1.0, 1.0)
        read = end * (moved - bend * moved**3) / (1.0 - bend)
        changed[name] = test.copy(deep=True)
        noise = np.where(np.abs(moved) < 1.0, 0.0, generator.normal(0.0, NOISE, moved.shape))
        changed[name]["marker_displacement"].loc[{"marker": MARKER, "axis": "x"}] = read + noise
    return changed, end


def _along_x(test):
    return test["marker_displacement"].sel(marker=MARKER, axis="x").to_numpy()


@pytest.mark.parametrize(("share", "bend"), [(0.6, 0.0), (0.8, 0.0), (0.6, 0.05)])
def test_a_limit_before_the_noise_is_named_with_its_end(clean_tests, three, share, bend):
    tests, end = _limited(clean_tests, share, bend)
    (finding,) = check_parity(tests, three, Sensors()).findings
    assert (finding.effect, finding.where, finding.quantity) == ("sensor-saturation", (MARKER,), "limit")
    assert finding.estimate[0] == pytest.approx(end, abs=NOISE)


def test_a_gain_and_a_wrong_place_are_no_limit(three):
    for fault, effect in (
        ({"marker_gain": {MARKER: 0.8}}, "sensor-gain"),
        ({"marker_offset": {MARKER: (0.0, 0.0, -0.05)}}, "marker-offset"),
    ):
        findings = check_parity(make_tests(three, 8, **fault), three, Sensors()).findings
        assert {finding.effect for finding in findings} == {effect}
