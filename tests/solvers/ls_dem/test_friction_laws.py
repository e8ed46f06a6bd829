"""The hooks of friction: rate, slip, direction and joint, each against the sliding block it implies."""

import numpy as np
import pytest

G = 9.81
MU = 0.5
SHAPES = {"squat": {"box": [2.0, 1.0, 0.5]}, "slab": {"box": [8.0, 3.0, 0.2]}}
SPEED = 1.0


TURNS = {"none": [1, 0, 0, 0], "half turn": [0, 0, 0, 1], "upside down": [0, 0, 1, 0]}


def _slide(
    make_structure, run_ls_dem, *, law=None, direction=1.0, duration=0.15, order=(0, 1), turn="none", **keys
):
    """A squat block thrown along x or against it; its run and its index."""
    slab = {"name": "slab", "shape": "slab", "position": [0.0, 0.0, -0.1], "driven": True}
    block = {
        "name": "b",
        "shape": "squat",
        "position": [0.0, 0.0, 0.25],
        "velocity": [direction * SPEED, 0.0, 0.0],
        "orientation": TURNS[turn],
    }
    bodies = [(slab, block)[index] for index in order]
    entry = {"pair": ["stone", "stone"], "coefficient": MU, **(law or {})}
    structure = make_structure(bodies, slab=False, shapes=SHAPES, friction_laws=[entry], **keys)
    return run_ls_dem(structure, duration), order.index(1)


@pytest.fixture(scope="module")
def make_structure(make_mapping):
    from blockshake.geometry.structure import build_structure

    def make(bodies, *, friction_laws, **keys):
        return build_structure(make_mapping(bodies, **keys) | {"friction": friction_laws}, "test.yaml", ".")

    return make


def _deceleration(run, block):
    steady = (run.time > 0.04) & (run.time < 0.12)
    return -np.polyfit(run.time[steady], run.velocity[steady, block, 0], 1)[0]


def test_null_values_change_no_bit(make_structure, run_ls_dem):
    plain, _ = _slide(make_structure, run_ls_dem)
    null = {"rate_drop": 0.0, "rate_scale": 0.3, "slip_drop": 0.0, "slip_scale": 0.2, "asymmetry": 0.0}
    joints = [{"bodies": ["slab", "b"], "friction_factor": 1.0}]
    other, _ = _slide(make_structure, run_ls_dem, law=null, joints=joints)
    for field in ("position", "velocity", "energy", "joint_force"):
        assert getattr(plain, field).tobytes() == getattr(other, field).tobytes()


def test_rate_weakening_follows_its_law(make_structure, run_ls_dem):
    """dv/dt = -mu g (1 - D (1 - exp(-v / v_c))), against its exact solution for v(t)."""
    drop, scale = 0.4, 0.5
    run, block = _slide(make_structure, run_ls_dem, law={"rate_drop": drop, "rate_scale": scale})
    # with e = exp(v / v_c): d e / dt = -(mu g / v_c) ((1 - D) e + D)
    first = run.time >= 0.03  # the block has ceased to nod
    start = run.velocity[first, block, 0][0]
    t = run.time[first] - run.time[first][0]
    shift = drop / (1.0 - drop)
    grown = (np.exp(start / scale) + shift) * np.exp(-MU * G / scale * (1.0 - drop) * t) - shift
    np.testing.assert_allclose(run.velocity[first, block, 0], scale * np.log(grown), atol=2e-3)
    # which a constant coefficient misses by far more
    assert np.abs(start - MU * G * t - run.velocity[first, block, 0]).max() > 0.05


def test_slip_weakening_follows_its_law(make_structure, run_ls_dem):
    """Energy: v^2 / 2 falls by the integral of mu(S) g, S the slip."""
    drop, scale = 0.5, 0.05
    run, block = _slide(make_structure, run_ls_dem, law={"slip_drop": drop, "slip_scale": scale})
    slip = run.position[:, block, 0] - run.position[0, block, 0]
    work = MU * G * ((1.0 - drop) * slip + drop * scale * (1.0 - np.exp(-slip / scale)))
    late = run.time >= 0.03
    speed = np.sqrt(SPEED**2 - 2.0 * work[late])
    # the slip counted is friction heat over the friction force, and the first of it stretches springs
    np.testing.assert_allclose(run.velocity[late, block, 0], speed, atol=5e-3)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize("turn", TURNS)
def test_friction_may_differ_by_direction(turn, direction, order, make_structure, run_ls_dem):
    """mu (1 + a) for slip of the second body along the first's +x, mu (1 - a) the other way."""
    run, block = _slide(
        make_structure, run_ls_dem, law={"asymmetry": 0.2}, direction=direction, order=order, turn=turn
    )
    second_moves_along_x = direction if block == 1 else -direction
    if block == 0 and turn != "none":  # the first body is the one that is turned, and its x points back
        second_moves_along_x *= -1.0
    assert direction * _deceleration(run, block) == pytest.approx(
        (1.0 + 0.2 * second_moves_along_x) * MU * G, rel=1e-3
    )


def test_a_joint_may_be_weak(make_structure, run_ls_dem):
    run, block = _slide(
        make_structure, run_ls_dem, joints=[{"bodies": ["b", "slab"], "friction_factor": 0.6}]
    )
    assert _deceleration(run, block) == pytest.approx(0.6 * MU * G, rel=1e-3)
