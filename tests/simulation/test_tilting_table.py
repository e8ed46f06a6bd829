"""Quasi-static tilting tests: a block on a table that turns slips or tips at its angle, wherever it stands."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.simulation.simulate import simulate

END, DURATION = 0.8, 8.0  # rad, s: the table turns as the square of the time
HALF, HEIGHT = 0.2, 0.4  # m, half width and half height


def tilt(time):
    """Tilt of the table without its sign [rad]."""
    return END * (time / DURATION) ** 2


def tilt_of_run(make_structure, model, place, friction, side):
    """A run, and the table's tilt at its end [rad]."""
    time = np.linspace(0.0, DURATION, 401)
    columns = {"x": np.zeros_like(time), "pitch_y": side * tilt(time)}
    motion = ground_motion("tilt", time, columns, "displacement")
    shapes = {"table": {"box": [3.0, 1.0, 0.1]}, "stele": {"box": [2 * HALF, 2 * HALF, 2 * HEIGHT]}}
    bodies = [
        {"name": "table", "shape": "table", "position": [0.0, 0.0, -0.05], "driven": True},
        {"name": "stele", "shape": "stele", "position": [place, 0.0, HEIGHT]},
    ]
    structure = make_structure(bodies, slab=False, shapes=shapes, friction=friction)
    step = 5e-5 if model == "ls-dem" else 1e-3
    run = simulate(structure=structure, motion=motion, model=model, time_step=step)
    ended = float(run["time"][np.isfinite(run["position"][:, 1, 0]).values][-1])
    return run, tilt(ended)


@pytest.mark.parametrize("model", ["nscd-rigid", "ls-dem"])
@pytest.mark.parametrize(("place", "side"), [(0.9, 1.0), (-0.9, 1.0), (0.9, -1.0), (0.0, 1.0)])
def test_a_block_tips_at_its_slenderness_wherever_it_stands(make_structure, model, place, side):
    """Balance of the moments about the lower edge; the fall to 45 degrees then takes about a second."""
    run, tilted = tilt_of_run(make_structure, model, place, 0.9, side)
    slender = np.arctan(HALF / HEIGHT)
    assert run.attrs["status"] == "collapsed"
    assert slender < tilted < tilt(DURATION * np.sqrt(slender / END) + 1.6)


@pytest.mark.parametrize("place", [0.9, -0.9])
@pytest.mark.parametrize("friction", [0.2, 0.4])
def test_a_block_slides_at_the_angle_of_friction(make_structure, place, friction):
    run, _ = tilt_of_run(make_structure, "nscd-rigid", place, friction, 1.0)
    from_table = (run["position"][:, 1] - run["position"][:, 0]).values
    moved = np.abs(np.hypot(from_table[:, 0], from_table[:, 2]) - np.hypot(place, HEIGHT + 0.05))
    slides = float(run["time"][int(np.argmax(moved > 1e-3))])
    expected = DURATION * np.sqrt(np.arctan(friction) / END)
    assert expected < slides < expected + 0.3
