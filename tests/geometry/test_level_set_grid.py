import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from blockshake.geometry.level_set import box_distance
from blockshake.geometry.level_set_grid import box_grid, grid_distance, grid_table, mesh_grid
from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron, triangles
from blockshake.jit import kernel

SIZE, CHAMFER, SPACING = np.array([0.8, 2.4, 1.6]), 0.02, 0.02  # Zhou et al. (2023)
ROUNDING = 1e-12
TABLE = grid_table([box_grid(SIZE, CHAMFER, SPACING)])
SHARP = grid_table([box_grid(SIZE, 0.0, SPACING)])


@kernel
def _evaluate_into(points, table, shape, result):
    first, o, n = table.first[shape], table.origin[shape], table.counts[shape]
    for i in range(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        result[i, 0], result[i, 1], result[i, 2], result[i, 3], _ = grid_distance(
            x, y, z, table.values, first, o[0], o[1], o[2], n[0], n[1], n[2], 1.0 / table.spacing[shape]
        )


def _evaluate(points, table=TABLE, shape=0):
    points = np.atleast_2d(np.asarray(points, dtype=float))
    result = np.empty((len(points), 4))
    _evaluate_into(points, table, shape, result)
    return result[:, 0], result[:, 1:]


def _box(points, chamfer=CHAMFER):
    values = np.array([box_distance(*point, *(SIZE / 2.0), chamfer) for point in points])
    return values[:, 0], values[:, 1:]


def _lattice_points(grid):
    axes = [grid.origin[axis] + grid.spacing * np.arange(grid.values.shape[axis]) for axis in range(3)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)


def test_the_lattice_holds_the_exact_distance_of_the_box():
    """Zhou et al. (2023), Eq. (1): inside the closed form; outside the distance to the nearest of all triangles."""
    grid = box_grid(SIZE, CHAMFER, 0.1)
    points, values = _lattice_points(grid), grid.values.ravel()
    exact, _ = _box(points)
    inside = exact <= 0.0
    np.testing.assert_allclose(values[inside], exact[inside], atol=ROUNDING)
    solid = convex_polyhedron(box_vertices(SIZE, CHAMFER))
    corners = solid.vertices[triangles(solid)]
    nearest = np.min(
        [
            np.linalg.norm(
                trimesh.triangles.closest_point(
                    np.repeat(corners[[t]], (~inside).sum(), axis=0), points[~inside]
                )
                - points[~inside],
                axis=1,
            )
            for t in range(len(corners))
        ],
        axis=0,
    )
    np.testing.assert_allclose(values[~inside], nearest, atol=ROUNDING)


@pytest.mark.parametrize("spacing", [0.02, 0.16, 0.07])
def test_the_lattice_lies_as_documented(spacing):
    grid = box_grid(SIZE, CHAMFER, spacing)
    low, high = grid.origin, grid.origin + spacing * (np.array(grid.values.shape) - 1)
    np.testing.assert_allclose(low, -high, atol=ROUNDING)
    beyond = -SIZE / 2.0 - low
    assert (beyond >= 2.0 * spacing - ROUNDING).all()
    assert (beyond < 3.0 * spacing).all()
    multiple = np.isclose(SIZE / spacing, np.round(SIZE / spacing))
    np.testing.assert_allclose(beyond[multiple], 2.0 * spacing, atol=ROUNDING)
    np.testing.assert_array_equal(grid.values, grid.values[::-1, ::-1, ::-1])


@pytest.mark.parametrize("shift", [(0.0, 0.0, 0.0), (0.5, 0.5, 0.5)])
def test_over_a_flat_value_and_normal_are_exact(shift):
    """A trilinear function reproduces a plane, wherever the lattice lies, a cell off the flat's perimeter."""
    table = grid_table([box_grid(SIZE, CHAMFER, SPACING, shift)])
    rng = np.random.default_rng(5)
    for axis in range(3):
        for side in (-1.0, 1.0):
            points = (rng.random((200, 3)) - 0.5) * (SIZE - 2.0 * CHAMFER - 6.0 * SPACING)
            points[:, axis] = side * (SIZE[axis] / 2.0 + (rng.random(200) - 0.5) * 2.0 * SPACING)
            phi, normal = _evaluate(points, table)
            np.testing.assert_allclose(phi, side * points[:, axis] - SIZE[axis] / 2.0, atol=ROUNDING)
            np.testing.assert_allclose(normal, side * np.eye(3)[[axis] * 200], atol=1e-11)


def test_at_the_chamfers_the_error_is_bounded_by_and_falls_with_the_spacing():
    """A mean of corner values of a function that changes at most by the distance: within sqrt(3)/2 of the cell.

    The lattice lies askew, at the same place of a cell for every spacing, so that the error goes with the cell.
    Aligned, a chamfer is a diagonal of the lattice and exact where no other face is near.
    """
    size = np.array([0.24, 0.24, 0.24])
    across = np.linspace(0.0, CHAMFER, 4001)
    points = np.column_stack([size[0] / 2.0 - across, 0.0 * across, size[2] / 2.0 - CHAMFER + across])
    worst = []
    for spacing in (0.02, 0.01, 0.005):
        phi, _ = _evaluate(points, grid_table([box_grid(size, CHAMFER, spacing, (0.3, 0.0, 0.4))]))
        worst.append(np.abs(phi).max())
        assert 0.05 * spacing < worst[-1] <= np.sqrt(3.0) / 2.0 * spacing
        phi, _ = _evaluate(points, grid_table([box_grid(size, CHAMFER, spacing)]))
        assert np.abs(phi).max() < ROUNDING
    # both ridges of a chamfer lie in one cell at 0.02 m, from there on in cells of their own
    assert worst[1] / worst[2] == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize("inset", [0.0025, 0.005, 0.01])
def test_a_grid_as_coarse_as_the_chamfer_depends_on_where_it_lies(inset):
    """Level set at a node ``inset`` from the ridge, as LS-DEM's outermost nodes; spacing = chamfer = h.

    Aligned, the cell's inner corner below the ridge sees the chamfer at h sqrt(1/2) before the flat at h, so that
    the level set falls by 1 - (1 - inset/h)(1 - sqrt(1/2)) a metre of depth. Shifted by half a cell,
    the outer corners are at h sqrt(1/2) and 0 where the flat's are at h/2 and -h/2: with the weight
    w = 1/2 - inset/h of that side the surface has sunk by w h sqrt(1/8), 1.8 mm at the usual inset of 5 mm.
    """
    h, depth = SPACING, 1e-5
    node = np.array([SIZE[0] / 2.0 - CHAMFER - inset, 0.0, SIZE[2] / 2.0 - depth])
    aligned, _ = _evaluate(node)
    slope = 1.0 - (1.0 - inset / h) * (1.0 - np.sqrt(0.5))
    assert aligned[0] == pytest.approx(-slope * depth, abs=ROUNDING)
    shifted, _ = _evaluate(node, grid_table([box_grid(SIZE, CHAMFER, h, (0.5, 0.0, 0.5))]))
    weight = 0.5 - inset / h
    sunk, slope = weight * h * np.sqrt(0.125), 1.0 - weight * (1.0 - np.sqrt(0.5))
    assert shifted[0] == pytest.approx(sunk - slope * depth, abs=ROUNDING)


def test_a_grid_finer_than_the_inset_does_not_depend_on_where_it_lies():
    """A lattice point at the depth d below a flat sees the chamfer first within (sqrt(2) - 1) d of the ridge.

    So no cell that holds a node at the inset sees it while spacing is below inset / sqrt(2): 3.5 mm for 5 mm.
    """
    size, spacing = np.array([0.21, 0.21, 0.21]), 0.005 / np.sqrt(2.0)
    node = size / 2.0 - [CHAMFER + 0.005, 0.1, 1e-5]
    for shift in np.linspace(0.0, 1.0, 21):
        phi, normal = _evaluate(node, grid_table([box_grid(size, CHAMFER, spacing, (shift, 0.0, 0.3))]))
        assert phi[0] == pytest.approx(-1e-5, abs=ROUNDING)
        np.testing.assert_allclose(normal[0], [0.0, 0.0, 1.0], atol=1e-9)


def test_a_mesh_of_a_box_gives_the_boxs_grid():
    solid = convex_polyhedron(box_vertices(SIZE, CHAMFER))
    mesh, box = mesh_grid(solid.vertices, triangles(solid), 0.1), box_grid(SIZE, CHAMFER, 0.1)
    np.testing.assert_allclose(mesh.origin, box.origin, atol=ROUNDING)
    np.testing.assert_allclose(mesh.values, box.values, atol=ROUNDING)


def test_a_sphere_converges_with_second_order_in_value_and_first_in_normal():
    """Bilinear interpolation of a smooth function; facets' error is of second order in their edges too."""
    rng = np.random.default_rng(7)
    directions = rng.normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    radius = 0.5 + (rng.random(2000) - 0.5) * 0.06  # within the finest grid's two cells
    values, normals = [], []
    for subdivisions, spacing in ((3, 0.08), (4, 0.04), (5, 0.02)):
        mesh = trimesh.creation.icosphere(subdivisions, 0.5)
        phi, normal = _evaluate(
            directions * radius[:, None], grid_table([mesh_grid(mesh.vertices, mesh.faces, spacing)])
        )
        values.append(np.abs(phi - (radius - 0.5)).max())
        normals.append(np.linalg.norm(normal - directions, axis=1).max())
    orders = np.log2(np.divide(values[:-1], values[1:]))
    assert (orders > 1.8).all()
    orders = np.log2(np.divide(normals[:-1], normals[1:]))
    assert (orders > 0.8).all()
    # the normal itself, not another one that converges
    assert normals[-1] < 0.1


def test_beyond_the_grid_phi_is_positive_and_at_most_the_true_distance():
    """So that a list of near nodes misses none."""
    rng = np.random.default_rng(8)
    points = (rng.random((4000, 3)) - 0.5) * (SIZE + 1.0)
    points[::10] *= 1e4
    low, high = TABLE.origin[0], -TABLE.origin[0]
    points = points[((points < low) | (points > high)).any(axis=1)]
    # the sharp box holds the chamfered one and is easily measured
    outside = np.maximum(np.abs(points) - SIZE / 2.0, 0.0)
    phi, normal = _evaluate(points)
    assert len(points) > 1000
    assert (phi > 0.0).all()
    assert (phi <= np.linalg.norm(outside, axis=1)).all()
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=ROUNDING)
    # not a useless bound: of use as soon as a skin is a few cells
    assert (phi >= outside.max(axis=1) - 3.0 * SPACING).all()


_NEAR = st.tuples(*[st.floats(-0.15, 0.15)] * 3)


@pytest.mark.parametrize("chamfer", [0.0, CHAMFER])
@given(corner=st.sampled_from([(1, 1, 1), (1, 0, 1), (0, 1, 0), (-1, 1, -1)]), start=_NEAR, step=_NEAR)
@settings(max_examples=300, deadline=None)
def test_a_node_outside_the_list_cannot_touch_before_the_skin_is_used_up(chamfer, corner, start, step):
    """A level set that changes by at most ``steepest`` times the distance moved, the grid's border included."""
    table = {0.0: SHARP, CHAMFER: TABLE}[chamfer]
    start = np.array(corner) * SIZE / 2.0 + start
    phi, _ = _evaluate([start, start + step], table)
    if phi[0] > 0.0 and phi[1] <= 0.0:
        assert phi[0] - phi[1] <= table.steepest[0] * np.linalg.norm(step) + ROUNDING


@pytest.mark.parametrize("table", [TABLE, SHARP], ids=["chamfered", "sharp"])
def test_steepest_is_the_largest_gradient_outside(table):
    """By differences next to a corner, where the interpolation is steeper than any distance."""
    assert 1.0 < table.steepest[0] <= np.sqrt(3.0) + ROUNDING
    corner = SIZE / 2.0
    cells = np.stack(np.meshgrid(*[np.arange(-3, 3)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    places = np.stack(np.meshgrid(*[[1e-4, 0.5, 1.0 - 1e-4]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    points = (corner + SPACING * (cells[:, None] + places[None]))[:, :, None].reshape(-1, 3)
    points = points[
        ((points >= corner - CHAMFER - ROUNDING) & (points < -TABLE.origin[0] - 1e-6)).all(axis=1)
    ]
    step = 1e-7
    gradient = np.column_stack(
        [_evaluate(points + step * axis, table)[0] - _evaluate(points, table)[0] for axis in np.eye(3)]
    )
    steepness = np.linalg.norm(gradient, axis=1).max() / step
    assert steepness == pytest.approx(table.steepest[0], rel=1e-3)


def test_a_table_holds_several_shapes_and_none():
    sphere = trimesh.creation.icosphere(3, 0.5)
    table = grid_table(
        [None, box_grid(SIZE, CHAMFER, 0.1), None, mesh_grid(sphere.vertices, sphere.faces, 0.05)]
    )
    points = (np.random.default_rng(11).random((100, 3)) - 0.5) * 1.5
    alone, _ = _evaluate(points, grid_table([mesh_grid(sphere.vertices, sphere.faces, 0.05)]))
    np.testing.assert_array_equal(_evaluate(points, table, 3)[0], alone)
    alone, _ = _evaluate(points, grid_table([box_grid(SIZE, CHAMFER, 0.1)]))
    np.testing.assert_array_equal(_evaluate(points, table, 1)[0], alone)
    assert table.counts[0].sum() == 0
    assert table.first[-1] == len(table.values)
