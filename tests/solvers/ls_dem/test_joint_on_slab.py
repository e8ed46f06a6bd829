"""A body on a wide slab: its joint is the integral of springs over its own face, wherever it stands."""

import numpy as np
import pytest

from blockshake.dynamics.system import assemble_bodies
from blockshake.geometry.rotations import rotation_matrices
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates, find_candidates
from blockshake.solvers.ls_dem.contact.contact_forces import clear_loads, contact_forces_into, no_loads
from blockshake.solvers.ls_dem.contact.relative_pose import Poses
from blockshake.solvers.ls_dem.interfaces import assemble_interfaces
from blockshake.solvers.ls_dem.joints import no_joints
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces

DEPTH, LEAN = 1e-5, 1e-6  # m, rad; the face stays inside
PLACES = [
    (0.0, 0.0),
    (0.03, 0.0),
    (0.1, -0.05),
    (0.137, 0.211),
    (-0.2, 0.15),
]  # m; nodes of the slab are 0.2 m apart


def wrench(structure, position, orientation):
    """Force and moment of the contact on the second body, without gravity [N, N m]."""
    bodies, state, _ = assemble_bodies(structure)
    bodies = bodies._replace(gravity=np.zeros(3))
    parameters = LsDemParameters()
    surfaces, interfaces = (
        assemble_surfaces(structure, parameters),
        assemble_interfaces(structure, parameters),
    )
    position, orientation = (np.array([state_of[0], own]) for state_of, own in (
        (state.position, position), (state.orientation, orientation),
    ))  # fmt: skip
    rotation = np.ascontiguousarray(rotation_matrices(orientation))
    poses = Poses(position, rotation, position.copy(), rotation.copy())
    candidates, joints = find_candidates(
        surfaces, bodies.driven, poses, orientation, 0.01, empty_candidates(2), no_joints()
    )
    loads = no_loads(2, joints)
    clear_loads(bodies, loads)
    contact_forces_into(candidates, surfaces, interfaces, poses, 0.0, loads)
    return loads.force[1], loads.moment[1], 2.0 / (1.0 / interfaces.k_n[0] + 1.0 / interfaces.k_n[1])


@pytest.mark.parametrize("yaw", [0.0, 0.4, 1.2])
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize(
    ("shape", "flat", "height"), [("block", (0.76, 2.36), 1.6), ("cube", (1.0, 1.0), 1.0)]
)
def test_stiffness_and_moment_are_those_of_the_face(shape, flat, height, place, yaw, make_structure):
    """Springs of k_n per area over the flat: k_n A for a sink, k_n I for a lean about either edge."""
    structure = make_structure([{"name": "b", "shape": shape, "position": [0.0, 0.0, 0.5 * height]}])
    position = [*place, 0.5 * height - DEPTH]
    upright = np.array([np.cos(0.5 * yaw), 0.0, 0.0, np.sin(0.5 * yaw)])
    force, moment, k_n = wrench(structure, position, upright)
    area = flat[0] * flat[1]
    assert force[2] == pytest.approx(k_n * area * DEPTH, rel=0.02)
    assert np.abs(moment).max() < 0.02 * force[2] * min(flat) / 6.0  # of the core, where the edge would open
    for axis in range(2):
        lean = np.array([1.0, 0.0, 0.0, 0.0])
        lean[1 + axis] = 0.5 * LEAN
        _, leaning, _ = wrench(structure, position, product(upright, lean))
        own = rotation_matrices(upright).T @ (leaning - moment)
        # the lean moves the face's middle aside by half the height, and the force with it
        inertia = area * flat[1 - axis] ** 2 / 12.0
        expected = -k_n * inertia * LEAN + 0.5 * height * force[2] * LEAN
        assert own[axis] == pytest.approx(expected, rel=0.02)


def product(one, other):
    """Quaternion of a turn by ``other`` in the frame that ``one`` turned."""
    w, v, u, s = one[0], one[1:], other[1:], other[0]
    return np.concatenate([[w * s - v @ u], w * u + s * v + np.cross(v, u)])
