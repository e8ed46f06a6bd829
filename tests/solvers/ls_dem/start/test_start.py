import numpy as np
import pytest

from blockshake.geometry.structure import load_structure
from blockshake.solvers.ls_dem.parameters import LsDemParameters

G = 9.81
K_N = LsDemParameters().normal_stiffness
FLAT = 0.76 * 2.36  # m2, a block's flat within its chamfers
REST = 1e-9  # of the weight: what the relaxation leaves out of balance
# rad/s, softest mode of the stacks: the sway of a four-block wall on its joints' springs,
# sqrt(k_n I_flat / (M H^2 / 3)) = sqrt(1.87e9 N m / 4.4e5 kg m2) = 65, less its joints in series
SWAY = 30.0


@pytest.mark.parametrize("number", [1, 3])
def test_a_stack_starts_in_equilibrium_and_stays(number, run_ls_dem):
    """Hooke: every interface is pressed by the weight above it over ``k_n A``; nothing thumps."""
    structure = load_structure(f"configuration-{number}")
    run = run_ls_dem(structure, 1.0 if number == 1 else 0.25)
    names = structure.body_names
    weight = structure.mass * G
    if number == 1:
        penetration = structure.position[1:, 2] - run.position[0, 1:, 2]
        above = np.array([weight[1:].sum(), weight[2:].sum(), weight[3]])
        np.testing.assert_allclose(penetration, np.cumsum(above / (K_N * FLAT)), rtol=1e-6)
        for joint, (_, upper) in enumerate(run.joints):
            np.testing.assert_allclose(run.joint_force[:, joint, 2], above[upper - 1], rtol=1e-8)
    else:
        top = [i for i, pair in enumerate(run.joints) if names[pair[1]] == "top"]
        assert run.joint_force[0, top, 2].sum() == pytest.approx(weight[-1], rel=1e-8)
    assert run.status == "completed"
    # an imbalance of REST on each of the bodies, at the most
    assert np.abs(run.position - run.position[0]).max() < len(names) * REST * G / SWAY**2
    assert np.abs(run.velocity).max() < len(names) * REST * G / SWAY


def test_a_tilted_stack_starts_on_its_stretched_shear_springs(make_structure, run_ls_dem):
    """On an incline below the friction limit the shift is the tangential weight over ``k_s A``."""
    # 0.2: the resultant stays well in the middle third, so that no node lifts off or slips even in
    # the relaxation
    angle = np.arctan(0.2)
    gravity = [G * np.sin(angle), 0.0, -G * np.cos(angle)]
    body = {"name": "b", "shape": "cube", "position": [0.0, 0.0, 0.5]}
    structure = make_structure(
        [body], friction=5.0, gravity=gravity, shapes={"slab": {"box": [1.0, 1.0, 0.2]}}
    )
    run = run_ls_dem(structure, 0.2)
    np.testing.assert_allclose(
        run.joint_force[:, 0], np.tile(-structure.mass[1] * np.array(gravity), (41, 1)), atol=1e-4
    )
    np.testing.assert_array_less(np.abs(run.position - run.position[0]), 1e-13)
    lean = 2.0 * run.orientation[0, 1, 2]
    assert lean == pytest.approx(structure.mass[1] * gravity[0] * 0.5 / (K_N / 12.0), rel=1e-4)
    # at the interface the shear alone
    shift = run.position[0, 1, 0] - 0.5 * lean
    assert shift == pytest.approx(structure.mass[1] * gravity[0] / (9.0e9 * 1.0), rel=1e-4)


def test_a_flying_body_is_left_as_given_beside_a_stack_that_settles(make_structure, run_ls_dem):
    """The equilibrium is the start only where it lies within 0.1 mm (docs/guide/contracts.md, start of a run)."""
    q = [np.cos(0.2), 0.0, np.sin(0.2), 0.0]
    structure = make_structure(
        [
            {"name": "stands", "shape": "block", "position": [0.0, 0.0, 0.8]},
            {
                "name": "flies",
                "shape": "block",
                "position": [0.5, 0.0, 4.0],
                "velocity": [1, 2, 3],
                "orientation": q,
            },
        ]
    )
    run = run_ls_dem(structure, 0.1)
    np.testing.assert_array_equal(run.position[0, 2], structure.position[2])
    np.testing.assert_array_equal(run.orientation[0, 2], structure.orientation[2])
    t = run.time[:, None]
    path = structure.position[2] + t * [1.0, 2.0, 3.0] - 0.5 * G * t**2 * [0.0, 0.0, 1.0]
    # velocity Verlet integrates a parabola exactly; records fall on steps
    np.testing.assert_allclose(run.position[:, 2], path, atol=1e-12)
    np.testing.assert_allclose(run.position[:, 1], np.tile(run.position[0, 1], (21, 1)), atol=1e-13)
    assert run.position[0, 1, 2] < 0.8


def test_a_block_tilted_on_its_edge_stays_tilted(make_structure, run_ls_dem):
    """No equilibrium within 0.1 mm: the given pose is the start (docs/guide/contracts.md, start of a run)."""
    angle = 0.05
    position = [
        0.4 - 0.4 * np.cos(angle) + 0.8 * np.sin(angle),
        0.0,
        0.4 * np.sin(angle) + 0.8 * np.cos(angle),
    ]
    orientation = [np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0]
    structure = make_structure(
        [{"name": "b", "shape": "sharp", "position": position, "orientation": orientation}]
    )
    run = run_ls_dem(structure, 0.005)
    np.testing.assert_array_equal(run.position[0, 1], position)
    np.testing.assert_array_equal(run.orientation[0, 1], structure.orientation[1])


def test_a_stack_with_open_joints_starts_closed(make_structure, run_ls_dem):
    """Dry blocks laid with 0.03 mm between them: the equilibrium lies within 0.1 mm, and is the start."""
    gap = 3e-5
    bodies = [
        {"name": f"b{index}", "shape": "cube", "position": [0.0, 0.0, 0.5 + index + (index + 1) * gap]}
        for index in range(2)
    ]
    structure = make_structure(bodies)
    run = run_ls_dem(structure, 0.05)
    weight = structure.mass[1] * G
    closed = np.cumsum(np.array([2.0 * weight, weight]) / K_N)  # over 1 m2
    without_gaps = structure.position[1:, 2] - gap * np.array([1.0, 2.0])
    np.testing.assert_allclose(without_gaps - run.position[0, 1:, 2], closed, rtol=1e-6)
    assert np.abs(run.position - run.position[0]).max() < 1e-12
    assert run.numerics["settling_steps"] < 10


def test_a_tower_of_eight_settles_without_relaxation(make_structure, run_ls_dem):
    """Relaxation takes steps with the square of the height; Newton's method on linear springs takes none."""
    bodies = [
        {"name": f"b{index}", "shape": "cube", "position": [0.0, 0.0, 0.5 + index]} for index in range(8)
    ]
    run = run_ls_dem(make_structure(bodies), 0.05)
    assert run.numerics["settling_steps"] == 0
    assert np.abs(run.position - run.position[0]).max() < 1e-11


def test_a_tower_that_sinks_by_more_than_a_tenth_of_a_millimetre_starts_as_given(make_structure, run_ls_dem):
    """Twelve blocks on soft joints sink by more than 0.1 mm and start as given (docs/guide/contracts.md)."""
    bodies = [
        {"name": f"b{index}", "shape": "cube", "position": [0.0, 0.0, 0.5 + index]} for index in range(12)
    ]
    structure = make_structure(bodies)
    run = run_ls_dem(structure, 0.01, normal_stiffness=5e9)
    np.testing.assert_array_equal(run.position[0], structure.position)
    assert run.numerics["settling_steps"] == 0
    assert run.position[-1, 12, 2] < structure.position[12, 2]


def test_a_gap_that_no_weight_closes_stays_open(make_structure, run_ls_dem):
    """Two cubes at rest, 0.05 mm apart, without gravity: that is their equilibrium."""
    bodies = [
        {"name": "a", "shape": "cube", "position": [0.0, 0.0, 5.0]},
        {"name": "b", "shape": "cube", "position": [1.00005, 0.0, 5.0]},
    ]
    structure = make_structure(bodies, slab=False, gravity=[0.0, 0.0, 0.0])
    run = run_ls_dem(structure, 0.01)
    np.testing.assert_array_equal(run.position[0], structure.position)
    np.testing.assert_array_equal(run.position[-1], structure.position)


def test_a_falling_neighbour_does_not_spoil_the_start(make_structure, run_ls_dem):
    """Groups are of bodies in touch, whatever the skin lists: the standing cube starts in its equilibrium."""
    bodies = [
        {"name": "stands", "shape": "cube", "position": [0.0, 0.0, 0.5]},
        {"name": "falls", "shape": "cube", "position": [1.005, 0.0, 1.5]},
    ]
    starts = [run_ls_dem(make_structure(bodies), 0.002, skin=skin).position[0, 1] for skin in (0.01, 0.002)]
    np.testing.assert_array_equal(starts[0], starts[1])
    assert starts[0][2] < 0.5
