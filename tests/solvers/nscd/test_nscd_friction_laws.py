"""The hooks of friction: rate, slip, direction and joint, each against the sliding block it implies."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion

G = 9.81
MU = 0.5
SHAPES = {"squat": {"box": [2.0, 1.0, 0.5]}}
SPEED = 1.0
STEP = 1e-3
FLOOR = {"name": "slab", "shape": "floor", "position": [0.0, 0.0, -0.1], "driven": True}


def slide(scene, simulate, *, law=None, direction=1.0, order=(0, 1), time_step=STEP, **keys):
    """A squat block thrown along x or against it; its run and its index."""
    block = {
        "name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25], "velocity": [direction * SPEED, 0.0, 0.0]
    }  # fmt: skip
    bodies = [(FLOOR, block)[index] for index in order]
    entry = {"pair": ["stone", "stone"], "coefficient": MU, **(law or {})}
    structure = scene(SHAPES, bodies, floor=False, friction=[entry], **keys)
    return simulate(structure, 0.15, time_step=time_step, output_step=1e-3), order.index(1)


def deceleration(run, block):
    return -np.polyfit(run.time[10:], run.velocity[10:, block, 0], 1)[0]


def test_null_values_change_no_bit(scene, simulate):
    plain, _ = slide(scene, simulate)
    null = {"rate_drop": 0.0, "rate_scale": 0.3, "slip_drop": 0.0, "slip_scale": 0.2, "asymmetry": 0.0}
    joints = [{"bodies": ["slab", "b"], "friction_factor": 1.0}]
    other, _ = slide(scene, simulate, law=null, joints=joints)
    for field in ("position", "velocity", "energy", "joint_force"):
        assert getattr(plain, field).tobytes() == getattr(other, field).tobytes()


def test_rate_weakening_follows_its_law(scene, simulate):
    """dv/dt = -mu g (1 - D (1 - exp(-v / v_c))), against its exact solution for v(t)."""
    drop, scale = 0.4, 0.5
    errors = []
    for step in (STEP, 0.5 * STEP):
        run, block = slide(scene, simulate, law={"rate_drop": drop, "rate_scale": scale}, time_step=step)
        # with e = exp(v / v_c): d e / dt = -(mu g / v_c) ((1 - D) e + D)
        shift = drop / (1.0 - drop)
        grown = (np.exp(SPEED / scale) + shift) * np.exp(-MU * G / scale * (1.0 - drop) * run.time) - shift
        errors.append(np.abs(run.velocity[:, block, 0] - scale * np.log(grown)).max())
    # the coefficient is that of a step before, and of rest in the first step: mu g D dt at once, 2 mm/s, and
    # it follows a deceleration mu g a step late: (D / v_c) mu g dt of the slope over the run
    assert errors[0] < MU * G * drop * STEP * (1.0 + MU * G * 0.15 / scale)
    assert errors[1] < 0.55 * errors[0]


def test_slip_weakening_follows_its_law(scene, simulate):
    """Energy: v^2 / 2 falls by the integral of mu(S) g, S the slip."""
    drop, scale = 0.5, 0.05
    run, block = slide(scene, simulate, law={"slip_drop": drop, "slip_scale": scale})
    slip = run.position[:, block, 0] - run.position[0, block, 0]
    work = MU * G * ((1.0 - drop) * slip + drop * scale * (1.0 - np.exp(-slip / scale)))
    speed = np.sqrt(SPEED**2 - 2.0 * work)
    # the slip is counted a step late and misses half of the first step: 1.5 v dt = 1.5 mm of the 50 mm on
    # which mu falls by D, felt over the run: 1.5 D mu g dt, twice for the curvature
    np.testing.assert_allclose(run.velocity[:, block, 0], speed, atol=3.0 * drop * MU * G * STEP)
    # which a constant coefficient misses by far more
    assert np.abs(SPEED - MU * G * run.time - run.velocity[:, block, 0]).max() > 0.1


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_friction_may_differ_by_direction(direction, order, scene, simulate):
    """mu (1 + a) for slip of the second body along the first's +x, mu (1 - a) the other way."""
    run, block = slide(scene, simulate, law={"asymmetry": 0.2}, direction=direction, order=order)
    second_moves_along_x = direction if block == 1 else -direction
    # exact in the local law: the coefficient of a step is that of its own direction
    assert direction * deceleration(run, block) == pytest.approx(
        (1.0 + 0.2 * second_moves_along_x) * MU * G, rel=1e-6
    )
    assert run.numerics["capped_steps"] == 0


def test_two_free_blocks_know_the_file_order_and_not_their_height(scene, simulate):
    """The upper block is the file's first: the sign is that of the lower one's slip along the upper one's x."""
    bodies = [
        FLOOR,
        {"name": "high", "shape": "squat", "position": [0.0, 0.0, 0.75], "velocity": [SPEED, 0.0, 0.0]},
        {"name": "low", "shape": "squat", "position": [0.0, 0.0, 0.25]},
    ]
    laws = [
        {"pair": ["stone", "stone"], "coefficient": MU, "asymmetry": 0.3},
        {"pair": ["stone", "ice"], "coefficient": 0.9},
    ]
    bodies[0] = {**FLOOR, "material": "ice"}
    stone = {"density": 2400.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2}
    materials = {"stone": stone, "ice": stone}
    run = simulate(
        scene(SHAPES, bodies, floor=False, friction=laws, materials=materials), 0.1, output_step=1e-3
    )
    # low slips to -x against high: the smaller coefficient
    assert deceleration(run, 1) == pytest.approx(0.7 * MU * G, rel=1e-6)
    np.testing.assert_allclose(run.velocity[:, 2], 0.0, atol=1e-6)


def test_a_turned_first_body_turns_the_direction(scene, simulate):
    """Slip at 60 degrees to the first body's x axis has half of the bias, and goes straight."""
    yaw = np.radians(60.0)
    floor = {**FLOOR, "orientation": [np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)]}
    block = {"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25], "velocity": [SPEED, 0.0, 0.0]}
    law = {"pair": ["stone", "stone"], "coefficient": MU, "asymmetry": 0.4}
    run = simulate(scene(SHAPES, [floor, block], floor=False, friction=[law]), 0.15, output_step=1e-3)
    assert deceleration(run, 1) == pytest.approx((1.0 + 0.4 * 0.5) * MU * G, rel=1e-4)
    # every point slips along x and its friction points back along x
    assert np.abs(run.velocity[:, 1, 1]).max() < 1e-4
    assert run.numerics["max_residual"] < 1e-7


@pytest.mark.parametrize(("pull", "slides"), [(-0.41, True), (-0.39, False), (0.61, True), (0.59, False)])
def test_a_resting_block_gives_way_by_direction(pull, slides, scene, simulate):
    """At rest as well: it yields to a slope of mu (1 - a) one way and of mu (1 + a) the other."""
    law = {"pair": ["stone", "stone"], "coefficient": MU, "asymmetry": 0.2}
    block = {"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}
    structure = scene(SHAPES, [FLOOR, block], floor=False, friction=[law], gravity=[pull * G, 0.0, -G])
    run = simulate(structure, 0.5)
    limit = MU * (1.0 + 0.2 * np.sign(pull))
    expected = 0.5 * G * (pull - np.sign(pull) * limit) * 0.5**2 if slides else 0.0
    # explicit start of a step of implicit Euler: v dt / 2 of the way
    assert run.position[-1, 1, 0] == pytest.approx(expected, rel=3e-3, abs=1e-8)


def test_a_joint_may_be_weak(scene, simulate):
    run, block = slide(scene, simulate, joints=[{"bodies": ["b", "slab"], "friction_factor": 0.6}])
    assert deceleration(run, block) == pytest.approx(0.6 * MU * G, rel=1e-6)


def test_an_asymmetric_rocking_stack_converges(scene, simulate):
    """Impacts, slip in the plane and turns of it: the direction is found within each step."""
    shapes = {"block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02}}
    bodies = [{"name": f"b{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(3)]
    law = {"pair": ["stone", "stone"], "coefficient": 0.35, "asymmetry": 0.3}
    time = np.linspace(0.0, 3.0, 601)
    motion = ground_motion(
        "two", time, {"x": 3.0 * np.sin(2 * np.pi * 1.5 * time), "y": 3.5 * np.sin(2 * np.pi * 2.1 * time)},
        "acceleration",
    )  # fmt: skip
    run = simulate(scene(shapes, [FLOOR, *bodies], floor=False, friction=[law]), 3.0, motion=motion)
    assert run.numerics["fraction_above_1e-4"] == 0.0
    assert run.energy[-1, 3] > 100.0
    assert run.numerics["mean_iterations"] < 20.0
