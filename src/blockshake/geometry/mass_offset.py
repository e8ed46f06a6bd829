"""Mass that is not even: a mass centre away from the centroid of the shape, and the inertia, left by it or stated."""

import dataclasses

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.meshes.mesh_file import shown

_OF_MOMENTS = 1e-9  # by which typed moments may be off


def check_offset(body, solid, source):
    """Refuse a mass centre where no distribution of mass within the shape can have it.

    ``body`` (Body) is the structure file's, ``solid`` (Solid) its shape about the centroid.

    Raises
    ------
    InputError
        The body is driven, the offset lies outside the shape's bounding box, or it takes all of the second moment
        about the centroid along some direction: no inertia would be left about it.
    """
    offset = np.array(body.mass_offset)
    if not offset.any():
        return
    key = f"bodies.{body.name}.mass_offset"
    if body.driven:
        raise InputError(
            source, key, "expected none of a driven body: it follows the motion whatever its mass"
        )
    low, high = solid.vertices.min(axis=0), solid.vertices.max(axis=0)
    if not ((low < offset) & (offset < high)).all():
        raise InputError(
            source, key, f"expected a mass centre within the shape's box, {shown(low)} to {shown(high)} m"
        )
    inertia = solid.properties.inertia / solid.properties.volume
    moment = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    if not offset @ np.linalg.solve(moment, offset) < 1.0:
        reach = np.sqrt(np.diag(moment))
        raise InputError(
            source,
            key,
            f"expected a mass centre within the shape's radii of gyration, {shown(reach)} m along x, y, z",
        )


def offset_solid(solid, offset):
    """A shape about a mass centre that lies at ``offset`` from its centroid [m]; its properties stay the centroid's."""
    polyhedron = solid.polyhedron
    if polyhedron is not None:
        polyhedron = dataclasses.replace(
            polyhedron,
            vertices=polyhedron.vertices - offset,
            offsets=polyhedron.offsets - polyhedron.normals @ offset,
        )
    return dataclasses.replace(solid, vertices=solid.vertices - offset, polyhedron=polyhedron)


def offset_inertia(mass, inertia, offset):
    """Inertia about a mass centre that lies at ``offset`` (3,) from the centroid: float64 array, shape (3, 3) [kg m2].

    ``mass`` [kg]; ``inertia`` (3, 3): about the centroid at uniform density, body axes [kg m2]; body frame [m].

    Notes
    -----
    A density that varies linearly across a shape with mirror symmetry leaves the second moment about the centroid as
    it is, since the third moments vanish. The parallel-axis theorem then takes ``m (|e|^2 1 - e e^T)`` off.
    """
    return inertia - mass * (offset @ offset * np.eye(3) - np.outer(offset, offset))


def stated_inertia(body, mass, solid, source):
    """Inertia that the structure file states of a body: float64 array, shape (3, 3), body frame [kg m2].

    ``mass`` [kg]; ``solid`` (Solid) is the body's about the mass centre, ``body`` (Body) the structure file's. A driven
    body is refused by `InputError`, and so is what no mass within the shape has: half the sum of the principal moments
    is the mass times the mean square of its distance from the mass centre.
    """
    key = f"bodies.{body.name}.inertia"
    if body.driven:
        raise InputError(
            source, key, "expected none of a driven body: it follows the motion whatever its mass"
        )
    xx, yy, zz, xy, xz, yz = (*body.inertia, 0.0, 0.0, 0.0)[:6]
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    moments = np.linalg.eigvalsh(tensor)
    if not (moments[0] > 0.0 and moments[2] <= (1.0 + _OF_MOMENTS) * (moments[0] + moments[1])):
        expected = f"positive principal moments, none above the sum of the others, not {shown(moments)} kg m2"
        raise InputError(source, key, f"expected {expected}")
    most = mass * (solid.vertices**2).sum(axis=1).max()
    if not 0.5 * moments.sum() <= (1.0 + _OF_MOMENTS) * most:
        expected = f"moments with a sum of at most {2.0 * most:.3g} kg m2, as of {mass:.3g} kg at the farthest vertex"
        raise InputError(source, key, f"expected {expected}, not {moments.sum():.3g}")
    return tensor
