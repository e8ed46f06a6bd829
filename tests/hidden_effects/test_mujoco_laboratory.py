"""MuJoCo's laboratory is one: free rocking, sliding and overturning as theory has them, and every cause at its size.

Skipped where `make peers` has not set up the peers' environment.
"""

import mujoco_case
import numpy as np
import pytest
from laboratory_theory import (
    CHAMFER,
    DENSITY,
    FLAT,
    ROCKING,
    G,
    block_task,
    creep_and_slide,
    free_rocking,
    overturning_pulse,
    tilt_of,
    uplift,
)
from mujoco_case import EVERY, TIME_STEP, run_laboratory

pytestmark = pytest.mark.skipif(
    not mujoco_case.is_there(),
    reason="there is no mujoco in the environment of the peers: `make peers` sets it up",
)


def test_free_rocking_has_housners_period_and_loses_housners_energy():
    (impact, of_theory), (ratios, kept) = free_rocking()
    assert impact == pytest.approx(of_theory, rel=0.01)
    assert ratios == pytest.approx(kept, rel=0.04)


def test_a_block_slides_by_coulombs_law():
    creep, (way, of_theory) = creep_and_slide()
    assert creep < 2e-5
    assert way == pytest.approx(of_theory, rel=2e-3)


def test_a_block_uplifts_at_the_static_limit():
    below, above = uplift()
    assert below < 1e-4
    assert above > 1e-3


def test_a_rectangular_pulse_overturns_a_block_by_housners_condition():
    """Which is of small angles: the block's is 0.083 rad."""
    shortest, of_theory = overturning_pulse()
    assert shortest == pytest.approx(of_theory, rel=0.03)


def test_a_layer_is_pressed_in_by_its_compliance():
    c = 5e-10
    soft, plain = (
        run_laboratory(block_task(0.5, blocks=2, compliance=value))["0-pose"][-1, 1:, 2] for value in (c, 0.0)
    )
    pressure = DENSITY * np.prod(ROCKING) * G / ((ROCKING[0] - 2 * CHAMFER) * (ROCKING[1] - 2 * CHAMFER))
    # two blocks press on the lower layer, one on the upper
    assert plain[0] - soft[0] == pytest.approx(2.0 * c * pressure, rel=0.05)
    assert plain[1] - soft[1] == pytest.approx(3.0 * c * pressure, rel=0.05)


def test_a_soft_base_turns_by_the_moment():
    shaken = block_task(2.0, 0.5, blocks=2)
    compliance = 2e-7
    shaken["slab"] |= {"compliance": compliance, "damping": 4e5}
    turn = tilt_of(run_laboratory(shaken)["0-pose"][:, 0])
    block, slab = 0.99 * DENSITY * np.prod(ROCKING), DENSITY * 3.0 * 3.0 * 0.2
    # heights above the slab's bottom
    moment = 0.5 * (block * (0.2 + 1.0) + block * (0.2 + 3.0) + slab * 0.1)
    # second-order moments add 2 %
    assert -turn[-1] == pytest.approx(compliance * moment, rel=0.05)


def _law(**changed):
    none = {"asymmetry": 0.0, "rate_drop": 0.0, "rate_scale": 0.01, "slip_drop": 0.0, "slip_scale": 0.01}
    return none | changed


def _way(time, acceleration, friction, law):
    """Way of a flat block against the table."""
    moved = run_laboratory(block_task(time, acceleration, FLAT, friction, law=law))["0-pose"][:, 1, 0]
    return moved[0] - moved[-1]


@pytest.mark.parametrize("along", ["rate", "slip"])
def test_friction_falls_with_rate_or_slip(along):
    """Both laws lose half of the friction within some hundredths of a second."""
    mu, drop = 0.3, 0.5
    law = _law(**{f"{along}_drop": drop, f"{along}_scale": 0.001 if along == "slip" else 0.01})
    assert _way(1.0, 4.0, mu, law) == pytest.approx(0.5 * (4.0 - mu * (1.0 - drop) * G), rel=0.05)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_friction_has_two_sides(side):
    mu, asymmetry = 0.2, 0.3
    # the block slips against the shaking
    expected = 0.5 * (4.0 - mu * (1.0 - side * asymmetry) * G) * 0.8**2
    assert side * _way(0.8, side * 4.0, mu, _law(asymmetry=asymmetry)) == pytest.approx(expected, rel=0.02)


def test_a_pitched_table_lets_a_block_slide_by_its_slope():
    mu, slope = 0.15, 0.25
    ramp = np.clip(TIME_STEP * np.arange(round(1.2 / TIME_STEP)) / 0.2, 0.0, 1.0)
    pose = run_laboratory(block_task(1.2, 0.0, FLAT, mu, pitch=slope * ramp**2 * (3.0 - 2.0 * ramp)))[
        "0-pose"
    ]
    # a turn about +y makes +x the way down
    along = (pose[:, 1, :3] - pose[:, 0, :3]) @ [np.cos(slope), 0.0, -np.sin(slope)]
    late = slice(600, 1200)
    clock = TIME_STEP * EVERY * np.arange(len(pose))[late]
    expected = G * (np.sin(slope) - mu * np.cos(slope))
    assert 2.0 * np.polyfit(clock, along[late], 2)[0] == pytest.approx(expected, rel=0.01)


def test_a_block_at_rest_feels_gravity_and_the_shaking():
    felt = run_laboratory(block_task(0.2, 1.0))["0-force"][-1]
    assert felt[:, 0] == pytest.approx(1.0, abs=1e-3)
    assert felt[:, 2] == pytest.approx(G, rel=1e-3)
