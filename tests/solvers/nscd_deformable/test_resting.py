"""Stacks at rest: shortening and forces of a column under its own weight, and blocks that lie any way up."""

import numpy as np
import pytest

G, RHO, E = 9.81, 2400.0, 3.45e10
FACE = 0.8 * 2.4


def test_a_column_shortens_as_hooke_says(stone, tower, deform):
    """Three blocks, nu 0: the mass centres sink by the integral of the weight above over E, to 0.3 %.

    Bricks of height a whose ends sink right are straight in between: their mean is off by ``a^2 rho g / 12 E``. The
    inside of a reduced block follows its faces and modes: that is the rest.
    """
    structure = stone(tower(3), poisson_ratio=0.0, friction=0.0)
    run = deform(structure, 0.02, mesh_size=0.4, contact_spacing=0.4)
    length, height = 1.6, 4.8
    sunk = run.position[0, 1:, 2] - structure.position[1:, 2]

    def shortened(z):
        """Way down of the section at height z: integral of rho g (H - z) / E."""
        return RHO * G / E * (height * z - z * z / 2.0)

    for block in range(3):
        z = np.linspace(block * length, (block + 1) * length, 2001)
        straight = 0.4**2 * RHO * G / (12.0 * E)
        assert sunk[block] == pytest.approx(straight - shortened(z).mean(), rel=3e-3)
    assert run.position[-1] == pytest.approx(run.position[0], abs=1e-12)


def test_a_cube_sinks_upright(stone, deform):
    """Five bricks an edge and points 0.5 m apart, which no lattice of every other node has in its middle."""
    cube = [{"name": "b", "shape": "cube", "position": [0.0, 0.0, 0.5]}]
    structure = stone(cube, shapes={"cube": {"box": [1.0, 1.0, 1.0]}})
    run = deform(structure, 0.01, mesh_size=0.2, contact_spacing=0.5)
    assert run.position[-1, 1, :2] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert run.orientation[-1, 1, 1:] == pytest.approx(np.zeros(3), abs=1e-12)


def test_joints_carry_the_weight_above(stone, tower, deform):
    structure = stone(tower(3))
    run = deform(structure, 0.02, mesh_size=0.4, contact_spacing=0.8)
    weight = structure.mass[1:].sum() * G
    for joint, (lower, upper) in enumerate(run.joints):
        assert (lower, upper) == (joint, joint + 1)
        above = structure.mass[upper:].sum() * G
        assert run.joint_force[-1, joint] == pytest.approx([0.0, 0.0, above], abs=1e-6 * weight)


@pytest.mark.parametrize(
    ("orientation", "height"),
    [
        ([1.0, 0.0, 0.0, 0.0], 1.6),
        ([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0], 2.4),
        ([np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0], 0.8),
    ],
)
def test_a_block_turned_by_a_right_angle_deforms_as_one_that_was_made_so(orientation, height, stone, deform):
    """Strain follows the material, not the turn: the block on each face holds what a box of that shape holds."""
    sides = {1.6: [0.8, 2.4, 1.6], 2.4: [0.8, 1.6, 2.4], 0.8: [1.6, 2.4, 0.8]}[height]
    place = [0.0, 0.0, height / 2.0]
    turned = stone([{"name": "b", "shape": "sharp", "position": place, "orientation": orientation}])
    made = stone([{"name": "b", "shape": "made", "position": place}], shapes={"made": {"box": sides}})
    held = [deform(one, 0.01, mesh_size=0.4, contact_spacing=0.8).energy[-1, 2] for one in (turned, made)]
    assert held[0] == pytest.approx(held[1], rel=1e-6)
    assert held[0] > 0.0


def test_poissons_ratio_softens_corners_alone(stone, tower, deform):
    """Uniform load: all points of the joints on a smooth floor leave the shortening of nu 0 within 5 % for nu 0.2."""
    sunk = []
    for nu in (0.0, 0.2):
        structure = stone(tower(1), poisson_ratio=nu, friction=0.0)
        run = deform(structure, 0.005, mesh_size=0.4, contact_spacing=0.4)
        sunk.append(run.position[0, 1, 2] - structure.position[1, 2])
    assert sunk[1] == pytest.approx(sunk[0], rel=0.05)
