"""Blows of blocks that stand apart, of motions that are known and by both rigid models."""

import numpy as np
import pytest
import xarray as xr

from blockshake.geometry.structure import load_structure
from blockshake.simulation.pounding import pounding
from blockshake.simulation.simulate import simulate

GAP, HEIGHT = 0.02, 2.0  # m
TIME = np.arange(0.0, 1.0, 0.005)


def two_leaves(velocity=0.0, friction=0.7):
    """Two blocks 20 mm apart along x, the left one with a velocity towards the right one [m/s]."""
    stone = {"density": 2000.0, "youngs_modulus": 2.0e10, "poisson_ratio": 0.2}
    block = {"shape": "block", "material": "stone"}
    return load_structure(
        {
            "name": "leaves",
            "materials": {"stone": stone},
            "shapes": {"slab": {"box": [4.0, 4.0, 0.2]}, "block": {"box": [0.5, 1.0, HEIGHT]}},
            "bodies": [
                {
                    "name": "slab",
                    "shape": "slab",
                    "material": "stone",
                    "position": [0, 0, -0.1],
                    "driven": True,
                },
                {"name": "left", "position": [-0.26, 0, 1.0], "velocity": [velocity, 0, 0]} | block,
                {"name": "right", "position": [0.26, 0, 1.0]} | block,
            ],
            "friction": [{"pair": ["stone", "stone"], "coefficient": friction}],
            "markers": [{"name": "slab", "body": "slab", "position": [0, 0, 0]}],
        }
    )


def run_of(structure, shift, angle=0.0, pair=("left", "right")):
    """A run whose left block is shifted along x [m] and leans towards +x about its lower right edge [rad]."""
    angle = np.broadcast_to(angle, TIME.shape)
    position = np.tile(structure.position, (len(TIME), 1, 1))
    position[:, 1, 0] = -0.01 + shift - 0.25 * np.cos(angle) + 0.5 * HEIGHT * np.sin(angle)
    position[:, 1, 2] = 0.25 * np.sin(angle) + 0.5 * HEIGHT * np.cos(angle)
    orientation = np.zeros((len(TIME), 3, 4))
    orientation[..., 0] = 1.0
    orientation[:, 1, 0], orientation[:, 1, 2] = np.cos(0.5 * angle), np.sin(0.5 * angle)
    return xr.Dataset(
        {
            "position": (("time", "body", "axis"), position),
            "orientation": (("time", "body", "quaternion"), orientation),
        },
        coords={"time": TIME, "lower": ("joint", [pair[0]]), "upper": ("joint", [pair[1]])},
    )


def test_every_closing_of_a_gap_is_a_blow_with_its_velocity():
    """20 mm in 40 ms, back in 100 ms, and again in 50 ms, at times between those of the run."""
    shift = np.interp(TIME, [0.1013, 0.1413, 0.2413, 0.2913], [0.0, GAP, 0.0, GAP])
    blows, velocity, pair = pounding(run_of(two_leaves(), shift), two_leaves())
    assert (blows, pair) == (2, "left and right")
    assert velocity == pytest.approx(0.5, rel=1e-9)


def test_the_top_of_a_block_that_leans_strikes_at_its_height_times_the_rate():
    rate = 0.2  # rad/s
    angle = np.minimum(rate * np.maximum(TIME - 0.1, 0.0), np.arcsin(GAP / HEIGHT))
    blows, velocity, _ = pounding(run_of(two_leaves(), 0.0, angle), two_leaves())
    assert blows == 1
    assert velocity == pytest.approx(rate * HEIGHT, rel=1e-3)


@pytest.mark.parametrize(
    ("shift", "pair"),
    [
        (np.interp(TIME, [0.1, 0.2, 0.3], [0.0, GAP - 2e-3, 0.0]), ("left", "right")),  # a near miss
        (np.interp(TIME, [0.1, 0.9], [0.0, GAP]), ("left", "right")),  # leans, at 25 mm/s
        (np.interp(TIME, [0.1, 0.2], [0.0, GAP]), ("slab", "left")),
    ],
)
def test_what_does_not_strike_is_no_blow(shift, pair):
    assert pounding(run_of(two_leaves(), shift, pair=pair), two_leaves()) == (0, 0.0, "")


@pytest.mark.parametrize(("model", "step"), [("nscd-rigid", 1e-3), ("ls-dem", 5e-5)])
def test_both_models_show_the_blow_of_a_block_that_slides(model, step):
    """On a slab that hardly holds it, friction takes 0.005 m/s off 0.4 m/s in the 50 ms to the other block."""
    structure = two_leaves(0.4, 0.01)
    run = simulate(
        structure, {"time_s": [0.0, 1.0], "acceleration_x": [0.0, 0.0]}, model, time_step=step, duration=0.08
    )
    blows, velocity, pair = pounding(run, structure)
    assert (blows, pair) == (1, "left and right")
    assert velocity == pytest.approx(0.4 - 0.01 * 9.81 * GAP / 0.4, abs=2e-3)
