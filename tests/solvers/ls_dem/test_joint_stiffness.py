"""A joint is the integral of springs over the overlap of its two flats, wherever the bodies stand."""

import numpy as np
import pytest

from blockshake.dynamics.system import assemble_bodies
from blockshake.geometry.rotations import rotation_matrices
from blockshake.solvers.ls_dem.contact.candidates import empty_candidates, find_candidates
from blockshake.solvers.ls_dem.contact.contact_forces import forces_into, no_loads
from blockshake.solvers.ls_dem.contact.relative_pose import poses_at_rest
from blockshake.solvers.ls_dem.interfaces import assemble_interfaces
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.ls_dem.progress import no_joints
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces

DEPTH, LEAN = 1e-5, 1e-6  # m, rad; the face stays inside
# m; nodes of the slab are 0.2 m apart
PLACES = [(0.0, 0.0), (0.03, 0.0), (0.1, -0.05), (0.137, 0.211), (-0.2, 0.15)]

SHIFTS = [
    (0.0, 0.0),
    (0.0022, 0.0),
    (0.0062, -0.007),
    (0.051, 0.0203),
    (0.1, -0.2),
    (-0.137, 0.211),
    (0.251, 0.6013),
]


def wrench(structure, position, orientation, **parameters):
    """Force and moment of the contact on the second body, without gravity [N, N m]."""
    bodies, state, _ = assemble_bodies(structure)
    bodies = bodies._replace(gravity=np.zeros(3))
    parameters = LsDemParameters(**parameters)
    surfaces, interfaces = (make(structure, parameters) for make in (assemble_surfaces, assemble_interfaces))
    position, orientation = (np.array([state_of[0], own]) for state_of, own in (
        (state.position, position), (state.orientation, orientation),
    ))  # fmt: skip
    rotation = np.ascontiguousarray(rotation_matrices(orientation))
    poses = poses_at_rest(position, rotation)
    candidates, joints = find_candidates(
        surfaces, bodies.driven, poses, orientation, 0.01, empty_candidates(2), no_joints()
    )
    loads = no_loads(2, joints)
    forces_into(bodies, candidates, surfaces, interfaces, poses, 0.0, loads)
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


@pytest.mark.parametrize("yaw", [0.0, 0.01, 0.4, 1.3])
@pytest.mark.parametrize("shift", SHIFTS)
@pytest.mark.parametrize(("lower", "upper"), [("block", "block"), ("cube", "block"), ("block", "cube")])
def test_two_blocks_have_the_stiffness_and_moment_of_their_overlap(lower, upper, shift, yaw, make_structure):
    assert worst_miss(lower, upper, shift, yaw, make_structure)[0] < 0.02


def test_so_have_two_blocks_anywhere_with_enough_in_common(make_structure):
    """A hundred places drawn at random, straight and turned; the smallest overlaps have too few nodes."""
    generator = np.random.default_rng(1)
    found = []
    for count in range(100):
        lower, upper = ("block", "cube")[count % 2], ("block", "cube")[count // 2 % 2]
        yaw = 0.0 if count % 8 < 4 else generator.uniform(0.0, np.pi)
        shift = generator.uniform(-1.3, 1.3, 2) * np.array(FLATS[lower]) / 2.0
        # a fifth of a step next to a place of the raster: a lean of 1e-6 does not pass on to the next
        shift = (np.round(shift / RASTER) + 0.2) * RASTER
        if overlap(FLATS[lower], FLATS[upper], shift, yaw, cells=100)[0].size > 0:
            found.append(worst_miss(lower, upper, shift, yaw, make_structure))
    missed, area = np.array(found).T
    assert (area > 0.3).sum() > 80
    assert missed[area > 0.3].max() < 0.02
    assert missed.max() < 0.1
    assert np.median(missed) < 0.002
    assert (missed < 0.02).mean() > 0.95


@pytest.mark.parametrize("inset", [0.003, 0.001, 0.0005])
def test_edges_that_lie_flush_bear_however_near_the_nodes_are(inset, make_structure):
    """A cube that leans over the edge of a narrower block, with that edge below its own."""
    structure = make_structure(
        [
            {"name": "lower", "shape": "block", "position": [0.0, 0.0, 0.0]},
            {"name": "upper", "shape": "cube", "position": [0.0, 0.0, 2.0]},
        ],
        slab=False,
    )
    lean = 2e-4  # the second row of nodes is lifted by more than the edge sinks in
    position = [0.38 - 0.5 + 0.5 * lean, 0.0, 1.3 + 0.5 * lean - DEPTH]
    force, moment, k_n = wrench(structure, position, [1.0, 0.0, 0.5 * lean, 0.0], perimeter_inset=inset)
    assert force[2] > 0.01 * k_n * 0.76 * DEPTH
    assert 0.496 < -moment[1] / force[2] < 0.5  # m, from the cube's middle to its edge


FLATS, HEIGHTS = {"block": (0.76, 2.36), "cube": (1.0, 1.0)}, {"block": 1.6, "cube": 1.0}  # m
RASTER = 0.0008  # m, for a block of 0.8 m


def worst_miss(lower, upper, shift, yaw, make_structure):
    """For force and moments of two blocks, in shares of those of springs over the overlap; the overlap's area [m2]."""
    structure = make_structure(
        [
            {"name": "lower", "shape": lower, "position": [0.0, 0.0, 0.0]},
            {"name": "upper", "shape": upper, "position": [0.0, 0.0, 2.0]},
        ],
        slab=False,
    )
    upright = np.array([np.cos(0.5 * yaw), 0.0, 0.0, np.sin(0.5 * yaw)])
    position = [*shift, 0.5 * (HEIGHTS[lower] + HEIGHTS[upper]) - DEPTH]
    x, y, cell = overlap(FLATS[lower], FLATS[upper], shift, yaw)
    area = x.size * cell
    force, moment, k_n = wrench(structure, position, upright)
    arm = np.array([y.sum(), -x.sum()]) * cell * k_n * DEPTH
    core = k_n * area * DEPTH * np.sqrt(area) / 6.0  # of a square, where an edge would open
    misses = [abs(force[2] / (k_n * area * DEPTH) - 1.0), np.abs(moment[:2] - arm).max() / core]
    for axis in range(2):
        lean = np.array([1.0, 0.0, 0.0, 0.0])
        lean[1 + axis] = 0.5 * LEAN
        _, leaning, _ = wrench(structure, position, product(lean, upright))
        sink = -y * LEAN if axis == 0 else x * LEAN
        expected = np.array([(y * sink).sum(), -(x * sink).sum()]) * cell * k_n
        misses.append(np.abs((leaning - moment)[:2] - expected).max() / np.linalg.norm(expected))
    return max(misses), area


def overlap(lower, upper, shift, yaw, cells=800):
    """Places of a fine raster on the overlap of two flats, from the upper's middle [m], and the area of each [m2]."""
    widths = [width / cells for width in upper]
    p, q = np.meshgrid(*[(np.arange(cells) + 0.5) * width - 0.5 * cells * width for width in widths])
    x, y = np.cos(yaw) * p - np.sin(yaw) * q, np.sin(yaw) * p + np.cos(yaw) * q
    inside = (np.abs(x + shift[0]) <= 0.5 * lower[0]) & (np.abs(y + shift[1]) <= 0.5 * lower[1])
    return x[inside], y[inside], widths[0] * widths[1]


def product(one, other):
    """Quaternion of a turn by ``other`` in the frame that ``one`` turned."""
    w, v, u, s = one[0], one[1:], other[1:], other[0]
    return np.concatenate([[w * s - v @ u], w * u + s * v + np.cross(v, u)])
