"""Shapes that LS-DEM reads from a lattice: boxes as in the paper, and any closed mesh, convex or not."""

from functools import partial

import numpy as np
import pytest
import trimesh

from blockshake.errors import InputError
from blockshake.geometry.level_set_grid import box_grid
from blockshake.geometry.structure import load_structure
from blockshake.solvers.ls_dem import surfaces as surfaces_module
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces, check_shapes

G = 9.81
K_N = LsDemParameters().normal_stiffness
SMALL = {"small": {"box": [0.4, 0.6, 0.4], "chamfer": 0.02}, "slab": {"box": [2.0, 2.0, 0.2]}}
BODY = {"name": "b", "shape": "small", "position": [0.0, 0.0, 0.2]}


@pytest.fixture
def structure_of_meshes(make_structure, tmp_path):
    """Structure whose further shapes are meshes: name to `trimesh.Trimesh`."""

    def make(bodies, meshes, **keys):
        shapes = dict(keys.pop("shapes", {}))
        for name, mesh in meshes.items():
            mesh.export(tmp_path / f"{name}.stl")
            shapes[name] = {"mesh": f"{name}.stl"}
        return make_structure(bodies, shapes=shapes, folder=tmp_path, **keys)

    return make


def _box_mesh(size):
    return trimesh.creation.box(size)


def _channel():
    """A trough along y, 1.2 x 1.0 x 0.6 m, its inside 0.8 m wide and 0.4 m deep: not convex."""
    outline = [
        (-0.6, 0.0),
        (0.6, 0.0),
        (0.6, 0.6),
        (0.4, 0.6),
        (0.4, 0.2),
        (-0.4, 0.2),
        (-0.4, 0.6),
        (-0.6, 0.6),
    ]
    base, top = [(x, -0.5, z) for x, z in outline], [(x, 0.5, z) for x, z in outline]
    n = len(outline)
    caps = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
    sides = [(i, (i + 1) % n, (i + 1) % n + n) for i in range(n)] + [
        (i, (i + 1) % n + n, i + n) for i in range(n)
    ]
    faces = caps + [(a + n, c + n, b + n) for a, b, c in caps] + [(a, c, b) for a, b, c in sides]
    mesh = trimesh.Trimesh(np.array(base + top), faces, process=False)
    mesh.fix_normals()
    assert mesh.is_volume
    return mesh


def _wedge():
    """A ramp 1.2 x 0.6 x 0.6 m whose mass centre lies off the middle of its bounding box."""
    corners = [(x, y, z) for y in (-0.3, 0.3) for x, z in ((0.0, 0.0), (1.2, 0.0), (0.0, 0.6))]
    return trimesh.convex.convex_hull(np.array(corners))


@pytest.mark.parametrize("spacing", [0.02, 0.01, 0.005])
def test_a_block_on_a_lattice_sinks_as_the_exact_one_but_for_its_perimeter(
    spacing, make_structure, run_ls_dem
):
    """Hooke. At the chamfer's width the ring of outermost nodes is 22 % soft (tests/geometry), else as exact."""
    structure = make_structure([BODY], shapes=SMALL)
    exact = run_ls_dem(structure, 0.02)
    grid = run_ls_dem(structure, 0.02, level_set="grid", grid_spacing=spacing)
    sink, exact_sink = (0.2 - run.position[0, 1, 2] for run in (grid, exact))
    if spacing == 0.005:
        # the inset over root two would be needed for none at all: 3.5 mm
        assert sink == pytest.approx(exact_sink, rel=0.01)
    else:
        assert exact_sink < sink < 1.22 * exact_sink
    # at rest from the start, whatever the lattice
    assert np.abs(grid.position - grid.position[0]).max() < 1e-12
    np.testing.assert_allclose(grid.joint_force[-1, 0], [0.0, 0.0, structure.mass[1] * G], atol=1e-3)


@pytest.mark.slow
def test_a_lattice_shifted_by_half_a_cell_sees_the_same_flats(make_structure, run_ls_dem, monkeypatch):
    """With a spacing below the chamfer only the nodes on the rim notice the lattice's place."""
    structure = make_structure([BODY], shapes=SMALL)
    runs = {"aligned": run_ls_dem(structure, 0.02, level_set="grid", grid_spacing=0.005)}
    monkeypatch.setattr(surfaces_module, "box_grid", partial(box_grid, shift=(0.5, 0.5, 0.5)))
    runs["shifted"] = run_ls_dem(structure, 0.02, level_set="grid", grid_spacing=0.005)
    sink = {name: 0.2 - run.position[0, 1, 2] for name, run in runs.items()}
    # the rim's nodes carry about a third of a flat this small
    assert sink["shifted"] == pytest.approx(sink["aligned"], rel=0.02)
    assert sink["shifted"] != sink["aligned"]
    assert np.abs(runs["shifted"].position - runs["shifted"].position[0]).max() < 1e-12


def test_a_box_as_a_mesh_stands_slides_and_weighs_as_the_box(structure_of_meshes, make_structure, run_ls_dem):
    size = [0.4, 0.6, 0.4]
    # off the slab's lattice, where its nodes lie on the block's edges
    thrown = {"position": [0.03, 0.04, 0.2], "velocity": [0.5, 0.0, 0.0]}
    mesh = structure_of_meshes(
        [{"name": "b", "shape": "box", **thrown}], {"box": _box_mesh(size)}, shapes={"slab": SMALL["slab"]}
    )
    box = make_structure(
        [{"name": "b", "shape": "box", **thrown}], shapes={"box": {"box": size}, "slab": SMALL["slab"]}
    )
    assert mesh.mass[1] == pytest.approx(box.mass[1], rel=1e-6)  # an STL file is of single precision
    # below inset / sqrt(2) the lattice rounds no edge at the outermost nodes
    runs = [run_ls_dem(structure, 0.08, rate=1000, grid_spacing=0.0035) for structure in (mesh, box)]
    for run in runs:
        steady = (run.time > 0.02) & (run.time < 0.07)
        slope = np.polyfit(run.time[steady], run.velocity[steady, 1, 0], 1)[0]
        assert slope == pytest.approx(-0.5 * G, rel=5e-3)
    # nodes lie elsewhere: areas under the load agree, so sinks do within the share of the rim
    sink = [0.2 - run.position[0, 1, 2] for run in runs]
    assert sink[0] == pytest.approx(sink[1], rel=0.1)


def test_a_cube_rests_on_the_floor_of_a_trough(structure_of_meshes, run_ls_dem):
    """A body that is not convex: its hull would hold the cube at the rim, 0.4 m higher."""
    channel = _channel()
    rise = channel.center_mass[2]
    structure = structure_of_meshes(
        [
            {"name": "trough", "shape": "trough", "position": [0.0, 0.0, rise]},
            {"name": "cube", "shape": "cube", "position": [0.05, 0.1, 0.2 + 0.15 + 2e-5]},
        ],
        {"trough": channel},
        shapes={"cube": {"box": [0.3, 0.3, 0.3]}, "slab": SMALL["slab"]},
    )
    run = run_ls_dem(structure, 0.1)
    assert run.status == "completed"
    weight = structure.mass[1:] * G
    joints = {tuple(pair): force for pair, force in zip(run.joints, run.joint_force[-1], strict=True)}
    assert joints[1, 2][2] == pytest.approx(weight[1], rel=1e-6)
    assert joints[0, 1][2] == pytest.approx(weight.sum(), rel=1e-6)
    assert run.position[-1, 2, 2] == pytest.approx(0.35, abs=1e-4)
    assert np.abs(run.position[-1] - run.position[0]).max() < 1e-9


def test_a_wall_of_the_trough_stops_what_slides_inside(structure_of_meshes, run_ls_dem):
    """Momentum: the cube thrown at the inner wall takes the trough along; nothing else acts along x."""
    channel = _channel()
    rise = channel.center_mass[2]
    structure = structure_of_meshes(
        [
            {"name": "trough", "shape": "trough", "position": [0.0, 0.0, 0.0]},
            {
                "name": "cube",
                "shape": "cube",
                "position": [0.2, 0.0, 0.37 - rise],
                "velocity": [2.0, 0.0, 0.0],
            },
        ],
        {"trough": channel},
        shapes={"cube": {"box": [0.3, 0.3, 0.3]}},
        slab=False,
        gravity=[0.0, 0.0, 0.0],
        friction=0.0,
        restitution=1.0,
    )
    run = run_ls_dem(structure, 0.06, rate=2000, time_step=1e-5)
    momentum = (structure.mass[:, None] * run.velocity[:, :, 0].T).sum(axis=0)
    np.testing.assert_allclose(momentum, structure.mass[1] * 2.0, rtol=1e-9)
    assert run.velocity[-1, 1, 0] < run.velocity[-1, 0, 0]
    face = run.position[:, 1, 0] + 0.15 - (run.position[:, 0, 0] + 0.4)
    assert 0.0 < face.max() < 2e-3
    # a contact that opens within a step misses up to k (v dt)^2 / 2: (omega dt)^2 of it, omega^2 = k_n A / m
    energy = run.energy[:, :3].sum(axis=1)
    assert energy[-1] == pytest.approx(energy[0], rel=(5600.0 * 1e-5) ** 2)


def test_a_body_inside_another_that_is_not_convex_is_an_error(structure_of_meshes, run_ls_dem):
    channel = _channel()
    rise = channel.center_mass[2]
    structure = structure_of_meshes(
        [
            {"name": "trough", "shape": "trough", "position": [0.0, 0.0, 0.0]},
            {"name": "cube", "shape": "cube", "position": [0.0, 0.0, 0.35 - 0.01 - rise]},
        ],
        {"trough": channel},
        shapes={"cube": {"box": [0.3, 0.3, 0.3]}},
        slab=False,
    )
    with pytest.raises(InputError, match=r"test.yaml: bodies.cube.position: overlaps trough by 10 mm"):
        run_ls_dem(structure, 0.01)


def test_a_body_whose_mass_centre_is_off_its_middle_is_found(structure_of_meshes, run_ls_dem):
    """Broad phase: the ramp's far tip is 0.8 m from its mass centre, its near end 0.4 m."""
    wedge = _wedge()
    tip = np.array([1.2, 0.0, 0.0]) - wedge.center_mass
    structure = structure_of_meshes(
        [
            {"name": "ramp", "shape": "ramp", "position": [0.0, 0.0, 0.0]},
            {
                "name": "cube",
                "shape": "cube",
                "position": [float(tip[0]) + 0.2, 0.0, float(tip[2]) + 0.1],
                "velocity": [-1.0, 0.0, 0.0],
            },
        ],
        {"ramp": wedge},
        shapes={"cube": {"box": [0.3, 0.3, 0.3]}},
        slab=False,
        gravity=[0.0, 0.0, 0.0],
    )
    run = run_ls_dem(structure, 0.1, rate=1000)
    assert len(run.joints) == 1
    assert run.velocity[-1, 0, 0] < 0.0
    momentum = (structure.mass[:, None] * run.velocity[:, :, 0].T).sum(axis=0)
    np.testing.assert_allclose(momentum, -structure.mass[1], rtol=1e-9)


def test_the_skin_misses_nothing_on_a_lattice_either(make_structure, run_ls_dem):
    tilted = {
        "name": "b", "shape": "small", "position": [0.0, 0.0, 0.4],
        "orientation": [0.9689, 0.1, 0.2, 0.1], "velocity": [0.3, 0.1, -2.0],
    }  # fmt: skip
    norm = np.linalg.norm(tilted["orientation"])
    tilted["orientation"] = [part / norm for part in tilted["orientation"]]
    structure = make_structure([tilted], shapes=SMALL)
    runs = [run_ls_dem(structure, 0.3, level_set="grid", skin=skin) for skin in (0.003, 5.0)]
    assert runs[0].numerics["list_searches"] > 10
    assert np.abs(runs[0].velocity[:, 1]).max() > 2.0
    # sums in another order differ by rounding, which an impact or two do not raise above this
    np.testing.assert_allclose(runs[0].position, runs[1].position, atol=1e-9)


def test_a_lattice_too_coarse_to_see_a_shape_is_an_error():
    """From the thickness of the slab on no point lies inside of it, and blocks at rest fell through it."""
    structure = load_structure("configuration-1")
    properties = structure.solids["slab"].properties
    widest = 4.0 / 3.0 * properties.volume / properties.area
    check_shapes(structure, LsDemParameters(level_set="grid", grid_spacing=0.99 * widest))
    with pytest.raises(InputError, match=r"shapes.slab: expected a ls_dem.grid_spacing of at most [\d.]+ m"):
        check_shapes(structure, LsDemParameters(level_set="grid", grid_spacing=1.01 * widest))


def test_a_lattice_too_fine_to_hold_is_an_error(make_structure):
    structure = make_structure([BODY], shapes=SMALL)
    with pytest.raises(InputError, match=r"shapes.slab: expected fewer lattice points"):
        assemble_surfaces(structure, LsDemParameters(level_set="grid", grid_spacing=1e-3))


@pytest.mark.parametrize("chamfer", [0.0, 0.02])
def test_a_block_that_rocks_on_a_lattice_keeps_its_energy(chamfer, make_structure, run_ls_dem):
    """Without damping and friction the audit closes: the force is that of the energy, where edges are rounded too."""
    angle = 0.08
    b, h = 0.2 - chamfer, 0.4
    arm = np.array([-b, 0.0, h])
    turn = np.array(
        [[np.cos(angle), 0.0, np.sin(angle)], [0.0, 1.0, 0.0], [-np.sin(angle), 0.0, np.cos(angle)]]
    )
    centre = np.array([b, 0.0, 2e-5]) + turn @ arm
    structure = make_structure(
        [
            {
                "name": "b",
                "shape": "post",
                "position": centre.tolist(),
                "orientation": [np.cos(angle / 2), 0.0, np.sin(angle / 2), 0.0],
            }
        ],
        shapes={"post": {"box": [0.4, 0.6, 0.8], "chamfer": chamfer}, "slab": SMALL["slab"]},
        friction=0.0,
        restitution=1.0,
    )
    run = run_ls_dem(structure, 0.8, level_set="grid", time_step=1e-5)
    held = run.energy[:, :3].sum(axis=1)
    missing = held + run.energy[:, 3:6].sum(axis=1) - run.energy[:, 6] - held[0]
    in_play = np.ptp(run.energy[:, 1])
    # 4e-2 with the unit normal in its place, whatever the step; nodes that pass a ridge cost a step of first order
    assert np.abs(missing).max() < (5e-3 if chamfer else 1e-3) * in_play
    assert in_play > 10.0
