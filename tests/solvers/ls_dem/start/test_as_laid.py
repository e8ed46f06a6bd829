"""Blocks that were placed to the millimetre: they start as they are laid, whatever they overlap by."""

import numpy as np
import pytest
import trimesh

from blockshake.dynamics.system import ELASTIC, KINETIC, POTENTIAL, assemble_bodies
from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import START_TOLERANCE, build_structure
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates, find_candidates
from blockshake.solvers.ls_dem.contact.contact_forces import forces_into, no_loads
from blockshake.solvers.ls_dem.contact.relative_pose import poses_at_rest
from blockshake.solvers.ls_dem.interfaces import assemble_interfaces
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.ls_dem.progress import NearPairs
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces

G = 9.81
K_N = LsDemParameters().normal_stiffness
MM = 1e-3
STILL = 1e-9  # m; the start leaves a billionth of the weight out of balance
ELASTIC_SINK = 2e-5  # m; the tallest of these stacks weighs 40 kPa on 2.16e10 N/m3


def _stack(sizes, place, name="b"):
    """Cubes on each other, their mass centres rounded to the millimetre, and the gap below each [m]."""
    bodies, shapes, gaps, top, reached = [], {}, [], 0.0, 0.0
    for index, size in enumerate(sizes):
        z = np.round(top + 0.5 * size, 3)
        gaps.append(z - 0.5 * size - reached)
        top, reached = top + size, z + 0.5 * size
        shapes[f"{name}{index}"] = {"box": [size, size, size]}
        bodies.append({"name": f"{name}{index}", "shape": f"{name}{index}", "position": [*place, float(z)]})
    return bodies, shapes, np.array(gaps)


@pytest.mark.parametrize("overlap", [0.05, 0.09, 0.2, 0.5, 0.9])
def test_a_block_that_stands_a_little_in_the_slab_stands(overlap, make_structure, run_ls_dem):
    """Its start has the elastic energy of its weight on its joint, W^2 / (2 k A), and no more."""
    shapes = {"stone": {"box": [0.6, 1.2, 1.0]}}
    body = {"name": "b", "shape": "stone", "position": [0.0, 0.0, 0.5 - overlap * MM]}
    structure = make_structure([body], shapes=shapes)
    run = run_ls_dem(structure, 0.6)
    assert run.status == "completed"
    assert np.abs(run.position - run.position[0]).max() < STILL
    weight = structure.mass[1] * G
    assert np.abs(run.position[0] - structure.position).max() < min(overlap * MM, START_TOLERANCE) + 2 * STILL
    assert run.energy[0, ELASTIC] == pytest.approx(weight**2 / (2.0 * K_N * 0.72), rel=1e-6)
    np.testing.assert_allclose(run.joint_force[:, 0, 2], weight, rtol=1e-6)
    assert run.numerics["overlap_as_laid"] == pytest.approx(0.0 if overlap < 0.1 else overlap * MM, abs=1e-12)


def test_thirds_of_a_metre_typed_to_the_millimetre(make_structure, run_ls_dem):
    """Three cubes of 0.3333 m: a gap of 0.35 mm below the lowest, overlaps of 0.3 mm above; they fall by the gap."""
    bodies, shapes, gaps = _stack([0.3333] * 3, (0.0, 0.0))
    np.testing.assert_allclose(gaps, [0.35 * MM, -0.3 * MM, -0.3 * MM], atol=1e-9)
    run = run_ls_dem(make_structure(bodies, shapes=shapes), 0.6, time_step=2e-5, rate=1000)
    moved = run.position[:, 1:] - run.position[0, 1:]
    assert moved[..., 2].max() < STILL
    assert moved[-1, :, 2] == pytest.approx(-gaps[0], abs=ELASTIC_SINK)
    assert np.abs(moved[..., :2]).max() < STILL
    # never more elastic energy than the fall gives
    assert run.energy[:, ELASTIC].max() < run.energy[0, POTENTIAL] - run.energy[:, POTENTIAL].min()


@pytest.mark.parametrize("size", [0.1, 0.3])
@pytest.mark.parametrize("chamfer", [0.0, 0.01])
def test_an_overlap_deeper_than_the_nodes_inset_is_none_for_contact(
    size, chamfer, make_structure, run_ls_dem
):
    """0.3 or 0.9 mm from the edge of a like block 0.95 mm below: its side is nearer than its top."""
    shapes = {"small": {"box": [size, size, 2.0 * size], "chamfer": chamfer}}
    bodies = [
        {"name": f"b{i}", "shape": "small", "position": [0.0, 0.0, (2 * i + 1) * size - i * 0.95 * MM]}
        for i in range(3)
    ]
    structure = make_structure(bodies, shapes=shapes)
    run = run_ls_dem(structure, 0.6, time_step=1e-5)
    assert np.abs(run.position - structure.position).max() < 0.1 * MM
    assert np.abs(run.position - run.position[0]).max() < STILL


def test_a_wall_typed_to_the_millimetre_stands(make_structure, run_ls_dem):
    """Half bond of bricks of 0.3336 x 0.25 x 0.1677 m: heads and beds overlap by up to 0.7 mm."""
    shapes = {"brick": {"box": [0.3336, 0.25, 0.1677]}}
    bodies = [
        {
            "name": f"b{course}{place}", "shape": "brick",
            "position": [0.333 * place + 0.167 * (course % 2), 0.0, 0.0835 + 0.167 * course],
        }
        for course in range(4) for place in range(4 - course % 2)
    ]  # fmt: skip
    structure = make_structure(bodies, shapes=shapes, friction=0.7)
    assert np.count_nonzero(np.triu(structure.touching)) == 4 + 3 * 6 + 2 * 3 + 2 * 2
    run = run_ls_dem(structure, 0.6, time_step=2e-5)
    assert run.status == "completed"
    assert np.abs(run.position - structure.position).max() < MM
    # no hop and no spread: what moves are the elastic sink and, of tenths of a micrometre, the friction's
    assert np.abs(run.position - run.position[0]).max() < 0.02 * MM


def test_stacks_of_any_sizes_typed_to_the_millimetre_are_never_thrown(make_structure, run_ls_dem):
    """Twelve stacks of three random cubes: none is thrown, and none falls by more than the gaps beneath it."""
    generator = np.random.default_rng(39)
    bodies, shapes, allowed = [], {}, []
    for number in range(12):
        sizes = generator.uniform(0.25, 0.9, 3)
        sizes.sort()
        more, further, gaps = _stack(sizes[::-1], (3.0 * (number % 4), 3.0 * (number // 4)), f"s{number}-")
        bodies, shapes = bodies + more, shapes | further
        allowed.extend(np.cumsum(np.maximum(gaps, 0.0)))
    shapes |= {"slab": {"box": [30.0, 30.0, 0.2]}}
    run = run_ls_dem(make_structure(bodies, shapes=shapes, restitution=0.5), 0.3, time_step=2e-5, rate=500)
    moved = (run.position - run.position[0])[:, 1:]
    allowed = np.array(allowed)
    assert run.status == "completed"
    # a cube may rise a little where a lighter one falls on it, by less than the fall; a fall ends as deep in the
    # springs as its speed states, v sqrt(m / k A), of columns of 2 m
    falls = allowed.reshape(-1, 3).max(axis=1).repeat(3)
    impact = np.sqrt(2.0 * G * falls * 2400.0 * 2.0 / K_N)
    assert (moved[..., 2].max(axis=0) < falls + ELASTIC_SINK).all()
    assert (moved[..., 2].min(axis=0) > -allowed - impact - ELASTIC_SINK).all()
    assert run.energy[:, POTENTIAL].max() <= run.energy[0, POTENTIAL]
    assert np.abs(moved[..., :2]).max() < MM


def test_a_block_between_two_walls_that_it_does_not_fit_stands(make_structure, run_ls_dem):
    """No pose frees it: 0.4 mm inside either of two driven walls. Each joint is taken as it was laid."""
    shapes = {"post": {"box": [0.4, 1.0, 1.0]}}
    walls = [
        {"name": name, "shape": "cube", "position": [side * (0.7 - 0.4 * MM), 0.0, 0.5], "driven": True}
        for name, side in (("left", -1.0), ("right", 1.0))
    ]
    post = {"name": "post", "shape": "post", "position": [0.0, 0.0, 0.5 - 0.3 * MM]}
    structure = make_structure([*walls, post], shapes=shapes)
    run = run_ls_dem(structure, 0.3)
    assert np.abs(run.position - structure.position).max() < ELASTIC_SINK
    assert np.abs(run.position - run.position[0]).max() < STILL
    # squeezed as it was given it would hold k A d^2 / 2 twice: 3.5 kJ
    assert run.energy[0, ELASTIC] < 1.0


def test_a_soft_joint_keeps_the_overlap_that_is_its_sink(make_structure, run_ls_dem):
    """A layer that the weight presses by 0.5 mm, given so, below a joint that was typed 0.3 mm too low."""
    shapes = {"bed": {"box": [1.0, 1.0, 0.5]}}
    weight = 1.5 * 2400.0 * G
    sink = weight * (1.3e-8 + 1.0 / K_N)
    bodies = [
        {"name": "low", "shape": "bed", "position": [0.0, 0.0, 0.25 - sink]},
        {"name": "high", "shape": "cube", "position": [0.0, 0.0, 1.0 - sink - 0.3 * MM]},
    ]
    joints = [{"bodies": ["slab", "low"], "compliance": 1.3e-8}]
    structure = make_structure(bodies, shapes=shapes, joints=joints)
    assert sink == pytest.approx(0.46 * MM, rel=0.01)
    run = run_ls_dem(structure, 0.6)
    assert np.abs(run.position - structure.position).max() < 1e-7
    assert run.energy[:, KINETIC].max() < 1e-9


def test_a_tilted_block_with_its_edge_in_the_slab_stays_tilted_and_does_not_hop(make_structure, run_ls_dem):
    angle, overlap = 0.05, 0.5 * MM
    # the lowest nodes, 2.4 mm from the edge, are inside by the overlap
    pivot = 0.4 - 0.0024
    position = [
        pivot - pivot * np.cos(angle) + 0.8 * np.sin(angle),
        0.0,
        pivot * np.sin(angle) + 0.8 * np.cos(angle) - overlap,
    ]
    orientation = [np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0]
    structure = make_structure(
        [{"name": "b", "shape": "sharp", "position": position, "orientation": orientation}], friction=0.9
    )
    run = run_ls_dem(structure, 0.3, rate=2000)
    np.testing.assert_array_equal(run.position[0], structure.position)
    # it falls back onto its base about that edge, and rises by nothing
    assert run.position[:, 1, 2].max() < position[2] + 1e-6
    held = run.energy[0, KINETIC : ELASTIC + 1].sum()
    assert run.energy[:, KINETIC].max() < held - run.energy[:, POTENTIAL].min()


def test_a_gap_closes_by_falling(make_structure, run_ls_dem):
    """0.5 mm above the slab: the fall is physics, and ends on the slab."""
    structure = make_structure([{"name": "b", "shape": "cube", "position": [0.0, 0.0, 0.5 + 0.5 * MM]}])
    run = run_ls_dem(structure, 0.6, time_step=1e-5)
    moved = run.position[:, 1, 2] - run.position[0, 1, 2]
    assert moved.max() <= 0.0
    assert moved[-1] == pytest.approx(-0.5 * MM, abs=ELASTIC_SINK)


def _structure_with_mesh(make_mapping, folder, mesh, bodies):
    mesh.export(folder / "body.stl")
    shapes = {"mesh": {"mesh": "body.stl"}, "filling": {"box": [0.4, 0.4, 0.3], "chamfer": 0.03}}
    return build_structure(make_mapping(bodies, shapes=shapes), "test.yaml", folder)


def test_a_mesh_on_a_mesh_is_laid_as_boxes_are(make_mapping, tmp_path, run_ls_dem):
    bodies = [
        {"name": f"b{i}", "shape": "mesh", "position": [0.0, 0.0, 0.3 + 0.6 * i - 0.7 * MM * i]}
        for i in range(2)
    ]
    structure = _structure_with_mesh(make_mapping, tmp_path, trimesh.creation.box([0.5, 0.5, 0.6]), bodies)
    run = run_ls_dem(structure, 0.6, time_step=2e-5)
    assert np.abs(run.position - structure.position).max() < ELASTIC_SINK
    assert np.abs(run.position - run.position[0]).max() < STILL


def test_a_body_that_no_shift_parts_from_another_is_refused(make_mapping, tmp_path, run_ls_dem):
    """A trough 0.3 mm narrower on either side than what lies in it."""
    inner = 0.2 - 0.3 * MM
    outline = np.array(
        [
            (-0.4, 0.0),
            (0.4, 0.0),
            (0.4, 0.6),
            (inner, 0.6),
            (inner, 0.2),
            (-inner, 0.2),
            (-inner, 0.6),
            (-0.4, 0.6),
        ]
    )
    ends = [np.insert(outline, 1, y, axis=1) for y in (-0.2, 0.2)]
    caps = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
    sides = [
        face for i in range(8) for face in ((i, (i + 1) % 8, (i + 1) % 8 + 8), (i, (i + 1) % 8 + 8, i + 8))
    ]
    faces = caps + [(a + 8, c + 8, b + 8) for a, b, c in caps] + [(a, c, b) for a, b, c in sides]
    trough = trimesh.Trimesh(np.vstack(ends), faces, process=False)
    trough.fix_normals()
    rise = trough.center_mass[2]
    bodies = [
        {"name": "trough", "shape": "mesh", "position": [0.0, 0.0, rise]},
        {"name": "filling", "shape": "filling", "position": [0.0, 0.0, 0.2 + 0.15]},
    ]
    structure = _structure_with_mesh(make_mapping, tmp_path, trough, bodies)
    with pytest.raises(
        InputError, match=r"bodies.filling.position: overlaps trough by 0\.[36] mm on sides that no shift"
    ):
        run_ls_dem(structure, 0.01)


def test_the_force_of_a_shifted_joint_has_no_moment_of_its_own(make_structure):
    """Action is reaction about one point of the world, wherever contact sees the bodies."""
    lean = np.array([np.cos(0.01), 0.006, 0.008, 0.0])
    structure = make_structure(
        [
            {"name": "a", "shape": "block", "position": [0.0, 0.0, 0.8]},
            {"name": "b", "shape": "cube", "position": [0.1, 0.2, 2.5]},
        ],
        slab=False,
    )
    bodies, state, _ = assemble_bodies(structure)
    bodies = bodies._replace(gravity=np.zeros(3))
    orientation = np.array([state.orientation[0], lean / np.linalg.norm(lean)])
    position = np.array([[0.0, 0.0, 0.8], [0.1, 0.2, 2.08]])
    rotation = np.ascontiguousarray(rotation_matrices(orientation))
    poses = poses_at_rest(position, rotation)
    surfaces = assemble_surfaces(structure, LsDemParameters())
    interfaces = assemble_interfaces(structure, LsDemParameters())
    joints = NearPairs(
        np.array([[0, 1]]), np.array([[0.3, -0.2, 5.0]]) * MM, np.zeros((1, 3)), np.zeros(1), np.zeros(1),
        np.zeros(1, dtype=bool),
    )  # fmt: skip
    candidates, joints = find_candidates(
        surfaces, bodies.driven, poses, orientation, 0.01, empty_candidates(2), joints
    )
    loads = no_loads(2, joints)
    forces_into(bodies, candidates, surfaces, interfaces, poses, 0.0, loads)
    assert np.abs(loads.force[1]).max() > 1e5
    np.testing.assert_allclose(loads.force[0], -loads.force[1], rtol=1e-12)
    total = loads.moment.sum(axis=0) + np.cross(position, loads.force).sum(axis=0)
    np.testing.assert_allclose(total, 0.0, atol=1e-9 * np.abs(loads.force).max())


def test_a_stack_laid_with_overlaps_rocks_with_a_closed_audit(make_structure, run_ls_dem):
    """The shift is for good: a kicked pair of blocks goes through uplift and impact with it."""
    # both turn as one about the edge at +x
    turn, pivot = 0.3, 0.378
    bodies = [
        {
            "name": name, "shape": "block", "position": [0.0, 0.0, z], "angular_velocity": [0.0, turn, 0.0],
            "velocity": [turn * z, 0.0, turn * pivot],
        }
        for name, z in (("low", 0.8 - 0.4 * MM), ("high", 2.4 - 1.2 * MM))
    ]  # fmt: skip
    run = run_ls_dem(make_structure(bodies, friction=0.9), 1.0, time_step=1e-5)
    balance = run.energy[:, :3].sum(axis=1) + run.energy[:, 3:6].sum(axis=1) - run.energy[:, 6]
    assert run.numerics["overlap_as_laid"] == pytest.approx(0.8 * MM, rel=1e-6)
    assert 2.0 * np.abs(run.orientation[:, 2, 2]).max() > 0.01
    assert np.abs(balance - balance[0]).max() < 1e-3 * run.energy[:, KINETIC].max()
