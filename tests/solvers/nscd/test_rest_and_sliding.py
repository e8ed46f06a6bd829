import numpy as np
import pytest

from blockshake.geometry.structure import load_structure

G = 9.81
BLOCK = {"block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02}, "flat": {"box": [1.0, 1.0, 0.1]}}
# the position of a resting block changes only while the solver settles, by the tolerance times g dt^2
REST = 1e-8
# the scheme places the stop of a sliding block to within a step
STEP_AT_STOP = 2e-3


def test_stack_at_rest_does_not_move_and_carries_its_weight(simulate):
    structure = load_structure("configuration-1")
    run = simulate(structure, 5.0)
    assert run.status == "completed"
    assert np.abs(run.position - run.position[0]).max() < REST
    assert run.joints.tolist() == [[0, 1], [1, 2], [2, 3]]
    weight = structure.mass[1] * G * np.array([3.0, 2.0, 1.0])
    # impulses are exact to the relative tolerance of 1e-6 at every time
    np.testing.assert_allclose(run.joint_force[:, :, 2], np.tile(weight, (len(run.time), 1)), rtol=1e-5)
    np.testing.assert_allclose(run.joint_force[:, :, :2], 0.0, atol=1e-5 * weight[0])


@pytest.mark.parametrize("parameters", [{"theta": 1.0}, {"shrink": 0.05}])
def test_stack_rests_with_other_parameters(simulate, parameters):
    run = simulate(load_structure("configuration-3"), 0.2, **parameters)
    assert np.abs(run.position - run.position[0]).max() < REST


@pytest.mark.parametrize(("friction", "slides"), [(0.29, True), (0.31, False)])
def test_incline_slides_only_beyond_the_friction_angle(scene, simulate, friction, slides):
    tilt = np.arctan(0.3)
    gravity = [G * np.sin(tilt), 0.0, -G * np.cos(tilt)]
    structure = scene(
        BLOCK, [{"name": "b", "shape": "flat", "position": [0, 0, 0.05]}], friction=friction, gravity=gravity
    )
    run = simulate(structure, 1.0)
    moved = run.position[-1, 1, 0] - run.position[0, 1, 0]
    expected = 0.5 * G * (np.sin(tilt) - friction * np.cos(tilt)) if slides else 0.0
    # Coulomb: uniform acceleration beyond the friction angle, rest below it
    assert moved == pytest.approx(expected, rel=2e-3, abs=1e-7)


def test_sliding_distance_is_that_of_coulomb(scene, simulate):
    structure = scene(
        BLOCK,
        [{"name": "b", "shape": "flat", "position": [-1, 0.3, 0.05], "velocity": [1.2, -0.9, 0.0]}],
        friction=0.4,
    )
    run = simulate(structure, 0.6)
    moved = run.position[-1, 1] - run.position[0, 1]
    distance = 1.5**2 / (2.0 * 0.4 * G)
    assert np.hypot(*moved[:2]) == pytest.approx(distance, rel=STEP_AT_STOP)
    assert moved[1] / moved[0] == pytest.approx(-0.75, rel=1e-3)
    # friction turns all of the kinetic energy into heat
    kinetic = 0.5 * structure.mass[1] * 1.5**2
    assert run.energy[-1, 3] == pytest.approx(kinetic, rel=1e-5)


def test_newmark_sliding_block(scene, simulate, push):
    # Newmark (1965): a pulse a over T leaves a slip of (a T)^2 / 2 (1 / (mu g) - 1 / a)
    a, duration, mu = 4.0, 0.2, 0.2
    structure = scene(BLOCK, [{"name": "b", "shape": "flat", "position": [0, 0, 0.05]}], friction=mu)
    run = simulate(structure, 0.8, motion=push(a, duration, 2.0))
    slip = run.position[-1, 0, 0] - run.position[-1, 1, 0]
    assert slip == pytest.approx(0.5 * (a * duration) ** 2 * (1.0 / (mu * G) - 1.0 / a), rel=STEP_AT_STOP)


def test_driven_body_is_exactly_where_the_motion_has_it(scene, simulate, push):
    motion = push(1.0, 0.2, 0.5)
    structure = scene(BLOCK, [{"name": "b", "shape": "block", "position": [0, 0, 0.8]}])
    run = simulate(structure, 0.7, motion=motion, output_step=0.0037)
    wanted = motion.evaluate(run.time)
    np.testing.assert_allclose(run.position[:, 0], structure.position[0] + wanted[:, :3], atol=1e-15)
    # a block that sticks follows to the curvature of the motion within a step
    rigid = run.position[:, 1, 0] - run.position[:, 0, 0]
    assert np.abs(rigid[run.time < 0.49]).max() < 1.0 * 1e-3**2


def test_block_carried_by_the_floor_takes_its_energy_from_it(scene, simulate, push):
    structure = scene(BLOCK, [{"name": "b", "shape": "block", "position": [0, 0, 0.8]}])
    run = simulate(structure, 0.5, motion=push(1.0, 0.2, 0.4))
    inside = run.time == 0.3
    # the floor gives the block 0.2 m/s
    kinetic = 0.5 * structure.mass[1] * 0.2**2
    assert run.energy[inside, 0].item() == pytest.approx(kinetic, rel=1e-6)
    assert run.energy[inside, 6].item() == pytest.approx(kinetic, rel=1e-6)
