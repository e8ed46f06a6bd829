"""The hooks of friction: rate, slip, direction and joint, each against the sliding block it implies."""

import numpy as np
import pytest
from both_solvers import both, solve

from blockshake.dynamics.motion import ground_motion

G = 9.81
MU = 0.5
SPEED = 1.0  # m/s
SHAPES = {"squat": {"box": [2.0, 1.0, 0.5]}, "floor": {"box": [8.0, 3.0, 0.2]}}
FLOOR = {"name": "slab", "shape": "floor", "position": [0.0, 0.0, -0.1], "driven": True}
THROWN = {"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25], "velocity": [SPEED, 0.0, 0.0]}
TURNS = {"none": [1, 0, 0, 0], "half turn": [0, 0, 0, 1], "upside down": [0, 0, 1, 0]}
WITHIN = {"ls-dem": 1e-3, "nscd": 1e-6}  # of a deceleration: springs let the block nod
SETTLED = {"ls-dem": 0.03, "nscd": 0.0}  # s; from then on the block has ceased to nod
STEP = 1e-3  # s, of NSCD


@pytest.fixture
def law_of(make_structure):
    """Structure of bodies whose friction is the coefficient `MU` with the keys of a law."""

    def make(bodies, law=None, **keys):
        entry = {"pair": ["stone", "stone"], "coefficient": MU, **(law or {})}
        return make_structure(bodies, slab=False, shapes=SHAPES, **{"friction": [entry], **keys})

    return make


def slide(solver, structure, duration=0.15, **keys):
    return solve(solver, structure, np.linspace(0.0, duration, round(1e3 * duration) + 1), **keys)


def deceleration(run, block):
    steady = (run.time > 0.04) & (run.time < 0.12)
    return -np.polyfit(run.time[steady], run.velocity[steady, block, 0], 1)[0]


@both
def test_rate_weakening_follows_its_law(solver, law_of):
    """dv/dt = -mu g (1 - D (1 - exp(-v / v_c))), against its exact solution for v(t)."""
    drop, scale = 0.4, 0.5
    structure = law_of([FLOOR, THROWN], {"rate_drop": drop, "rate_scale": scale})
    errors = []
    for step in (None,) if solver == "ls-dem" else (STEP, 0.5 * STEP):
        run = slide(solver, structure, time_step=step)
        late = run.time >= SETTLED[solver]
        speed, time = run.velocity[late, 1, 0], run.time[late] - run.time[late][0]
        # with e = exp(v / v_c): d e / dt = -(mu g / v_c) ((1 - D) e + D)
        shift = drop / (1.0 - drop)
        grown = (np.exp(speed[0] / scale) + shift) * np.exp(-MU * G / scale * (1.0 - drop) * time) - shift
        errors.append(np.abs(speed - scale * np.log(grown)).max())
        # which a constant coefficient misses by far more
        assert np.abs(speed[0] - MU * G * time - speed).max() > 0.05
    # NSCD's coefficient is that of a step before, and of rest in the first step: mu g D dt at once, 2 mm/s, and
    # it follows a deceleration mu g a step late: (D / v_c) mu g dt of the slope over the run
    assert errors[0] < (2e-3 if solver == "ls-dem" else MU * G * drop * STEP * (1.0 + MU * G * 0.15 / scale))
    assert solver == "ls-dem" or errors[1] < 0.55 * errors[0]


@both
def test_slip_weakening_follows_its_law(solver, law_of):
    """Energy: v^2 / 2 falls by the integral of mu(S) g, S the slip."""
    drop, scale = 0.5, 0.05
    run = slide(solver, law_of([FLOOR, THROWN], {"slip_drop": drop, "slip_scale": scale}))
    late = run.time >= SETTLED[solver]
    slip = (run.position[:, 1, 0] - run.position[0, 1, 0])[late]
    work = MU * G * ((1.0 - drop) * slip + drop * scale * (1.0 - np.exp(-slip / scale)))
    # LS-DEM counts friction heat over the friction force, and the first of it stretches springs. NSCD counts the slip
    # a step late and misses half of the first step: 1.5 v dt = 1.5 mm of the 50 mm on which mu falls by D, felt over
    # the run: 1.5 D mu g dt, twice for the curvature
    within = 5e-3 if solver == "ls-dem" else 3.0 * drop * MU * G * STEP
    np.testing.assert_allclose(run.velocity[late, 1, 0], np.sqrt(SPEED**2 - 2.0 * work), atol=within)
    # which a constant coefficient misses by far more
    assert np.abs(SPEED - MU * G * run.time - run.velocity[:, 1, 0]).max() > 0.1


@both
@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize("turn", TURNS)
def test_friction_may_differ_by_direction(turn, direction, order, solver, law_of):
    """mu (1 + a) for slip of the second body along the first's +x, mu (1 - a) the other way."""
    thrown = {**THROWN, "velocity": [direction * SPEED, 0.0, 0.0], "orientation": TURNS[turn]}
    run = slide(solver, law_of([(FLOOR, thrown)[index] for index in order], {"asymmetry": 0.2}))
    block = order.index(1)
    second_moves_along_x = direction if block == 1 else -direction
    if block == 0 and turn != "none":  # the first body is the one that is turned, and its x points back
        second_moves_along_x *= -1.0
    expected = (1.0 + 0.2 * second_moves_along_x) * MU * G
    assert direction * deceleration(run, block) == pytest.approx(expected, rel=WITHIN[solver])
    # in NSCD exact in the local law: the coefficient of a step is that of its own direction
    assert run.numerics.get("capped_steps", 0) == 0


@both
def test_a_joint_may_be_weak(solver, law_of):
    run = slide(solver, law_of([FLOOR, THROWN], joints=[{"bodies": ["b", "slab"], "friction_factor": 0.6}]))
    assert deceleration(run, 1) == pytest.approx(0.6 * MU * G, rel=WITHIN[solver])


def test_two_free_blocks_know_the_file_order_and_not_their_height(law_of):
    """The upper block is the file's first: the sign is that of the lower one's slip along the upper one's x."""
    high, low = (
        {**THROWN, "name": name, "position": [0.0, 0.0, z]} for name, z in (("high", 0.75), ("low", 0.25))
    )
    stone = {"density": 2400.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2}
    laws = [
        {"pair": ["stone", "stone"], "coefficient": MU, "asymmetry": 0.3},
        {"pair": ["stone", "ice"], "coefficient": 0.9},
    ]
    bodies = [{**FLOOR, "material": "ice"}, high, {**low, "velocity": [0.0, 0.0, 0.0]}]
    run = slide("nscd", law_of(bodies, friction=laws, materials={"stone": stone, "ice": stone}), 0.1)
    # low slips to -x against high: the smaller coefficient
    assert deceleration(run, 1) == pytest.approx(0.7 * MU * G, rel=1e-6)
    np.testing.assert_allclose(run.velocity[:, 2], 0.0, atol=1e-6)


def test_a_turned_first_body_turns_the_direction(law_of):
    """Slip at 60 degrees to the first body's x axis has half of the bias, and goes straight."""
    yaw = np.radians(60.0)
    floor = {**FLOOR, "orientation": [np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)]}
    run = slide("nscd", law_of([floor, THROWN], {"asymmetry": 0.4}))
    assert deceleration(run, 1) == pytest.approx((1.0 + 0.4 * 0.5) * MU * G, rel=1e-4)
    # every point slips along x and its friction points back along x
    assert np.abs(run.velocity[:, 1, 1]).max() < 1e-4
    assert run.numerics["max_residual"] < 1e-7


@pytest.mark.parametrize(("pull", "slides"), [(-0.41, True), (-0.39, False), (0.61, True), (0.59, False)])
def test_a_resting_block_gives_way_by_direction(pull, slides, law_of):
    """At rest as well: it yields to a slope of mu (1 - a) one way and of mu (1 + a) the other."""
    block = {**THROWN, "velocity": [0.0, 0.0, 0.0]}
    run = slide("nscd", law_of([FLOOR, block], {"asymmetry": 0.2}, gravity=[pull * G, 0.0, -G]), 0.5)
    limit = MU * (1.0 + 0.2 * np.sign(pull))
    expected = 0.5 * G * (pull - np.sign(pull) * limit) * 0.5**2 if slides else 0.0
    # explicit start of a step of implicit Euler: v dt / 2 of the way
    assert run.position[-1, 1, 0] == pytest.approx(expected, rel=3e-3, abs=1e-8)


def test_an_asymmetric_rocking_stack_converges(law_of):
    """Impacts, slip in the plane and turns of it: the direction is found within each step."""
    bodies = [{"name": f"b{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(3)]
    time = np.linspace(0.0, 3.0, 601)
    motion = ground_motion(
        "two", time, {"x": 3.0 * np.sin(2 * np.pi * 1.5 * time), "y": 3.5 * np.sin(2 * np.pi * 2.1 * time)},
        "acceleration",
    )  # fmt: skip
    run = solve("nscd", law_of([FLOOR, *bodies], {"coefficient": 0.35, "asymmetry": 0.3}), 3.0, motion)
    assert run.numerics["fraction_unconverged"] == 0.0
    assert run.energy[-1, 3] > 100.0
    assert run.numerics["mean_iterations"] < 20.0
