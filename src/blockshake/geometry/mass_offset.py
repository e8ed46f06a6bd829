"""A mass centre away from the centroid of the shape: the shape about it, and the inertia it leaves."""

import dataclasses

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.meshes.mesh_file import shown


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
