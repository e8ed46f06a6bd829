"""States smoothed from noisy readings of known motions, and blocks set down on what carries them."""

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

from blockshake.diagnosis.smoothed_state import set_down, smoothed_states
from blockshake.geometry.overlap import penetration_depth

TIME = np.arange(1201) / 200.0
NOISE = 1e-4


@pytest.fixture(scope="module")
def stack(make_structure):
    return make_structure(
        [
            {"name": "low", "shape": "cube", "position": [0.0, 0.0, 0.5]},
            {"name": "high", "shape": "cube", "position": [0.0, 0.0, 1.5]},
        ]
    )


def _histories(displacement, rotation, base_noise, seed, known="pose"):
    """Readings of three bodies of which the highest moves along x and turns about y; base noise carries all."""
    generator = np.random.default_rng(seed)
    shape = (len(TIME), 3, 3)
    moved, turned = np.zeros(shape), np.zeros(shape)
    moved[:, 2, 0], turned[:, 2, 1] = displacement, rotation
    moved[:, 1:] += generator.normal(0.0, NOISE, (len(TIME), 2, 3))
    turned[:, 1:] += generator.normal(0.0, NOISE, (len(TIME), 2, 3))
    turn = generator.normal(0.0, base_noise, (len(TIME), 3))
    # the slab's mass centre is 0.6 m and 1.6 m below: seen from a slab that seems turned, the blocks seem shifted
    for body, height in ((1, 0.6), (2, 1.6)):
        moved[:, body] -= np.cross(turn, [0.0, 0.0, height])
        turned[:, body] -= turn
    axes = ("time", "body", "axis")
    return xr.Dataset(
        {
            "body_displacement": (axes, moved),
            "body_rotation": (axes, turned),
            "base_displacement": (("time", "axis"), generator.normal(0.0, 1e-9, (len(TIME), 3))),
            "base_rotation": (("time", "axis"), turn),
        },
        {"time": TIME, "axis": ["x", "y", "z"], "known": ("body", ["pose", "pose", known])},
    )


def test_errors_are_as_large_as_they_say_and_velocity_is_known(stack):
    ratios = {"moved": [], "rate": []}
    for seed in range(6):
        slow = 2.0 * np.pi * (0.8 + 0.2 * seed)
        moved, rate = 0.02 * np.sin(slow * TIME) ** 2, 0.02 * slow * np.sin(2.0 * slow * TIME)
        states = smoothed_states(_histories(moved, 0.5 * moved, 0.0, seed), stack)
        for axis, share in ((0, 1.0), (4, 0.5)):
            error = states.moved[:, 2, axis] - share * moved
            # the mean of the first readings, taken for rest, is in all displacements
            ratios["moved"].append((error - error.mean()) / states.moved_error[:, 2, axis])
            ratios["rate"].append((states.rate[:, 2, axis] - share * rate) / states.rate_error[:, 2, axis])
    for ratio in ratios.values():
        assert 0.7 < np.sqrt(np.mean(np.square(ratio))) < 1.3
    # a block at rest is known far better than one reading
    assert states.moved_error[600, 1, 0] < 0.15 * NOISE


def test_noise_of_the_base_is_not_taken_for_motion_of_the_blocks(stack):
    rest = np.zeros(len(TIME))
    states = smoothed_states(_histories(rest, rest, 3e-4, 7), stack)
    # 0.3 mrad under 1.6 m are 0.5 mm in each reading
    assert states.moved[:, 2, 0].std() < 8e-5


def test_a_body_whose_rotation_nobody_knows_leaves_no_state(stack):
    rest = np.zeros(len(TIME))
    assert smoothed_states(_histories(rest, rest, 0.0, 1, known="translation"), stack) is None


@pytest.mark.parametrize("off", [3e-4, -3e-4])
def test_blocks_in_or_above_what_carries_them_are_set_down(stack, off):
    position, orientation = stack.position.copy(), stack.orientation.copy()
    orientation[1:] = Rotation.from_rotvec([0.0, 0.02, 0.0]).as_quat(scalar_first=True)
    position[1] += [0.0, 0.0, 0.5 * np.sin(0.02) + 0.5 * np.cos(0.02) - 0.5 + off]
    position[2] += position[1] - stack.position[1] + [np.sin(0.02), 0.0, np.cos(0.02) - 1.0 - off]
    velocity, spin = np.zeros((3, 3)), np.zeros((3, 3))
    spin[1:] = [0.0, 0.1, 0.0]
    shift = set_down(stack, position, orientation, velocity, spin)
    assert shift[1] == pytest.approx(-off, abs=2e-7)
    assert shift[2] == pytest.approx(0.0, abs=2e-6)
    for lower, upper in ((0, 1), (1, 2)):
        depth = penetration_depth(
            stack.solid(lower), position[lower], orientation[lower],
            stack.solid(upper), position[upper], orientation[upper],
        )  # fmt: skip
        assert depth == pytest.approx(0.0, abs=2e-7)
    # the low cube turns about its edge at +x, half a width from its centre: v_z = -omega times that
    arm = Rotation.from_rotvec([0.0, 0.02, 0.0]).apply([0.5, 0.0, -0.5])
    assert velocity[1, 2] == pytest.approx(0.1 * arm[0], rel=1e-9)
