"""The mass centre off the centroid: surface and sensors stay, inertia follows, impossible ones are refused."""

import numpy as np
import pytest

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.sensors.markers import marker_position

HALF = np.array([0.4, 1.2, 0.8])
TURNED = {"position": [0.3, -0.2, 5.0], "orientation": [0.8, 0.0, 0.6, 0.0]}
SENSOR = {"body": "b", "position": [0.4, 0.3, -0.8]}


def _block(make_structure, offset, shape="block", **keys):
    body = {"name": "b", "shape": shape, **TURNED, **keys}
    sensors = {
        "markers": [{"name": "m", **SENSOR}],
        "accelerometers": [{"name": "a", **SENSOR, "axes": ["x"]}],
        "stoppers": [{**SENSOR, "axis": "+x", "gap": 0.0, "stiffness": 1.0}],
    }
    return make_structure([{**body, "mass_offset": list(offset)}], **sensors)


def _world(structure):
    return structure.position[1] + structure.solid(1).vertices @ rotation_matrices(structure.orientation[1]).T


def test_surface_and_sensors_stay_where_they_were(make_structure):
    offset = (0.1, -0.2, 0.3)
    plain, moved = (_block(make_structure, one) for one in ((0.0, 0.0, 0.0), offset))
    turn = rotation_matrices(plain.orientation[1])
    np.testing.assert_allclose(moved.position[1], plain.position[1] + turn @ offset, atol=1e-15)
    np.testing.assert_array_equal(moved.centroid, plain.centroid)
    np.testing.assert_allclose(_world(moved), _world(plain), atol=1e-15)
    faces = moved.solid(1).polyhedron
    np.testing.assert_allclose((faces.normals @ faces.vertices.T).max(axis=1), faces.offsets, atol=1e-15)
    places = [marker_position(one, one.position, one.orientation) for one in (plain, moved)]
    np.testing.assert_allclose(places[1], places[0], atol=1e-15)
    for points in ("markers", "accelerometers", "stoppers"):
        np.testing.assert_allclose(
            moved.arms(getattr(moved.file, points)), [np.subtract(SENSOR["position"], offset)], atol=1e-15
        )


def test_velocity_is_that_of_the_mass_centre(make_structure):
    spin, speed, offset = np.array([0.1, 0.2, -0.3]), np.array([1.0, 2.0, 3.0]), np.array([0.1, -0.2, 0.3])
    structure = _block(make_structure, offset, velocity=speed.tolist(), angular_velocity=spin.tolist())
    lever = rotation_matrices(structure.orientation[1]) @ offset
    np.testing.assert_allclose(structure.velocity[1], speed + np.cross(spin, lever), atol=1e-15)


def test_inertia_is_that_of_a_density_that_grows_along_the_block(make_structure):
    """Gauss's rule, exact for these cubics: density ``rho (1 + g . x)`` over a sharp box."""
    slope = np.array([0.5, -0.2, 0.3])
    node, weight = np.polynomial.legendre.leggauss(4)
    x = np.stack(np.meshgrid(*(half * node for half in HALF), indexing="ij"), axis=-1).reshape(-1, 3)
    dm = 2400.0 * HALF.prod() * np.einsum("i,j,k->ijk", weight, weight, weight).ravel() * (1.0 + x @ slope)
    offset = dm @ x / dm.sum()
    arm = x - offset
    inertia = np.einsum("p,pij->ij", dm, (arm**2).sum(axis=1)[:, None, None] * np.eye(3)) - np.einsum(
        "p,pi,pj->ij", dm, arm, arm
    )
    structure = _block(make_structure, offset, shape="sharp")
    assert structure.mass[1] == pytest.approx(dm.sum(), rel=1e-12)
    np.testing.assert_allclose(structure.inertia[1], inertia, atol=1e-12 * np.trace(inertia))


@pytest.mark.parametrize("offset", [(0.41, 0.0, 0.0), (0.0, -1.3, 0.0), (0.24, 0.0, 0.0), (0.15, 0.45, 0.3)])
def test_what_no_distribution_of_mass_can_have_is_refused(offset, make_structure):
    """Outside the box, or beyond the radii of gyration, 0.231, 0.693 and 0.462 m."""
    with pytest.raises(InputError, match=r"bodies.b.mass_offset: expected a mass centre within"):
        _block(make_structure, offset, shape="sharp")


def test_a_driven_body_has_none(make_mapping, make_structure):
    slab = {
        "name": "slab",
        "shape": "slab",
        "position": [0.0, 0.0, -0.1],
        "driven": True,
        "mass_offset": [0.1, 0, 0],
    }
    with pytest.raises(InputError, match=r"bodies.slab.mass_offset: expected none of a driven body"):
        make_structure([slab], slab=False)


@pytest.mark.parametrize(
    ("elements", "tensor"),
    [
        ([9e3, 4e3, 8e3], np.diag([9e3, 4e3, 8e3])),
        ([9e3, 4e3, 8e3, 100.0, -200.0, 300.0], [[9e3, 100, -200], [100, 4e3, 300], [-200, 300, 8e3]]),
    ],
)
def test_a_stated_inertia_is_that_about_the_mass_centre(elements, tensor, make_structure):
    structure = _block(make_structure, (0.1, 0.0, 0.0), inertia=elements)
    np.testing.assert_array_equal(structure.inertia[1], tensor)
    twice = structure.with_parameters({"bodies.b.inertia": [2e3, 2e3, 2e3]})
    np.testing.assert_array_equal(twice.inertia[1], 2e3 * np.eye(3))


def test_a_structure_without_a_stated_inertia_has_its_old_digest(make_structure):
    assert "inertia" not in _block(make_structure, (0.0, 0.0, 0.0)).file.model_dump_json()


@pytest.mark.parametrize(
    ("elements", "expected"),
    [
        ([1e3, 1e3, 2.1e3], "none above the sum of the others"),
        ([1e3, 1e3, -1.0], "positive principal moments"),
        ([1e3, 1e3, 1e3, 0.0, 1.1e3, 0.0], "positive principal moments"),
        ([1e8, 1e8, 1e8], "at the farthest vertex"),
        ([1e3, 1e3], "three or six numbers"),
    ],
)
def test_an_inertia_of_no_mass_is_refused(elements, expected, make_structure):
    """A lamina has the sum of two moments as the third one; a product beyond the moments has a negative root."""
    with pytest.raises(InputError, match=rf"bodies.b.inertia: .*{expected}"):
        _block(make_structure, (0.0, 0.0, 0.0), inertia=elements)


def test_a_driven_body_has_no_inertia(make_structure):
    slab = {
        "name": "slab", "shape": "slab", "position": [0.0, 0.0, -0.1], "driven": True, "inertia": [1e3] * 3,
    }  # fmt: skip
    with pytest.raises(InputError, match=r"bodies.slab.inertia: expected none of a driven body"):
        make_structure([slab], slab=False)
