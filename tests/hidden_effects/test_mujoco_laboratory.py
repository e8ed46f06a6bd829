"""MuJoCo's laboratory is one: free rocking, sliding and overturning as theory has them, and every cause at its size.

Skipped where `make peers` has not set up the peers' environment.
"""

from itertools import pairwise

import mujoco_case
import numpy as np
import pytest
from mujoco_case import EVERY, TIME_STEP, run_laboratory
from scipy.integrate import solve_ivp

pytestmark = pytest.mark.skipif(
    not mujoco_case.is_there(),
    reason="there is no mujoco in the environment of the peers: `make peers` sets it up",
)

G, DENSITY = 9.81, 2400.0
BOX, CHAMFER = (0.4, 1.2, 2.0), 0.02
FALLEN = 1.2  # rad


def task(duration, acceleration=0.0, box=BOX, friction=0.75, tilt=0.0, pitch=0.0, blocks=1, **joint):
    """Equal blocks on a slab, at rest or tilted about an edge, under a history of acceleration."""
    steps = round(duration / TIME_STEP)
    x, turned = (np.broadcast_to(values, steps).astype(float) for values in (acceleration, pitch))
    half = 0.5 * np.array(box)
    edge = half[0] - CHAMFER
    # the block stands on its edge at +x
    middle = np.array([
        edge + np.cos(tilt) * -edge + np.sin(tilt) * half[2], 0.0, np.sin(tilt) * edge + np.cos(tilt) * half[2]
    ])  # fmt: skip
    names = [f"block-{number + 1}" for number in range(blocks)]
    kept = np.zeros(steps // EVERY + 1)
    return {
        "slab": {"name": "slab", "box": [3.0, 3.0, 0.2], "chamfer": 0.0, "position": [0.0, 0.0, -0.1],
                 "density": DENSITY, "mass_offset": [0.0] * 3, "compliance": 0.0, "damping": 0.0},
        "bodies": [
            {"name": name, "box": list(box), "chamfer": CHAMFER, "density": DENSITY, "mass_offset": [0.0] * 3,
             "position": [0.0, 0.0, (2 * number + 1) * half[2]]}
            for number, name in enumerate(names)
        ],
        "joints": [
            {"lower": lower, "upper": upper, "friction": friction, "compliance": 0.0, "damping_ratio": 1.0,
             "law": None} | joint
            for lower, upper in zip(["slab", *names], names, strict=False)
        ],
        "sensors": [{"body": "slab", "position": [0.0] * 3}, {"body": "block-1", "position": [0.0] * 3}],
        "tests": [{
            "poses": [
                [middle[0], 0.0, middle[2] + 2 * number * half[2], np.cos(0.5 * tilt), 0.0, np.sin(0.5 * tilt), 0.0]
                for number in range(blocks)
            ],
            "most_tilt": FALLEN, "forces": [], "chamfers": dict.fromkeys(names, CHAMFER), "at_once": bool(tilt),
            "motion": {"x": x, "z": np.zeros(steps), "pitch": turned, "moved_x": kept, "moved_z": kept},
        }],
    }  # fmt: skip


def tilt_of(pose):
    return 2.0 * np.arctan2(pose[:, 5], pose[:, 3])


def rigid(box=BOX):
    """Half width, half height, rocking frequency of a block and what an impact keeps of its turning (Housner 1963)."""
    b, h = 0.5 * box[0] - CHAMFER, 0.5 * box[2]
    central = (box[0] ** 2 + box[2] ** 2) / 12.0  # over the mass; chamfers take 1 % off
    about_edge = central + b**2 + h**2
    p = np.sqrt(G * np.hypot(b, h) / about_edge)
    return b, h, p, (central + h**2 - b**2) / about_edge


def test_free_rocking_has_housners_period_and_loses_housners_energy():
    b, h, p, kept = rigid()
    alpha, start = np.arctan(b / h), 0.5 * np.arctan(b / h)
    pose = run_laboratory(task(4.0, tilt=start))["0-pose"][:, 1]
    time, found = TIME_STEP * EVERY * np.arange(len(pose)), tilt_of(pose)

    def fall(t, state):
        return state[1], -(p**2) * np.sin(alpha - state[0])

    hit = lambda t, state: state[0]  # noqa: E731
    hit.terminal, hit.direction = True, -1
    own = solve_ivp(fall, (0.0, 4.0), (start, 0.0), events=hit, rtol=1e-9, atol=1e-12)
    crossings = time[1:][np.diff(np.sign(found)) != 0]
    assert crossings[0] == pytest.approx(own.t_events[0][0], rel=0.01)
    # an impact keeps the share of the turning, and so the square of it of the energy above rest
    energy = lambda tilt: np.cos(alpha - abs(tilt)) - np.cos(alpha)  # noqa: E731
    peaks = [np.abs(found[(time > one) & (time < other)]).max() for one, other in pairwise(crossings)]
    ratios = np.array(
        [energy(later) / energy(peak) for peak, later in zip([start, *peaks], peaks, strict=False)]
    )
    assert len(peaks) >= 4
    assert ratios[:4] == pytest.approx(kept**2, rel=0.04)


def test_a_block_slides_by_coulombs_law():
    box, mu = (1.6, 2.4, 0.8), 0.15
    held = run_laboratory(task(1.0, 0.95 * mu * G, box, mu))["0-pose"][:, 1, 0]
    assert np.abs(held - held[0]).max() < 2e-5
    acceleration = 3.0
    moved = run_laboratory(task(1.0, acceleration, box, mu))["0-pose"][:, 1, 0]
    assert moved[0] - moved[-1] == pytest.approx(0.5 * (acceleration - mu * G) * 1.0**2, rel=2e-3)


def test_a_block_uplifts_at_the_static_limit():
    b, h, *_ = rigid()
    tilts = [float(run_laboratory(task(0.5, share * G * b / h))["0-tilt"]) for share in (0.98, 1.02)]
    assert tilts[0] < 1e-4
    assert tilts[1] > 1e-3


def test_a_rectangular_pulse_overturns_a_block_by_housners_condition():
    """``cosh(p t) = 1 + 1 / (2 x (x - 1))`` for small angles, x the acceleration over that of uplift."""
    box = (0.24, 1.2, 2.4)
    b, h, p, _ = rigid(box)
    share = 1.5
    long = np.arccosh(1.0 + 1.0 / (2.0 * share * (share - 1.0))) / p
    for factor, falls in ((0.94, False), (1.06, True)):
        time = TIME_STEP * np.arange(round(4.0 / TIME_STEP))
        pulse = np.where(time < factor * long, -share * G * b / h, 0.0)
        answer = run_laboratory(task(4.0, pulse, box))
        assert (float(answer["0-factor"]) < 1.0) == falls


def test_a_layer_is_pressed_in_by_its_compliance():
    c = 5e-10
    soft, plain = (
        run_laboratory(task(0.5, blocks=2, compliance=value))["0-pose"][-1, 1:, 2] for value in (c, 0.0)
    )
    area = (BOX[0] - 2 * CHAMFER) * (BOX[1] - 2 * CHAMFER)
    weight = DENSITY * np.prod(BOX) * G
    assert plain[0] - soft[0] == pytest.approx(2.0 * c * weight / area, rel=0.05)
    assert plain[1] - soft[1] == pytest.approx(3.0 * c * weight / area, rel=0.05)


def test_a_soft_base_turns_by_the_moment():
    shaken = task(2.0, 0.5, blocks=2)
    compliance = 2e-7
    shaken["slab"] |= {"compliance": compliance, "damping": 4e5}
    turn = tilt_of(run_laboratory(shaken)["0-pose"][:, 0])
    masses = DENSITY * np.prod(BOX) * (0.99**2), DENSITY * 3.0 * 3.0 * 0.2
    # heights above the slab's bottom
    moment = 0.5 * (masses[0] * (0.2 + 1.0) + masses[0] * (0.2 + 3.0) + masses[1] * 0.1)
    assert -turn[-1] == pytest.approx(compliance * moment, rel=0.1)


def test_friction_falls_with_the_rate():
    box, mu, drop = (1.6, 2.4, 0.8), 0.3, 0.5
    law = {"asymmetry": 0.0, "rate_drop": drop, "rate_scale": 0.01, "slip_drop": 0.0, "slip_scale": 0.01}
    moved = run_laboratory(task(1.0, 4.0, box, mu, law=law))["0-pose"][:, 1, 0]
    expected = 0.5 * (4.0 - mu * (1.0 - drop) * G)
    assert moved[0] - moved[-1] == pytest.approx(expected, rel=0.02)


def test_friction_has_two_sides():
    box, mu, a = (1.6, 2.4, 0.8), 0.2, 0.3
    law = {"asymmetry": a, "rate_drop": 0.0, "rate_scale": 0.01, "slip_drop": 0.0, "slip_scale": 0.01}
    for side in (1.0, -1.0):
        moved = run_laboratory(task(0.8, side * 4.0, box, mu, law=law))["0-pose"][:, 1, 0]
        # the block slips against the shaking
        expected = 0.5 * (4.0 - mu * (1.0 - side * a) * G) * 0.8**2
        assert side * (moved[0] - moved[-1]) == pytest.approx(expected, rel=0.02)


def test_a_pitched_table_lets_a_block_slide_by_its_slope():
    box, mu, slope = (1.6, 2.4, 0.8), 0.15, 0.25
    time = TIME_STEP * np.arange(round(1.2 / TIME_STEP))
    pitch = slope * np.clip(time / 0.2, 0.0, 1.0) ** 2 * (3.0 - 2.0 * np.clip(time / 0.2, 0.0, 1.0))
    pose = run_laboratory(task(1.2, 0.0, box, mu, pitch=pitch))["0-pose"]
    # a slope about +y is downhill along +x
    along = (pose[:, 1, :3] - pose[:, 0, :3]) @ [np.cos(slope), 0.0, -np.sin(slope)]
    late = slice(600, 1200)
    clock = TIME_STEP * EVERY * np.arange(len(pose))[late]
    expected = G * (np.sin(slope) - mu * np.cos(slope))
    assert 2.0 * np.polyfit(clock, along[late], 2)[0] == pytest.approx(expected, rel=0.01)


def test_a_block_at_rest_feels_gravity_and_the_shaking():
    answer = run_laboratory(task(0.2, 1.0))
    felt = answer["0-force"][-1]
    assert felt[:, 0] == pytest.approx(1.0, abs=1e-3)
    assert felt[:, 2] == pytest.approx(G, rel=1e-3)
