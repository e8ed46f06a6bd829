"""Forces of the joints of deformable blocks that slide and rock: Newton, and the cone of friction."""

import numpy as np
import pytest
from cycle_of_sine import cycle

STEP = 1e-3
FRICTION = 0.3
G = 9.81


@pytest.fixture(scope="module", params=[False, True], ids=["elastic", "viscoelastic"])
def shaken(request, stone, tower, deform):
    """Two blocks that rock and slip on the slab, recorded at every step."""
    structure = stone(tower(2), friction=FRICTION)
    run = deform(
        structure, 1.2, motion=cycle(6.0, 2.0, 2.0), viscous=request.param, rate=1000,
        mesh_size=0.4, contact_spacing=0.8,
    )  # fmt: skip
    assert run.status == "completed"
    return structure, run


def test_the_joints_give_every_block_its_momentum(shaken):
    """Forces of the joints below and above, and the weight, over a step are the change of the momentum."""
    structure, run = shaken
    gravity = np.array([0.0, 0.0, -G])
    lower, upper = (run.joint_force[1:, joint] for joint in (0, 1))
    for body, force in ((1, lower - upper), (2, upper)):
        rate = np.diff(run.velocity[:, body], axis=0) / STEP
        required = structure.mass[body] * (rate - gravity)
        assert np.abs(required).max() > 0.5 * structure.mass[body] * G
        np.testing.assert_allclose(force, required, atol=1e-6 * structure.mass[body] * G)


def test_no_joint_pulls_nor_holds_more_than_its_friction(shaken):
    structure, run = shaken
    weight = structure.mass[1:].sum() * G
    shear = np.hypot(run.joint_force[..., 0], run.joint_force[..., 1])
    normal = run.joint_force[..., 2]
    turned = np.abs(run.position[:, 2, 0] - run.position[:, 0, 0]).max()
    assert turned > 0.01
    assert normal.min() >= 0.0
    # the normal of a face turns with its block, by some hundredths of a radian
    assert (shear - FRICTION * normal).max() < 0.005 * weight
    # the joint on the slab slips
    pressed = normal[:, 0] > 0.1 * weight
    assert (shear[pressed, 0] / normal[pressed, 0]).max() == pytest.approx(FRICTION, rel=1e-6)
