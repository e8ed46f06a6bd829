"""A table whose pitch does not begin at 0 starts inclined, with all that stands on it; a displacement starts at 0."""

import numpy as np
import pytest
from both_solvers import both, leans, solve

from blockshake.dynamics.motion import ground_motion
from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import load_structure
from blockshake.simulation.run_histories import drift_histories
from blockshake.simulation.simulate import simulate
from blockshake.study.remarks import motion_remarks

G, MU, PLACE, HEIGHT = 9.81, 0.5, 0.8, 0.2  # m/s2, 1, and the block's centre over the slab's top [m]
CENTRE = np.array([0.0, 0.0, -0.1])  # of the slab [m]


def inclined(pitch):
    time = np.linspace(0.0, 1.0, 11)
    columns = {"x": np.full(11, 0.3), "pitch_y": np.full(11, pitch)}
    return ground_motion("inclined", time, columns, "displacement")


def laid(make_structure, **more):
    """A squat block on a slab, away from the slab's centre."""
    return make_structure(
        [{"name": "block", "shape": "squat", "position": [PLACE, 0.0, HEIGHT]}], friction=MU,
        shapes={"squat": {"box": [0.8, 0.8, 2.0 * HEIGHT]}, "slab": {"box": [6.0, 1.4, 0.2]}}, **more,
    )  # fmt: skip


def carried(pitch):
    """Where a table carries the block: right-handed about y, through the slab's mass centre."""
    c, s = np.cos(pitch), np.sin(pitch)
    return CENTRE + np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]) @ ([PLACE, 0.0, HEIGHT] - CENTRE)


@both
@pytest.mark.parametrize("pitch", [1e-5, 0.01, 0.3, -0.3])
def test_below_the_angle_of_friction_a_block_rests_on_the_inclined_table(solver, pitch, make_structure):
    """tan(0.3) is 0.31, below the friction of 0.5; LS-DEM gives way by the stretch and the squeeze of its springs."""
    run = solve(solver, laid(make_structure), 0.5, inclined(pitch))
    assert run.status == "completed"
    squeeze = (
        2.0 * HEIGHT * 2400.0 * G / 9.0e9 if solver == "ls-dem" else 0.0
    )  # m, of the weight on the joint
    np.testing.assert_allclose(run.position[:, 0], CENTRE + np.zeros((101, 3)), atol=1e-15)
    np.testing.assert_allclose(run.position[0, 1], carried(pitch), atol=1e-12 + 2.0 * squeeze)
    np.testing.assert_allclose(leans(run), pitch, atol=1e-12 + 4.0 * squeeze)
    assert np.abs(run.position[:, 1] - run.position[0, 1]).max() < 1e-9


@both
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_above_it_the_block_slides_at_once(solver, side, make_structure):
    """g (sin - mu cos) t^2 / 2 down the table; shear springs, slack at first, gain g sin over their frequency."""
    run = solve(solver, laid(make_structure), 0.5, inclined(0.6 * side))
    down = side * np.array([np.cos(0.6), 0.0, -side * np.sin(0.6)])
    gone = (run.position[:, 1] - run.position[0, 1]) @ down
    times = np.arange(101) / 200.0
    expected = 0.5 * G * (np.sin(0.6) - MU * np.cos(0.6)) * times**2
    gained = G * np.sin(0.6) * np.sqrt(2.0 * HEIGHT * 2400.0 / 9.0e9) if solver == "ls-dem" else 0.0  # m/s
    assert (np.abs(gone - expected) <= 2e-3 * expected[-1] + gained * times).all()


@both
def test_a_spring_pulls_from_where_the_block_starts(solver, make_structure):
    """An inclined block is as far from the spring's rest as a level one: not at all."""
    spring = {"body": "block", "position": [0.0, 0.0, 0.0], "axis": "x", "stiffness": 1e7}
    free, held = (
        solve(solver, laid(make_structure, external_forces=forces), 0.2, inclined(0.3))
        for forces in ([], [spring])
    )
    np.testing.assert_allclose(held.position, free.position, atol=1e-9)


def test_tables_that_turn_apart_are_refused(make_structure):
    bodies = [
        {"name": name, "shape": "slab", "position": [place, 0.0, -0.1], "driven": True}
        for name, place in (("left", -1.5), ("right", 1.5))
    ]
    structure = make_structure(bodies, slab=False)
    wrong = "inclined: pitch_y: expected a pitch that begins at 0, as left and right turn each about its own"
    with pytest.raises(InputError, match=wrong):
        simulate(structure, inclined(0.01), "nscd-rigid")


def test_a_table_that_starts_turned_is_remarked():
    assert motion_remarks(inclined(0.3)) == [
        "the table starts turned by 0.3 rad, and all that stands on it with it"
    ]
    assert motion_remarks(inclined(0.0)) == ["nothing moves"]


def test_deformable_blocks_start_turned_too():
    structure = load_structure("configuration-1")
    run = simulate(structure, inclined(0.02), "nscd-elastic", duration=0.1)
    assert run.attrs["status"] == "completed"
    drift = drift_histories(structure, run["position"].to_numpy(), rotation_matrices(run["orientation"]))
    assert np.abs(drift).max() < 1e-9
