"""Stops of stiffness zero are not there, to the byte; two stops give the period of the oscillation between them."""

import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

FIELDS = ("position", "orientation", "velocity", "angular_velocity", "energy", "joint_force")
SOLVERS = {
    "ls-dem": lambda structure, motion, times, time_step=5e-5: simulate_ls_dem(
        structure, motion, LsDemParameters(), times, time_step
    ),
    "nscd": lambda structure, motion, times, time_step=1e-3: simulate_nscd(
        structure, motion, NscdParameters(), times, time_step
    ),
}
both = pytest.mark.parametrize("solver", sorted(SOLVERS))


def _stops(stiffness, gap, height=0.0):
    return [
        {"body": "b0", "position": [0.4 * sign, 0.0, height], "axis": f"{name}x", "gap": gap, "stiffness": stiffness}
        for name, sign in (("+", 1.0), ("-", -1.0))
    ]  # fmt: skip


@both
def test_no_stiffness_is_no_stop_to_the_byte(solver, make_structure):
    """Two blocks rock, slide and would run against stops on both sides."""
    time = np.linspace(0.0, 0.7, 141)
    motion = ground_motion("sine", time, {"x": 9.0 * np.sin(20.0 * time)}, "acceleration")
    bodies = [{"name": f"b{i}", "shape": "block", "position": [0.0, 0.0, 0.8 + 1.6 * i]} for i in range(2)]
    runs = [
        SOLVERS[solver](make_structure(bodies, friction=0.6, stoppers=stops), motion, time)
        for stops in ([], _stops(0.0, 1e-4, 0.8), _stops(1e7, 1e-4, 0.8))
    ]
    reach = runs[0].position[:, 1, 0] - runs[0].position[:, 0, 0]
    assert min(reach.max(), -reach.min()) > 2e-4
    for field in FIELDS:
        assert getattr(runs[0], field).tobytes() == getattr(runs[1], field).tobytes()
    assert runs[0].position.tobytes() != runs[2].position.tobytes()


@both
def test_stops_on_both_sides_give_the_period_between_them(solver, make_structure):
    """Without weight and friction: ``2 pi sqrt(m / k)`` on the stops and four gaps on the way, at speed v."""
    stiffness, gap, speed = 1e6, 0.01, 0.5
    body = {"name": "b0", "shape": "cube", "position": [0.0, 0.0, 0.5], "velocity": [speed, 0.0, 0.0]}
    structure = make_structure([body], friction=0.0, gravity=[0.0, 0.0, 0.0], stoppers=_stops(stiffness, gap))
    period = 2.0 * np.pi * np.sqrt(structure.mass[1] / stiffness) + 4.0 * gap / speed
    frequency = np.sqrt(stiffness / structure.mass[1])
    for time_step in (4e-4, 2e-4):
        run = SOLVERS[solver](structure, None, np.linspace(0.0, 1.25 * period, 20001), time_step)
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
