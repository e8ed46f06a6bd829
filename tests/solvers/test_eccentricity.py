"""A mass centre off the centroid (`mass_offset`), in both solvers: statics, onset of rocking, flight, collisions."""

import json

import numpy as np
import pytest
from both_solvers import both, leans, solve
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import build_structure
from blockshake.geometry.surface_nodes import line_nodes
from blockshake.measurement.sensors.markers import marker_position
from blockshake.simulation.simulate import simulate

G = 9.81
K_N = 2.16e10  # N/m3, ls_dem.normal_stiffness by default
B, H = 0.4, 0.8  # m, half width and half height of the sharp block
INSET = 0.003 * 2.0 * B  # m, of LS-DEM's outermost nodes, its pivot
LEVER = {"ls-dem": B - INSET, "nscd": B}


def _upright(offset=None, **keys):
    body = {"name": "b", "shape": "sharp", "position": [0.0, 0.0, H], **keys}
    return body if offset is None else {**body, "mass_offset": list(offset)}


def test_ls_dem_leans_by_the_moment_over_k_i(make_structure):
    """Winkler's base: ``k_n I phi = m g (e + H phi)``, I of the rows; the centroid sinks by ``m g / (k_n A)``."""
    offset, seat = 0.05, {"slab": {"box": [2.0 * B, 2.4, 0.2]}}
    structure = make_structure([_upright((offset, 0.0, 0.0))], shapes=seat)
    run = solve("ls-dem", structure, np.linspace(0.0, 0.02, 5))
    x, width = line_nodes(2.0 * B, 0.2, INSET)
    weight, stiffness = structure.mass[1] * G, K_N * 2.4 * (width @ x**2)
    # 1e-6: the start is relaxed to 1e-9 of the weight, and the lean is of second order in its own square
    assert leans(run)[-1] == pytest.approx(weight * offset / (stiffness - weight * H), rel=1e-6)
    centroid = run.position[-1, 1] - rotation_matrices(run.orientation[-1, 1]) @ structure.mass_offset[1]
    assert H - centroid[2] == pytest.approx(weight / (K_N * 2.0 * B * 2.4), rel=1e-6)
    assert run.joint_force[-1, 0, 2] == pytest.approx(weight, rel=1e-6)


@both
@pytest.mark.parametrize(("offset", "stands"), [(0.06, True), (0.11, False), (-0.06, True), (-0.11, False)])
def test_a_block_on_a_post_stands_while_its_mass_centre_is_above_it(solver, offset, stands, make_structure):
    """Statics: the resultant passes through the mass centre's foot, which the post of half width 0.1 m must hold."""
    shapes = {"slab": {"box": [0.2, 2.4, 0.2]}}
    structure = make_structure([_upright((offset, 0.0, 0.0))], friction=0.9, shapes=shapes)
    run = solve(solver, structure, np.linspace(0.0, 0.5, 51))
    lean = leans(run)[-1]
    # a foot 0.01 m outside turns the block by m g 0.01 / (2 I) t^2 = 0.01 rad in 0.5 s; LS-DEM's springs lean by 1e-3,
    # since nearly all of the load is on the post's last row of nodes, which stands for 1 cm of its width
    assert (np.sign(offset) * lean > 5e-3) == (not stands)
    if stands:
        assert abs(lean) < 2e-3
        assert run.joint_force[-1, 0, 2] == pytest.approx(structure.mass[1] * G, rel=2e-3)


@both
@pytest.mark.parametrize("push", [1.0, -1.0])
@pytest.mark.parametrize(("part", "rocks"), [(0.99, False), (1.01, True)])
def test_onset_of_rocking_depends_on_the_side(solver, push, part, rocks, make_structure):
    """A slow ramp of base acceleration: the block tips at ``g (b - e) / h`` to e's side, at ``g (b + e) / h`` away."""
    offset = (0.05, 0.0, 0.1)
    onset = G * (LEVER[solver] + push * offset[0]) / (H + offset[2])
    time = np.arange(0.0, 2.0001, 0.01)
    ramp = push * part * onset * 0.5 * (1.0 - np.cos(np.pi * np.minimum(time, 1.0)))
    motion = ground_motion("ramp", time, {"x": ramp}, "acceleration")
    structure = make_structure([_upright(offset)], friction=0.9)
    run = solve(solver, structure, np.linspace(0.0, 1.8, 91), motion)
    lean = leans(run)
    # 1 % of excess grows with p = 2.8 1/s: 0.01 * 0.38 (cosh(p 0.8 s) - 1) = 0.013 rad; LS-DEM's springs lean by
    # 5e-4; base to +x leans the block to -x
    assert (-push * lean[-1] > 8e-3) == rocks
    if not rocks:
        assert np.abs(lean).max() < (1e-3 if solver == "ls-dem" else 1e-7)


@both
def test_free_flight_turns_about_the_mass_centre(solver, make_structure):
    """Euler's equations with the inertia about the mass centre, which moves straight; markers go with the surface."""
    offset, turn = np.array([0.1, -0.3, 0.2]), Rotation.from_rotvec([0.3, -0.5, 0.2])
    spin, speed, place = np.array([1.0, -2.0, 1.5]), np.array([0.3, 0.1, -0.2]), np.array([0.4, 1.2, -0.8])
    body = _upright(
        offset, velocity=speed.tolist(), angular_velocity=spin.tolist(),
        orientation=np.roll(turn.as_quat(), 1).tolist(),
    )  # fmt: skip
    structure = make_structure(
        [body], slab=False, gravity=[0.0, 0.0, 0.0],
        markers=[{"name": "corner", "body": "b", "position": place.tolist()}],
    )  # fmt: skip
    times = np.linspace(0.0, 1.0, 11)
    run = solve(solver, structure, times)
    lever = turn.apply(offset)
    expected = np.array([0.0, 0.0, H]) + lever + times[:, None] * (speed + np.cross(spin, lever))
    np.testing.assert_allclose(run.position[:, 0], expected, atol=1e-12)
    # second moment about the centroid unchanged, then the parallel-axis theorem
    moment = structure.mass[0] * (np.diag([0.8, 2.4, 1.6]) ** 2 / 12.0 - np.outer(offset, offset))
    inertia = np.trace(moment) * np.eye(3) - moment

    def euler(_, y):
        R = Rotation.from_quat(y[:4] / np.linalg.norm(y[:4]))
        w = R.apply(np.linalg.solve(inertia, R.apply(y[4:], inverse=True)))
        dq = (
            0.5
            * (Rotation.from_quat(np.append(w, 0.0), scalar_first=False) * R).as_quat()
            * np.linalg.norm(w)
        )
        return np.concatenate([dq, np.zeros(3)])

    start = np.concatenate([turn.as_quat(), turn.apply(inertia @ turn.apply(spin, inverse=True))])
    path = solve_ivp(euler, (0.0, 1.0), start, t_eval=times, rtol=1e-10, atol=1e-12).y[:4]
    theory = Rotation.from_quat(path.T)
    found = Rotation.from_quat(np.roll(run.orientation[:, 0], -1, axis=1))
    # both schemes are of second order: (omega dt)^2 t omega / 12 = 2e-6 rad for NSCD's 1e-3 s
    assert (found * theory.inv()).magnitude().max() < 1e-5
    places = marker_position(structure, run.position, run.orientation)[:, 0]
    seen = expected - expected[0] + theory.apply(place - offset) - turn.apply(place - offset)
    np.testing.assert_allclose(places - places[0], seen, atol=2e-5)


@pytest.mark.parametrize("keys", [("ls-dem", {}), ("ls-dem", {"level_set": "grid"}), ("nscd", {})])
def test_a_collision_keeps_linear_and_angular_momentum(keys, make_structure):
    """Newton's third law with both mass centres off: the moment of every contact force counts from its own."""
    solver, numerics = keys
    cube = {"shape": "cube", "orientation": [0.9, 0.1, 0.3, 0.2]}
    quaternion = np.array(cube["orientation"]) / np.linalg.norm(cube["orientation"])
    bodies = [
        {"name": "a", "shape": "cube", "position": [0.0, 0.0, 0.0], "mass_offset": [0.1, -0.2, 0.05]},
        {
            **cube, "name": "b", "position": [1.5, 0.4, 0.3], "orientation": quaternion.tolist(),
            "velocity": [-2.0, 0.0, 0.0], "angular_velocity": [0.5, 1.0, -1.0], "mass_offset": [-0.15, 0.1, 0.2],
        },
    ]  # fmt: skip
    structure = make_structure(bodies, slab=False, friction=0.6, gravity=[0.0, 0.0, 0.0])
    run = solve(solver, structure, np.linspace(0.0, 0.4, 9), **numerics)
    turn = rotation_matrices(run.orientation)
    spin = np.einsum("tbij,bjk,tblk,tbl->tbi", turn, structure.inertia, turn, run.angular_velocity)
    linear = structure.mass[:, None] * run.velocity
    angular = (np.cross(run.position, linear) + spin).sum(axis=1)
    linear = linear.sum(axis=1)
    # they meet: each body's momentum changes by more than a tenth
    assert np.abs(np.diff(run.velocity[:, 0], axis=0)).max() > 0.2
    np.testing.assert_allclose(linear, linear[:1] + 0.0 * linear, atol=1e-9 * np.abs(linear).max())
    # NSCD's impulses act at the poses of detection, half a step away: omega dt / 2 of the impulse's moment
    loose = 1e-9 if solver == "ls-dem" else 2e-3
    np.testing.assert_allclose(angular, angular[:1] + 0.0 * angular, atol=loose * np.abs(angular).max())


@pytest.mark.parametrize("model", ["ls-dem", "nscd-rigid"])
def test_the_parameter_is_set_and_told(model):
    name, offset = "bodies.block-1.mass_offset", [0.05, 0.0, 0.0]
    run = simulate("configuration-1", "basso-tirreno", model, {name: offset}, duration=0.01)
    assert json.loads(run.attrs["parameters"])[name] == offset
    again = build_structure(json.loads(run.attrs["structure_file"]), "run", ".")
    assert again.position[1, 0] == 0.05
    # the surface is where it was: markers do not start elsewhere
    np.testing.assert_array_equal(
        again.arms(again.file.markers)[1],
        np.array(again.file.markers[1].position)
        - (offset if again.file.markers[1].body == "block-1" else 0.0),
    )
