"""Margins against overturning and spin kept at impacts, of motions that are known."""

import numpy as np
import pytest

from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import load_structure
from blockshake.simulation.rocking import (
    angular_momentum_ratio,
    carried_by,
    overturning_margins,
    plastic_shares,
)

WIDTH, HEIGHT = 0.5, 2.0  # m
HEAD = """
name: stack
description: blocks on a slab
materials: {stone: {density: 2000.0, youngs_modulus: 2.0e10, poisson_ratio: 0.2}}
friction: [{pair: [stone, stone], coefficient: 0.7}]
"""


def structure_of(folder, shapes, bodies):
    slab = "  - {name: slab, shape: slab, material: stone, position: [0, 0, -0.1], driven: true}\n"
    listed = "".join(
        f"  - {{name: {name}, shape: {shape}, material: stone, position: {place}}}\n"
        for name, shape, place in bodies
    )
    boxes = "".join(f"  {name}: {{box: {size}}}\n" for name, size in {"slab": [4, 4, 0.2], **shapes}.items())
    path = folder / "stack.yaml"
    path.write_text(f"{HEAD}shapes:\n{boxes}bodies:\n{slab}{listed}")
    return load_structure(path)


@pytest.fixture
def block(tmp_path):
    return structure_of(tmp_path, {"b": [WIDTH, 1.0, HEIGHT]}, [("block", "b", [0, 0, 0.5 * HEIGHT])])


def rocked(structure, angle):
    """Poses of a slab and a block that turns about its edges by these angles, positive towards +x."""
    edge = 0.5 * WIDTH * np.sign(angle)
    arm = np.stack([-edge, np.full_like(angle, 0.5 * HEIGHT)])
    position = np.tile(structure.position, (len(angle), 1, 1))
    position[:, 1, 0] = edge + np.cos(angle) * arm[0] + np.sin(angle) * arm[1]
    position[:, 1, 2] = -np.sin(angle) * arm[0] + np.cos(angle) * arm[1]
    quaternion = np.zeros((len(angle), 2, 4))
    quaternion[..., 0] = 1.0
    quaternion[:, 1] = np.stack(
        [np.cos(0.5 * angle), np.zeros_like(angle), np.sin(0.5 * angle), np.zeros_like(angle)], axis=1
    )
    return position, rotation_matrices(quaternion)


@pytest.mark.parametrize("largest", [0.05, 0.2, 0.3])
def test_margin_of_a_block_is_that_of_housner(block, largest):
    """sin(a - t) / sin(a), of a block slender by a that leans by t (Housner 1963); below 0 it does not come back."""
    slender = np.arctan(WIDTH / HEIGHT)
    angle = np.append(np.linspace(0.0, largest, 50), -0.5 * largest)
    margin = overturning_margins(block, *rocked(block, angle))
    assert margin == pytest.approx([np.sin(slender - largest) / np.sin(slender)], abs=1e-12)


def test_slip_on_a_wide_slab_takes_no_margin(block):
    position, turns = rocked(block, np.zeros(3))
    position[:, 1, 0] += [0.0, 0.2, 0.5]
    assert overturning_margins(block, position, turns) == pytest.approx([1.0])


@pytest.mark.parametrize("kept", [0.6, 0.9])
def test_spin_kept_is_that_of_the_motion(block, kept):
    """A block that leaves its flat start to one side and swings through, its spin bent by the weight on the way."""
    time = np.arange(0.0, 1.0, 0.005)
    after = np.clip(time - 0.4012, 0.0, None)
    before = np.clip(0.4012 - time, 0.0, None)
    angle = -0.4 * before + 0.3 * before**2 + kept * 0.4 * after - 0.3 * after**2
    angle *= np.clip(time / 0.1, 0.0, 1.0)
    rate = np.where(before > 0.0, 0.4 - 0.6 * before, kept * 0.4 - 0.6 * after)
    spin = np.zeros((len(time), 2, 3))
    spin[:, 1, 1] = rate
    found = angular_momentum_ratio(block, time, *rocked(block, angle), spin)
    # the instant of the impact is known within a row, in which the weight bends the spin by this share of it
    assert found == pytest.approx([kept], abs=0.6 * 0.005 / 0.4)


def test_a_block_that_never_rocks_has_no_impact(block):
    time = np.arange(0.0, 1.0, 0.005)
    assert np.isnan(
        angular_momentum_ratio(block, time, *rocked(block, 0.01 * time), np.zeros((len(time), 2, 3)))
    ).all()


def test_plastic_share_is_that_of_housner(block, tmp_path):
    """1 - 1.5 sin(a)^2 for a block (Housner 1963), and the same for a stack of the same outline."""
    housner = 1.0 - 1.5 * WIDTH**2 / (WIDTH**2 + HEIGHT**2)
    assert plastic_shares(block) == pytest.approx([housner])
    half = [("lower", "b", [0, 0, 0.25 * HEIGHT]), ("upper", "b", [0, 0, 0.75 * HEIGHT])]
    stack = structure_of(tmp_path, {"b": [WIDTH, 1.0, 0.5 * HEIGHT]}, half)
    assert plastic_shares(stack)[0] == pytest.approx(housner)


def test_what_stands_on_two_piers_stands_on_both(tmp_path):
    shapes = {"pier": [0.5, 0.5, 1.0], "lintel": [0.5, 2.0, 0.5]}
    bodies = [
        ("left", "pier", [0, -0.75, 0.5]),
        ("right", "pier", [0, 0.75, 0.5]),
        ("lintel", "lintel", [0, 0, 1.25]),
    ]
    door = structure_of(tmp_path, shapes, bodies)
    carried = carried_by(door)
    assert [sorted(one.bodies) for one in carried] == [[1, 2, 3], [1, 2, 3], [3], [3]]
    assert [sorted(one.feet) for one in carried] == [[0, 1], [0, 1], [2, 3], [2, 3]]
