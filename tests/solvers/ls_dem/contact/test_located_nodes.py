"""Packets of located nodes: the same bits as the level set of one place, by vector instructions."""

import re

import numba
import numpy as np
import pytest

from blockshake import jit
from blockshake.jit import kernel
from blockshake.solvers.ls_dem.contact import located_nodes
from blockshake.solvers.ls_dem.contact.located_nodes import locate_nodes_into
from blockshake.solvers.ls_dem.contact.packets import (
    AREA,
    FACTOR,
    LANES,
    NORMAL,
    PHI,
    PLACE,
    POINT,
    Span,
    no_packets,
)
from blockshake.solvers.ls_dem.parameters import LsDemParameters
from blockshake.solvers.ls_dem.surfaces import assemble_surfaces, level_set

# compiled
level_set = kernel(level_set)
locate_nodes_into = kernel(locate_nodes_into)

N_PACKETS = 50
UNTURNED = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)


@pytest.fixture(scope="module", params=["exact", "grid", "planes"])
def surfaces(request, make_structure):
    structure = make_structure([{"name": "b", "shape": "block", "position": [0.0, 0.0, 0.8]}])
    if request.param != "planes":
        return assemble_surfaces(structure, LsDemParameters(level_set=request.param))
    # the box as a convex mesh of its 18 faces and 8 corners
    surfaces, solid = assemble_surfaces(structure, LsDemParameters()), structure.solids["block"].polyhedron
    planes, own = np.column_stack([solid.normals, solid.offsets]), int(surfaces.shape[1])
    first = np.where(np.arange(len(surfaces.first_plane)) > own, len(planes), 0)
    return surfaces._replace(planes=planes, first_plane=first)


@kernel
def _level_sets(surfaces, shape, points):
    return np.array([level_set(surfaces, shape, p[0], p[1], p[2]) for p in points])


def test_packets_give_the_bits_of_single_places(surfaces):
    rng = np.random.default_rng(10)
    points = (rng.random((N_PACKETS * LANES, 3)) - 0.5) * np.array([1.1, 2.7, 1.9])
    points[::7] = 1e6  # filling of a packet
    packets = no_packets(N_PACKETS, N_PACKETS, N_PACKETS)
    rows, found = (table.reshape(N_PACKETS, -1, LANES) for table in (packets.alike, packets.located))
    first = POINT // LANES
    rows[:, first : first + 3] = points.reshape(N_PACKETS, LANES, 3).transpose(0, 2, 1)
    rows[:, AREA // LANES] = 2.0
    packets.kept[:, FACTOR : FACTOR + LANES] = 0.25
    shape = int(surfaces.shape[1])
    area, woke = locate_nodes_into(packets, Span(0, N_PACKETS, 0, 0), surfaces, shape, UNTURNED)
    expected = _level_sets(surfaces, shape, points)
    np.testing.assert_array_equal(found[:, PHI // LANES].ravel(), expected)
    assert area == 0.5 * (expected < 0.0).sum()
    assert woke
    first = PLACE // LANES
    np.testing.assert_array_equal(found[:, first : first + 3].transpose(0, 2, 1).reshape(-1, 3), points)
    # the gradient of the distance is a unit vector, and central differences of it
    first = NORMAL // LANES
    normal = found[:, first : first + 3].transpose(0, 2, 1).reshape(-1, 3)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, rtol=1e-12)
    near = np.abs(expected) < 0.015  # beyond the lattice there is a bound only
    step = 1e-6
    slope = np.column_stack(
        [
            _level_sets(surfaces, shape, points[near] + step * axis)
            - _level_sets(surfaces, shape, points[near] - step * axis)
            for axis in np.eye(3)
        ]
    ) / (2.0 * step)
    agrees = (slope * normal[near]).sum(axis=1) / np.linalg.norm(slope, axis=1)
    # but where a ridge lies within a micrometre
    assert (agrees > 1.0 - 1e-6).mean() > 0.99


@pytest.mark.parametrize("name", ["_locate_in_box_into", "_locate_in_lattice_into"])
def test_packets_become_vector_instructions(surfaces, name):
    """Products of several doubles at once, on any 64-bit processor."""
    fresh = numba.njit(error_model="numpy", pipeline_class=jit._compiler(jit._Whole, noalias=True))(
        getattr(located_nodes, name)
    )
    table = (surfaces.half, surfaces.chamfer)
    if name == "_locate_in_lattice_into":
        table = (surfaces.lattice, surfaces.values)
    fresh(no_packets(1, 1, 1), Span(0, 0, 0, 0), *table, 0, UNTURNED)
    products = re.findall(r"fmul .*<(\d+) x double>", next(iter(fresh.inspect_llvm().values())))
    assert len(products) >= 9  # those of the turn into the other frame at least
