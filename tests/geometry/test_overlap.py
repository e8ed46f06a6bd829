import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from blockshake.geometry.overlap import penetration_depth
from blockshake.geometry.polyhedron import box_vertices, convex_polyhedron, mass_properties, triangles
from blockshake.geometry.structure import Solid

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
ROUNDING = 1e-9  # m; edge directions are kept to nine digits


def _solid(size, chamfer=0.0):
    polyhedron = convex_polyhedron(box_vertices(size, chamfer))
    faces = triangles(polyhedron)
    return Solid(polyhedron.vertices, faces, polyhedron, mass_properties(polyhedron.vertices, faces))


CUBE = _solid([1.0, 1.0, 1.0])


def _turned(axis, degrees):
    return Rotation.from_rotvec(np.radians(degrees) * np.asarray(axis, float)).as_quat(scalar_first=True)


@pytest.mark.parametrize("gap", [-0.2, -1e-3, 0.0, 1e-4, 0.3])
def test_faces_parallel(gap):
    depth = penetration_depth(CUBE, np.zeros(3), UPRIGHT, CUBE, np.array([0.1, 0.2, 1.0 + gap]), UPRIGHT)
    assert depth == pytest.approx(-gap, abs=ROUNDING)


@pytest.mark.parametrize("gap", [-0.01, 0.02])
def test_an_edge_above_a_face(gap):
    """A cube turned by 45 degrees about y reaches sqrt(1/2) below its centre."""
    position = np.array([0.05, 0.0, 0.5 + np.sqrt(0.5) + gap])
    depth = penetration_depth(CUBE, np.zeros(3), UPRIGHT, CUBE, position, _turned([0, 1, 0], 45.0))
    assert depth == pytest.approx(-gap, abs=ROUNDING)


@pytest.mark.parametrize("gap", [-0.01, 0.02])
def test_two_crossed_edges(gap):
    """Upper edge along x of one, lower edge along y of the other: only the cross product separates."""
    position = np.array([0.0, 0.0, 2.0 * np.sqrt(0.5) + gap])
    depth = penetration_depth(
        CUBE, np.zeros(3), _turned([1, 0, 0], 45.0), CUBE, position, _turned([0, 1, 0], 45.0)
    )
    assert depth == pytest.approx(-gap, abs=ROUNDING)


def test_order_frame_and_distance_do_not_matter():
    block = _solid([0.8, 2.4, 1.6], 0.02)
    rotation = Rotation.from_rotvec([0.3, -0.2, 0.5])
    offset = np.array([0.9, 0.2, 0.9])
    plain = penetration_depth(CUBE, np.zeros(3), UPRIGHT, block, offset, UPRIGHT)
    turned = rotation.as_quat(scalar_first=True)
    moved = penetration_depth(CUBE, np.ones(3), turned, block, np.ones(3) + rotation.apply(offset), turned)
    swapped = penetration_depth(block, offset, UPRIGHT, CUBE, np.zeros(3), UPRIGHT)
    assert moved == pytest.approx(plain, abs=ROUNDING)
    assert swapped == pytest.approx(plain, abs=ROUNDING)


def test_far_apart_is_a_lower_bound_of_the_clearance():
    depth = penetration_depth(CUBE, np.zeros(3), UPRIGHT, CUBE, np.array([10.0, 0.0, 0.0]), UPRIGHT)
    assert -9.0 <= depth < -8.0
