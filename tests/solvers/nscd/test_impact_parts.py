"""Steps cut into parts where bodies meet: what it buys, and what it leaves as it was."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure

G = 9.81


@pytest.fixture(scope="module")
def shaking():
    time = np.linspace(0.0, 4.0, 801)
    columns = {"x": 2.5 * np.sin(2.0 * np.pi * 1.5 * time), "z": 3.0 * np.sin(2.0 * np.pi * 4.0 * time)}
    return ground_motion("two", time, columns, "acceleration")


def test_a_drop_is_placed_to_a_part(scene, simulate):
    """A plastic landing is over at the end of its part instead of its step."""
    drop = 0.2
    shapes = {"cube": {"box": [0.2, 0.2, 0.2]}}
    structure = scene(shapes, [{"name": "b", "shape": "cube", "position": [0, 0, 0.1 + drop]}])
    landing = np.sqrt(2.0 * drop / G)
    late = {}
    for parts in (1, 10):
        run = simulate(structure, 0.25, time_step=4e-3, output_step=1e-4, impact_parts=parts)
        rest = run.time[np.abs(run.velocity[:, 1, 2]) > 1e-6].max() - landing
        late[parts] = rest
        # the step of the landing, and the one before, which looks half a step ahead
        assert run.numerics["parted_steps"] in ((0,) if parts == 1 else (1, 2))
    # at rest from the end of the part on in which it lands, or the next; in whole steps 2.1 ms late here
    assert 0.0 <= late[10] < 2.0 * 4e-4
    assert late[1] == pytest.approx(51 * 4e-3 - landing, abs=1.5e-4)


def test_a_rocking_block_keeps_what_impacts_in_a_whole_step_take(scene, simulate):
    """Housner (1963): peaks after three impacts at dt 1e-3. In the step of an impact the old edge carries nothing."""
    half, h = 0.4, 0.8
    alpha, r = np.arctan(half / h), 1.0 - 1.5 * np.sin(np.arctan(half / h)) ** 2
    lean = 0.6 * alpha
    c, s = np.cos(lean), np.sin(lean)
    body = {
        "name": "b", "shape": "block", "orientation": [np.cos(lean / 2), 0.0, np.sin(lean / 2), 0.0],
        "position": [half - half * c + h * s, 0.0, half * s + h * c],
    }  # fmt: skip
    structure = scene({"block": {"box": [0.8, 2.4, 1.6]}}, [body], friction=2.0)
    error = {}
    for parts in (1, 20):
        run = simulate(structure, 2.0, output_step=1e-3, impact_parts=parts)
        angle = 2.0 * np.arctan2(run.orientation[:, 1, 2], run.orientation[:, 1, 0])
        impacts = np.flatnonzero(angle[:-1] * angle[1:] < 0.0)
        expected = lean
        for _ in range(3):
            expected = alpha - np.arccos(np.cos(alpha) + r**2 * (np.cos(alpha - expected) - np.cos(alpha)))
        error[parts] = np.abs(angle[impacts[2] : impacts[3]]).max() / expected - 1.0
        assert run.numerics["energy_residual"] < 1e-5
    # the moment of gravity for half a step too long, p^2 sin(alpha) dt / 2 of 0.4 rad/s at the third impact and
    # twice that in the peak: 1.8 % and what the first two impacts add; a twentieth of it in parts
    assert error[1] < -0.02
    assert abs(error[20]) < 0.005


def test_vertical_shaking_and_parts_open_or_close_nothing(simulate, shaking):
    """A change of step shifts a driven body by a h^2 / 8 against what stands on it, 0.4 um, and not for ever more."""
    run = simulate(load_structure("configuration-1"), 3.0, motion=shaking, impact_parts=10)
    assert run.status == "completed"
    assert run.numerics["parted_steps"] > 20
    assert run.numerics["max_penetration"] < 5e-6
    assert run.numerics["energy_residual"] < 1e-4
    wanted = shaking.evaluate(run.time)
    np.testing.assert_allclose(run.position[:, 0] - run.position[0, 0], wanted[:, :3], atol=1e-14)


def test_without_impacts_parts_change_no_bit(simulate):
    time = np.linspace(0.0, 1.0, 101)
    motion = ground_motion("soft", time, {"x": 0.5 * np.sin(9.0 * time)}, "acceleration")
    one, many = (
        simulate(load_structure("configuration-3"), 1.0, motion=motion, impact_parts=parts)
        for parts in (1, 7)
    )
    for name in ("position", "orientation", "velocity", "energy", "joint_force"):
        assert getattr(one, name).tobytes() == getattr(many, name).tobytes()
