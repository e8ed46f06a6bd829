"""Stops: elastic, implicit in contact dynamics, fixed to the driven body, and not there where they are not reached."""

import numpy as np
import pytest
from both_solvers import both, solve

from blockshake.dynamics.motion import ground_motion

G = 9.81
CUBE = {"name": "b", "shape": "small", "position": [0.0, 0.0, 0.25]}
SQUAT = {"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}
SHAPES = {
    "small": {"box": [0.5, 0.5, 0.5]},
    "squat": {"box": [1.0, 1.0, 0.5]},
    "slab": {"box": [12.0, 8.0, 0.2]},
}
MASS = 0.5 * 2400.0  # kg, of the squat block


def stop(axis, gap, stiffness, place=(0.0, 0.0, 0.0), body="b"):
    return {"body": body, "position": list(place), "axis": axis, "gap": gap, "stiffness": stiffness}


def stops(stiffness, gap, x, height=0.0, body="b"):
    """Stops on both sides of a body."""
    sides = (("+x", 1.0), ("-x", -1.0))
    return [stop(axis, gap, stiffness, (side * x, 0.0, height), body) for axis, side in sides]


@pytest.fixture
def stopped(make_structure):
    """Structure of bodies with stops; without friction."""

    def make(bodies, *stoppers, **keys):
        return make_structure(bodies, shapes=SHAPES, stoppers=list(stoppers), **{"friction": 0.0, **keys})

    return make


def every_ms(duration):
    return np.linspace(0.0, duration, round(1e3 * duration) + 1)


def pitching(angle):
    """Ground motion that pitches to ``angle`` within a second and stays there."""
    time = np.linspace(0.0, 10.0, 2001)
    share = np.clip(time, 0.0, 1.0)
    pitch = angle * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return ground_motion("p", time, {"pitch_y": pitch}, "displacement")


@both
def test_stops_on_both_sides_give_the_period_between_them(solver, stopped):
    """Without weight and friction: ``2 pi sqrt(m / k)`` on the stops and four gaps on the way, at speed v."""
    stiffness, gap, speed = 1e6, 0.01, 0.5
    body = {"name": "b", "shape": "cube", "position": [0.0, 0.0, 0.5], "velocity": [speed, 0.0, 0.0]}
    structure = stopped([body], *stops(stiffness, gap, 0.4), gravity=[0.0, 0.0, 0.0])
    period = 2.0 * np.pi * np.sqrt(structure.mass[1] / stiffness) + 4.0 * gap / speed
    frequency = np.sqrt(stiffness / structure.mass[1])
    for time_step in (4e-4, 2e-4):
        run = solve(solver, structure, np.linspace(0.0, 1.25 * period, 20001), time_step=time_step)
        x, v = run.position[:, 1, 0], run.velocity[:, 1, 0]
        back = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))[-1]
        error = run.time[back] - x[back] / v[back] - period
        if solver == "ls-dem":
            # leapfrog: (omega dt)^2 / 24 of the time on the stops, as much again for steps met on the way in and out
            assert abs(error) < (frequency * time_step) ** 2 * period / 12.0
        else:
            # the implicit stop damps by omega dt / 4 of critical: pi omega dt / 4 of the speed at either stop, so that
            # the four gaps take longer by 0, 1, 1 and 2 times this; 3 % for its square
            assert error == pytest.approx(np.pi * frequency * time_step * gap / speed, rel=0.03)


@both
def test_a_stop_turns_with_the_driven_body(solver, stopped):
    """A stop is fixed to the driven body: pitching the whole closes none high up (docs/guide/contracts.md)."""
    held, free = (
        solve(solver, stopped([CUBE], *listed, friction=0.9), 1.5, pitching(0.02))
        for listed in (stops(1e6, 1e-3, 0.25, 0.25), [])
    )
    # the block's top moves by 0.6 m * 0.02 = 12 mm, twelve gaps
    assert np.ptp(held.position[:, 1, 0]) > 5e-3
    np.testing.assert_array_equal(held.position, free.position)


@pytest.mark.parametrize(("axis", "sign"), [("+x", 1.0), ("-x", -1.0)])
def test_a_block_pushed_against_a_penalty_swings_about_the_static_deflection(axis, sign, stopped):
    """A constant pull of g/10 on a frictionless block: gap + f/k is the middle of a harmonic motion."""
    gap, stiffness, pull = 0.01, 1e6, 0.1 * G
    structure = stopped([SQUAT], stop(axis, gap, stiffness), gravity=[sign * pull, 0.0, -G])
    run = solve("ls-dem", structure, every_ms(0.6))
    moved = sign * (run.position[:, 1, 0] - structure.position[1, 0])
    # m g/10 (gap + d) = k d^2 / 2 at the turning point
    static = MASS * pull / stiffness
    turn = static + np.sqrt(static**2 + 2.0 * static * gap)
    # read every 1 ms: off the turn by half of it at most, pull/2 (0.5 ms)^2 times the ratio of forces
    assert moved.max() == pytest.approx(gap + turn, abs=2e-6)
    balance = run.energy[:, :3].sum(axis=1) + run.energy[:, 3:6].sum(axis=1) - run.energy[:, 6]
    # velocity Verlet: (omega dt)^2 / 8 of the energy for omega = sqrt(k / m), twice the stopper's onset
    assert np.ptp(balance) < (5e-5**2 * stiffness / MASS) * MASS * pull * moved.max() + 1e-5
    stored = 0.5 * stiffness * turn**2
    assert run.energy[:, 2].max() == pytest.approx(run.energy[0, 2] + stored, abs=1e-3 * stored)


def test_a_penalty_travels_with_the_driven_body(stopped):
    """Smooth slab moving at V takes the block along through the stop: an elastic stop throws it at 2 V."""
    speed, time = 0.1, np.linspace(0.0, 1.0, 11)
    motion = ground_motion("v", time, {"x": np.full(11, speed)}, "velocity")
    run = solve("ls-dem", stopped([SQUAT], stop("-x", 0.01, 1e6)), 0.4, motion)
    assert run.velocity[-1, 1, 0] == pytest.approx(2.0 * speed, rel=1e-5)
    # the slab's work is the block's energy: Newton's third law on the driven body
    assert run.energy[-1, 6] == pytest.approx(0.5 * MASS * (2.0 * speed) ** 2, rel=1e-4)


def test_an_implicit_stop_deflects_by_force_over_stiffness(stopped):
    """Frictionless block pushed by a tilted gravity against a stop; settled by the implicit scheme's damping."""
    structure = stopped([CUBE], stop("+x", 0.002, 1e7), gravity=[1.0, 0.0, -G])
    run = solve("nscd", structure, np.linspace(0.0, 3.0, 301))
    assert run.position[-1, 1, 0] == pytest.approx(0.002 + structure.mass[1] / 1e7, rel=1e-6)
    assert run.energy[-1, 2] == pytest.approx(0.5 * structure.mass[1] ** 2 / 1e7, rel=1e-4)
    assert np.diff(run.energy[:, 4]).min() >= 0.0
    assert run.numerics["energy_residual"] < 1e-6


def test_a_stop_holds_the_body_it_names(stopped):
    """The solver handles bodies by height and place: here in another order than the file's."""
    far = {**CUBE, "name": "far", "position": [3, 0, 0.25]}
    structure = stopped([far, CUBE], stop("+x", 0.0, 1e7), gravity=[0.5, 0.0, -G])
    run = solve("nscd", structure, 1.0)
    assert run.position[-1, 1, 0] == pytest.approx(3.25, rel=1e-3)
    # the stop rings about its static closure for a while
    assert 0.0 < run.position[-1, 2, 0] < 2.0 * structure.mass[2] * 0.5 / 1e7


@pytest.mark.parametrize(("axis", "sign"), [("+x", 1.0), ("-x", -1.0), ("-y", -1.0)])
def test_an_implicit_stop_turns_a_block_round(axis, sign, stopped):
    along = "xyz".index(axis[1])
    velocity = [0.0, 0.0, 0.0]
    velocity[along] = sign * 0.5
    structure = stopped([{**CUBE, "velocity": velocity}], stop(axis, 0.01, 1e5))
    run = solve("nscd", structure, every_ms(0.2))
    moved = sign * (run.position[:, 1, along] - run.position[0, 1, along])
    # the spring takes all of the kinetic energy: v sqrt(m / k) beyond the gap, less the scheme's damping, w dt / 4
    assert moved.max() == pytest.approx(0.01 + 0.5 * np.sqrt(structure.mass[1] / 1e5), rel=0.02)
    assert -0.5 < sign * run.velocity[-1, 1, along] < -0.4


def test_an_implicit_stop_moves_with_the_driven_body(stopped):
    structure = stopped([CUBE], stop("-x", 0.01, 1e6))
    motion = ground_motion("push", [0.0, 2.0], {"x": [1.0, 1.0]}, "acceleration")
    run = solve("nscd", structure, every_ms(1.0), motion)
    behind = run.position[:, 0, 0] - run.position[:, 1, 0]
    # seen from the floor the block falls onto the spring: k c^2 / 2 = m a (gap + c) at the deepest
    load = structure.mass[1] * 1.0
    closure = (load + np.sqrt(load**2 + 2.0 * 1e6 * load * 0.01)) / 1e6
    # 1 %: the damping of the implicit spring, omega dt / 4 = 0.015 of critical
    assert behind.max() == pytest.approx(0.01 + closure, rel=0.01)
    assert run.position[-1, 1, 0] > 0.45


def test_a_stop_pushes_along_its_turned_axis(stopped):
    """A smooth block slides down the pitched floor against the stop: k c = m g sin(angle) along the floor."""
    angle, gap, stiffness = 0.02, 0.002, 1e7
    structure = stopped([CUBE], stop("+x", gap, stiffness))
    run = solve("nscd", structure, 20.0, pitching(angle))
    along = np.array([np.cos(angle), 0.0, -np.sin(angle)])
    moved = (run.position[-1, 1] - run.position[-1, 0]) @ along
    closure = structure.mass[1] * G * np.sin(angle) / stiffness
    # it bounces first; then the implicit spring's damping, omega dt / 4 = 0.04 of critical, ends it in a second
    assert moved == pytest.approx(gap + closure, abs=1e-3 * closure)
    # seen from the block, 0.35 m above the slab's centre, a stop that does not turn is 7 mm away
    assert abs(run.position[-1, 1, 0] - gap - closure) > 5e-3
    assert run.numerics["energy_residual"] < 1e-4
