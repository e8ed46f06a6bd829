"""Nodes in packets: alike sides share theirs, and an idle packet that wakes knows the step before."""

import numpy as np
import pytest

from blockshake.dynamics.system import assemble_bodies
from blockshake.geometry.rotations import rotation_matrices
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates, find_candidates
from blockshake.solvers.ls_dem.contact.contact_forces import forces_into, no_loads
from blockshake.solvers.ls_dem.contact.packets import LANES, POINT, cache_lines
from blockshake.solvers.ls_dem.contact.relative_pose import keep_poses, poses_at_rest
from blockshake.solvers.ls_dem.interfaces import assemble_interfaces
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.ls_dem.progress import no_joints
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces

DT, SPEED = 1e-5, 0.1  # s, m/s
COURSE = 12  # blocks


def listed(structure, skin=0.01):
    """Give what a force evaluation takes, without gravity, for the bodies as given."""
    bodies, state, _ = assemble_bodies(structure)
    bodies = bodies._replace(gravity=np.zeros(3))
    surfaces, interfaces = (
        make(structure, LsDemParameters()) for make in (assemble_surfaces, assemble_interfaces)
    )
    poses = poses_at_rest(state.position, np.ascontiguousarray(rotation_matrices(state.orientation)))
    candidates, joints = find_candidates(
        surfaces,
        bodies.driven,
        poses,
        state.orientation,
        skin,
        empty_candidates(len(bodies.mass)),
        no_joints(),
    )
    return bodies, candidates, surfaces, interfaces, poses, no_loads(len(bodies.mass), joints)


@pytest.mark.parametrize("idle", [2, 5])
def test_the_first_touch_has_the_velocity_of_the_steps_before(idle, make_structure):
    """At a uniform speed the dashpot sees that speed: the force is ``k d + c v`` over the area in touch.

    With the step before forgotten the dashpot would see one and a half times the speed.
    """
    way, depth = SPEED * DT, 0.4 * SPEED * DT
    start = 0.8 + (idle * way - depth)
    structure = make_structure([{"name": "block", "shape": "block", "position": [0.0, 0.0, start]}])
    forces = []
    for damped in (1.0, 0.0):
        bodies, candidates, surfaces, interfaces, poses, loads = listed(structure)
        interfaces = interfaces._replace(damping_ratio=damped * interfaces.damping_ratio)
        for step in range(idle + 1):
            forces_into(bodies, candidates, surfaces, interfaces, poses, DT if step > 0 else 0.0, loads)
            keep_poses(poses)
            poses.position[1, 2] -= way
            assert (loads.force[1, 2] > 0.0) == (step == idle)
        forces.append(loads.force[1, 2])
    k_n = 2.0 / (1.0 / interfaces.k_n[0] + 1.0 / interfaces.k_n[1])
    area = forces[1] / (k_n * depth)
    assert area == pytest.approx(0.76 * 2.36, rel=0.02)
    ratio = assemble_interfaces(structure, LsDemParameters()).damping_ratio
    dashpot = 2.0 * ratio * np.sqrt(structure.mass[1] * k_n * area)
    assert forces[0] - forces[1] == pytest.approx(dashpot * SPEED, rel=1e-5)


def test_sides_whose_nodes_lie_alike_share_them(make_structure):
    """A course on a course has two kinds of joints: its packets' places do not grow with it."""
    lower = [{"name": f"lower-{i}", "shape": "block", "position": [0.9 * i, 0.0, 0.8]} for i in range(COURSE)]
    upper = [
        {"name": f"upper-{i}", "shape": "block", "position": [0.9 * i + 0.45, 0.0, 2.4]}
        for i in range(COURSE - 1)
    ]
    _, candidates, surfaces, *_ = listed(make_structure(lower + upper, slab=False))
    packets = candidates.packets
    assert len(packets.alike) < len(packets.kept) / 3
    for side in range(2 * len(candidates.pairs)):
        first, last, at = candidates.first[side], candidates.first[side + 1], candidates.alike[side]
        node = candidates.node[first * LANES : last * LANES]
        rows = packets.alike[at : at + last - first].reshape(last - first, -1, LANES)
        places = rows[:, POINT // LANES : POINT // LANES + 3].transpose(0, 2, 1).reshape(-1, 3)
        offset = surfaces.offset[candidates.pairs[side // 2, side % 2]]
        np.testing.assert_array_equal(places[node >= 0], surfaces.points[node[node >= 0]] - offset)


@pytest.mark.parametrize("n", [0, 1, 7])
def test_rows_begin_where_lines_of_the_cache_do(n):
    rows = cache_lines(n, 3 * LANES)
    assert rows.shape == (n, 3 * LANES)
    assert not rows.any()
    assert n == 0 or rows.ctypes.data % 64 == 0
