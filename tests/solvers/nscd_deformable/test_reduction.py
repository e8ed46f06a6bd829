"""Static answers of the reduced block, stresses and Poisson's effect, against the full mesh and theory."""

import numpy as np
import pytest

from blockshake.solvers.nscd_deformable.box_mesh import (
    assemble,
    box_mesh,
    corner_gradients,
    elasticity_matrix,
    rigid_motions,
    strain_matrix,
)
from blockshake.solvers.nscd_deformable.shapes import elastic_shapes, surface_lattice

SIZE = (0.8, 2.4, 1.6)


def _balanced_loads(mesh, lattice, seed):
    """Random forces on the lattice's nodes, less what would move the block as a whole."""
    forces = np.zeros((len(mesh.nodes), 3))
    forces[lattice.nodes] = np.random.default_rng(seed).normal(size=(len(lattice.nodes), 3))
    at_lattice = np.repeat(np.isin(np.arange(len(mesh.nodes)), lattice.nodes), 3)
    rigid = rigid_motions(mesh) * at_lattice[:, None]
    return forces.ravel() - rigid @ np.linalg.solve(rigid.T @ rigid, rigid.T @ forces.ravel())


def _face_loads(mesh, axis):
    """Consistent nodal forces of a pressure of 1 on both faces across an axis."""
    forces = np.zeros((len(mesh.nodes), 3))
    one, other = (axis + 1) % 3, (axis + 2) % 3
    areas = np.ones(len(mesh.nodes))
    for along in (one, other):
        x = mesh.nodes[:, along]
        edge = mesh.size[along] / mesh.counts[along]
        areas = areas * np.where(np.isclose(np.abs(x), mesh.size[along] / 2.0), 0.5, 1.0) * edge
    for side in (-1.0, 1.0):
        at = np.isclose(mesh.nodes[:, axis], side * mesh.size[axis] / 2.0)
        forces[at, axis] = -side * areas[at]
    return forces.ravel()


def test_shapes_are_orthogonal_to_rigid_motions_and_to_each_other():
    shapes = elastic_shapes(SIZE, 0.2, 0.4, 0.8, 5)
    K, M = assemble(shapes.mesh, 0.2)
    u = shapes.displacement
    assert np.abs(rigid_motions(shapes.mesh).T @ (M @ u)).max() < 1e-9
    assert u.T @ (M @ u) == pytest.approx(np.eye(u.shape[1]), abs=1e-8)
    assert u.T @ (K @ u) == pytest.approx(np.diag(shapes.squared_frequency), abs=1e-7)


def test_shapes_have_the_same_bytes_whenever_they_are_made():
    """The search for these two modes goes on from a random vector."""
    made = [elastic_shapes.__wrapped__((0.8, 1.2, 1.6), 0.2, 0.2, 0.6, 2).displacement for _ in range(3)]
    assert len({displacement.tobytes() for displacement in made}) == 1


def test_balanced_forces_on_all_nodes_of_the_faces_are_answered_exactly():
    """The static answer of the reduced block is the full mesh's to rounding."""
    shapes = elastic_shapes(SIZE, 0.2, 0.4, 0.4, 0)
    K, _ = assemble(shapes.mesh, 0.2)
    load, u = _balanced_loads(shapes.mesh, shapes.lattice, 1), shapes.displacement
    answer = u @ ((u.T @ load) / shapes.squared_frequency)
    assert K @ answer == pytest.approx(load, abs=1e-8 * np.abs(load).max())


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_uniform_pressure_gives_hookes_shortening_and_poissons_swelling(axis):
    """On two opposite faces: strain -1/E along it and nu/E across, stress -1 everywhere, to rounding."""
    nu = 0.2
    shapes = elastic_shapes(SIZE, nu, 0.4, 0.8, 0)
    mesh, u = shapes.mesh, shapes.displacement
    answer = u @ ((u.T @ _face_loads(mesh, axis)) / shapes.squared_frequency)
    expected = mesh.nodes * np.where(np.arange(3) == axis, -1.0, nu)
    assert answer.reshape(-1, 3) == pytest.approx(expected, abs=1e-8)
    B = strain_matrix(corner_gradients(np.array([0.3, -0.2, 0.1]), mesh.size / mesh.counts))
    for brick in mesh.bricks()[::7]:
        stress = elasticity_matrix(nu) @ B @ answer.reshape(-1, 3)[brick].ravel()
        assert stress == pytest.approx(-1.0 * (np.arange(6) == axis), abs=1e-7)


def test_rigid_motions_have_no_strain_energy():
    mesh = box_mesh((1.0, 0.6, 0.8), 0.2)
    K, M = assemble(mesh, 0.3)
    rigid = rigid_motions(mesh)
    assert np.abs(K @ rigid).max() < 1e-12
    assert (rigid.T @ (M @ rigid))[:3, :3] == pytest.approx(0.48 * np.eye(3))
    inertia = 0.48 / 12.0 * np.array([0.6**2 + 0.8**2, 1.0 + 0.8**2, 1.0 + 0.6**2])
    # trilinear bricks integrate the squares of coordinates exactly
    assert (rigid.T @ (M @ rigid))[3:, 3:] == pytest.approx(np.diag(inertia))


@pytest.mark.parametrize("spacing", [0.2, 0.4, 0.5, 0.8, 10.0])
def test_the_lattice_is_its_own_mirror_image(spacing):
    """Five bricks along an edge have no plane in the middle: a lattice on one with it would lean the block."""
    size = (1.0, 0.6, 0.8)
    for planes, edge in zip(surface_lattice(box_mesh(size, 0.2), spacing).lines, size, strict=True):
        assert planes == pytest.approx(-planes[::-1], abs=1e-12)
        assert planes[-1] - planes[0] == pytest.approx(edge)


@pytest.mark.parametrize("spacing", [0.2, 0.4, 0.8, 10.0])
def test_nodes_between_follow_a_linear_displacement_of_the_lattice(spacing):
    mesh = box_mesh(SIZE, 0.2)
    lattice = surface_lattice(mesh, spacing)
    assert lattice.bilinear.min() >= 0.0
    assert lattice.bilinear @ mesh.nodes[lattice.nodes] == pytest.approx(
        mesh.nodes[lattice.surface], abs=1e-12
    )
