import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion

G = 9.81
SHAPES = {"cube": {"box": [0.5, 0.5, 0.5]}}


def test_stopper_deflects_by_force_over_stiffness(scene, simulate):
    # frictionless block pushed by a tilted gravity against a stop; settled by the implicit scheme's damping
    stop = {"body": "b", "position": [0.25, 0, 0], "axis": "+x", "gap": 0.002, "stiffness": 1.0e7}
    structure = scene(
        SHAPES, [{"name": "b", "shape": "cube", "position": [0, 0, 0.25]}], friction=0.0, stoppers=[stop],
        gravity=[1.0, 0.0, -G],
    )  # fmt: skip
    run = simulate(structure, 3.0)
    expected = 0.002 + structure.mass[1] * 1.0 / 1.0e7
    assert run.position[-1, 1, 0] == pytest.approx(expected, rel=1e-6)
    assert run.energy[-1, 2] == pytest.approx(0.5 * (structure.mass[1] * 1.0) ** 2 / 1.0e7, rel=1e-4)
    assert np.diff(run.energy[:, 4]).min() >= 0.0
    assert run.numerics["energy_residual"] < 1e-6


def test_stopper_holds_the_body_it_names(scene, simulate):
    # the solver handles bodies by height and place: here in another order than the file's
    stop = {"body": "b", "position": [0.25, 0, 0], "axis": "+x", "gap": 0.0, "stiffness": 1.0e7}
    bodies = [
        {"name": "far", "shape": "cube", "position": [3, 0, 0.25]},
        {"name": "b", "shape": "cube", "position": [0, 0, 0.25]},
    ]
    structure = scene(SHAPES, bodies, friction=0.0, stoppers=[stop], gravity=[0.5, 0.0, -G])
    run = simulate(structure, 1.0)
    assert run.position[-1, 1, 0] == pytest.approx(3.25, rel=1e-3)
    # the stop rings about its static closure for a while
    assert 0.0 < run.position[-1, 2, 0] < 2.0 * structure.mass[2] * 0.5 / 1.0e7


@pytest.mark.parametrize(("axis", "sign"), [("+x", 1.0), ("-x", -1.0), ("-y", -1.0)])
def test_stopper_turns_a_block_round(scene, simulate, axis, sign):
    along = "xyz".index(axis[1])
    velocity = [0.0, 0.0, 0.0]
    velocity[along] = sign * 0.5
    stop = {"body": "b", "position": [0, 0, 0], "axis": axis, "gap": 0.01, "stiffness": 1.0e5}
    structure = scene(
        SHAPES,
        [{"name": "b", "shape": "cube", "position": [0, 0, 0.25], "velocity": velocity}],
        friction=0.0,
        stoppers=[stop],
    )
    run = simulate(structure, 0.2, output_step=1e-3)
    moved = sign * (run.position[:, 1, along] - run.position[0, 1, along])
    # the spring takes all of the kinetic energy: v sqrt(m / k) beyond the gap, less the scheme's damping, w dt / 4
    assert moved.max() == pytest.approx(0.01 + 0.5 * np.sqrt(structure.mass[1] / 1.0e5), rel=0.02)
    assert -0.5 < sign * run.velocity[-1, 1, along] < -0.4


def test_stopper_moves_with_the_driven_body(scene, simulate, push):
    stop = {"body": "b", "position": [-0.25, 0, 0], "axis": "-x", "gap": 0.01, "stiffness": 1.0e6}
    structure = scene(
        SHAPES, [{"name": "b", "shape": "cube", "position": [0, 0, 0.25]}], friction=0.0, stoppers=[stop]
    )
    run = simulate(structure, 1.0, output_step=1e-3, motion=push(1.0, 1.5, 2.0))
    behind = run.position[:, 0, 0] - run.position[:, 1, 0]
    # seen from the floor the block falls onto the spring: k c^2 / 2 = m a (gap + c) at the deepest
    load = structure.mass[1] * 1.0
    closure = (load + np.sqrt(load**2 + 2.0 * 1.0e6 * load * 0.01)) / 1.0e6
    # 1 %: the damping of the implicit spring, omega dt / 4 = 0.015 of critical
    assert behind.max() == pytest.approx(0.01 + closure, rel=0.01)
    assert run.position[-1, 1, 0] > 0.45


def pitching(angle):
    """Ground motion that pitches to ``angle`` within a second and stays there."""
    time = np.linspace(0.0, 10.0, 2001)
    share = np.clip(time, 0.0, 1.0)
    pitch = angle * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return ground_motion("p", time, {"pitch_y": pitch}, "displacement")


def test_stopper_turns_with_the_driven_body(scene, simulate):
    # a stop is fixed to the driven body: pitching the whole closes no stopper high up (docs/guide/contracts.md)
    stops = [
        {"body": "b", "position": [x, 0, 0.25], "axis": axis, "gap": 1e-3, "stiffness": 1.0e6}
        for axis, x in (("+x", 0.25), ("-x", -0.25))
    ]
    bodies = [{"name": "b", "shape": "cube", "position": [0, 0, 0.25]}]
    keys = {"motion": pitching(0.02)}
    held = simulate(scene(SHAPES, bodies, friction=0.9, stoppers=stops), 2.0, **keys)
    free = simulate(scene(SHAPES, bodies, friction=0.9), 2.0, **keys)
    # the block's top moves by 0.6 m * 0.02 = 12 mm, twelve gaps
    assert np.ptp(held.position[:, 1, 0]) > 5e-3
    np.testing.assert_array_equal(held.position, free.position)


def test_stopper_pushes_along_its_turned_axis(scene, simulate):
    # a smooth block slides down the pitched floor against the stop: k c = m g sin(angle) along the floor
    angle, gap, stiffness = 0.02, 0.002, 1.0e7
    stop = {"body": "b", "position": [0, 0, 0], "axis": "+x", "gap": gap, "stiffness": stiffness}
    structure = scene(
        SHAPES, [{"name": "b", "shape": "cube", "position": [0, 0, 0.25]}], friction=0.0, stoppers=[stop]
    )
    run = simulate(structure, 20.0, motion=pitching(angle))
    along = np.array([np.cos(angle), 0.0, -np.sin(angle)])
    moved = (run.position[-1, 1] - run.position[-1, 0]) @ along
    closure = structure.mass[1] * G * np.sin(angle) / stiffness
    # it bounces first; then the implicit spring's damping, omega dt / 4 = 0.04 of critical, ends it in a second
    assert moved == pytest.approx(gap + closure, abs=1e-3 * closure)
    # seen from the block, 0.35 m above the slab's centre, a stop that does not turn is 7 mm away
    assert abs(run.position[-1, 1, 0] - gap - closure) > 5e-3
    assert run.numerics["energy_residual"] < 1e-4
