import numpy as np
import pytest

from blockshake.geometry.structure import load_structure

BLOCK = {"block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02}, "flat": {"box": [1.0, 1.0, 0.1]}}
# the position of a resting block changes only while the solver settles, by the tolerance times g dt^2
REST = 1e-8


@pytest.mark.parametrize("parameters", [{"theta": 1.0}, {"shrink": 0.05}])
def test_stack_rests_with_other_parameters(simulate, parameters):
    run = simulate(load_structure("configuration-3"), 0.2, **parameters)
    assert np.abs(run.position - run.position[0]).max() < REST


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
