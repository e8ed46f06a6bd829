"""The acceleration that a block bears at rest is b/h of g, Housner (1963), whatever its size, shape and seat."""

import numpy as np
import pytest
import trimesh

from blockshake.dynamics.motion import ground_motion
from blockshake.dynamics.system import assemble_bodies
from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron, triangles
from blockshake.geometry.rotations import rotation_matrices
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates, find_candidates
from blockshake.solvers.ls_dem.contact.contact_forces import forces_into, no_loads
from blockshake.solvers.ls_dem.contact.relative_pose import poses_at_rest
from blockshake.solvers.ls_dem.interfaces import assemble_interfaces
from blockshake.solvers.ls_dem.parameters import LsDemParameters, own_stiffness
from blockshake.solvers.ls_dem.progress import no_joints
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces

G = 9.81


@pytest.fixture
def stood(make_structure, tmp_path):
    """Block of a width, 1.5 times as deep and twice as high, on a wide slab or on its like; its b/h."""

    def make(width, shape, seat, chamfer):
        size, leg = [width, 1.5 * width, 2.0 * width], 0.025 * width if chamfer else 0.0
        block = {"box": size, "chamfer": leg}
        if shape == "mesh":
            solid = convex_polyhedron(box_vertices(size, leg))
            trimesh.Trimesh(solid.vertices, triangles(solid)).export(tmp_path / "block.stl")
            block = {"mesh": "block.stl"}
        shapes = {"stone": block, "slab": {"box": [4.0 * width, 4.0 * width, 0.2 * width]}}
        low = {"name": "low", "shape": "slab", "position": [0.0, 0.0, -0.1 * width], "driven": True}
        if seat == "its like":
            low |= {"shape": "stone", "position": [0.0, 0.0, -width]}
        bodies = [low, {"name": "b", "shape": "stone", "position": [0.0, 0.0, width]}]
        structure = make_structure(bodies, slab=False, shapes=shapes, folder=tmp_path)
        return structure, (0.5 * width - leg) / width

    return make


def _threshold(structure, width):
    """Largest steady acceleration over g that the seat's forces bear at any lean: their moment over weight x height."""
    parameters = LsDemParameters(**own_stiffness(structure))
    surfaces, interfaces = (
        assemble_surfaces(structure, parameters),
        assemble_interfaces(structure, parameters),
    )
    bodies, state, _ = assemble_bodies(structure)
    bodies, weight = bodies._replace(gravity=np.zeros(3)), structure.mass[1] * G
    reach = parameters.perimeter_inset * width

    def wrench(lean, height):
        """Force up and moment about y on a block that leans, the middle of its base above that of the seat."""
        position, orientation = state.position.copy(), state.orientation.copy()
        position[1] = [width * np.sin(lean), 0.0, height]
        orientation[1] = [np.cos(0.5 * lean), 0.0, np.sin(0.5 * lean), 0.0]
        rotation = np.ascontiguousarray(rotation_matrices(orientation))
        poses = poses_at_rest(position, rotation)
        candidates, joints = find_candidates(
            surfaces, bodies.driven, poses, orientation, 0.01, empty_candidates(2), no_joints()
        )
        loads = no_loads(2, joints)
        forces_into(bodies, candidates, surfaces, interfaces, poses, 0.0, loads)
        return loads.force[1, 2], loads.moment[1, 1]

    borne = []
    for lean in np.geomspace(1e-6, 3e-3, 25):
        # the height at which the springs carry the weight: no deeper than the inset below where the edge would touch
        top = width * np.cos(lean) + 0.5 * width * np.sin(lean)
        low, high = top - reach, top
        for _ in range(45):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if wrench(lean, middle)[0] > weight else (low, middle)
        force, moment = wrench(lean, low)
        if force == pytest.approx(weight, rel=1e-3):
            borne.append(-moment / (force * low))
    return max(borne)


@pytest.mark.parametrize("chamfer", [False, True])
@pytest.mark.parametrize("seat", ["slab", "its like"])
@pytest.mark.parametrize("shape", ["box", "mesh"])
@pytest.mark.parametrize("width", [0.05, 0.1, 0.3, 0.8, 5.0])
def test_the_static_threshold_is_b_over_h(width, shape, seat, chamfer, stood):
    structure, slenderness = stood(width, shape, seat, chamfer)
    assert _threshold(structure, width) == pytest.approx(slenderness, rel=0.01)


@pytest.mark.parametrize(("part", "rocks"), [(0.98, False), (1.01, True)])
@pytest.mark.parametrize("width", [0.05, 0.3])
def test_a_narrow_block_on_its_like_rocks_above_it_and_not_below(
    width, part, rocks, make_structure, run_ls_dem
):
    """On a tilted gravity, as on a slope: tan = b/h of the standing block, reached without a jerk."""
    shapes = {"stone": {"box": [width, 2.0 * width, 2.0 * width]}}
    bodies = [{"name": "b", "shape": "stone", "position": [0.0, 0.0, width]}]
    structure = make_structure(bodies, shapes=shapes, friction=0.9)
    unit = np.sqrt(width / 0.8)  # of time: a pendulum's
    time = np.arange(0.0, 1.8001, 0.01) * unit
    a = part * 0.5 * G * 0.5 * (1.0 - np.cos(np.pi * np.minimum(time / unit, 1.0)))
    motion = ground_motion("ramp", time, {"x": a}, "acceleration")
    stiffness = own_stiffness(structure)
    run = run_ls_dem(
        structure, 1.8 * unit, motion=motion, rate=50 / unit, time_step=1e-4 * width, **stiffness
    )
    lean = 2.0 * np.abs(np.arctan2(run.orientation[:, 1, 2], run.orientation[:, 1, 0])).max()
    assert (lean > 0.01) == rocks
