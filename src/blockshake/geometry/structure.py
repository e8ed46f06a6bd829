"""A structure as the solvers need it: checked file, shapes, mass properties, start state."""

import copy
from collections.abc import Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from blockshake.errors import InputError
from blockshake.files import AnyPath, content_digest, load_yaml, named_file
from blockshake.geometry.cylinder import prism_vertices
from blockshake.geometry.laying import laid, spread
from blockshake.geometry.mass_offset import check_offset, offset_inertia, offset_solid, stated_inertia
from blockshake.geometry.meshes.mesh_file import read_mesh
from blockshake.geometry.overlap import depths_of_pairs, near_pairs
from blockshake.geometry.polyhedron import (
    MassProperties,
    Polyhedron,
    box_vertices,
    convex_polyhedron,
    mass_properties,
    triangles,
)
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.schema import StructureFile
from blockshake.geometry.structure_file import (
    check_names,
    check_points,
    check_transducers,
    friction_matrix,
    replace_into,
    unit_quaternions,
)
from blockshake.tables.shown import Shown
from blockshake.validation import validated

DEEPEST_OVERLAP = 1e-3  # m; deeper is a wrong structure, not an initial penetration
_ROUNDING = 1e-9  # m, of places typed to the millimetre
# m; an equilibrium of elastic or shrunk contacts within this of the given poses is the start of a run, and bodies
# nearer than this touch
START_TOLERANCE = 1e-4


@dataclass(frozen=True)
class Solid:
    """A shape about the mass centre: its centroid, but for a body whose mass is offset."""

    # vertices, triangles: float64 (n, 3), int64 (m, 3); closed outward surface, body frame [m]
    vertices: np.ndarray
    triangles: np.ndarray
    polyhedron: Polyhedron | None  # the same as a convex body; None where the shape is not convex
    properties: MassProperties  # of unit density, about the centroid


@dataclass(frozen=True, repr=False)
class Structure(Shown):
    """A checked structure with what follows from its geometry."""

    # the file's content, parameters applied. Its positions count from the centroids of the shapes; those of
    # the structure, which differ where mass is offset, from the mass centres
    file: StructureFile
    source: str  # name or path it came from
    folder: Path  # where its meshes lie
    solids: dict[str, Solid]  # by shape name, about the centroid
    mass: np.ndarray  # float64 (n_bodies,); of the true chamfered shape [kg]
    inertia: np.ndarray  # float64 (n_bodies, 3, 3); about the mass centre, body axes [kg m2]
    driven: np.ndarray  # bool (n_bodies,); bodies that follow the motion
    # position, velocity, angular_velocity: float64 (n_bodies, 3); of the mass centres at the start, world
    # frame [m, m/s, rad/s]
    position: np.ndarray
    # float64 (n_bodies, 4); at the start, unit quaternions (w, x, y, z), body to world
    orientation: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    # float64 (n_bodies, n_bodies); Coulomb's coefficient of each pair of bodies [1]; NaN between driven
    # bodies
    friction: np.ndarray
    touching: np.ndarray  # bool (n_bodies, n_bodies); pairs nearer than 0.1 mm at the start

    def _words(self):
        free = self.mass[~self.driven]
        return (
            f"{self.file.name}: {len(free)} blocks of {free.sum():.4g} kg in all, {self.driven.sum()} driven"
        )

    def _rows(self):
        yield "body", "shape", "material", "mass [kg]", "mass centre [m]", "driven"
        for body, mass, centre in zip(self.file.bodies, self.mass, self.position, strict=True):
            place = ", ".join(f"{along:g}" for along in centre)
            yield body.name, body.shape, body.material, f"{mass:.4g}", place, "yes" if body.driven else ""

    @property
    def body_names(self) -> list[str]:
        """Names of the bodies, in file order."""
        return [body.name for body in self.file.bodies]

    @property
    def mass_offset(self):
        """Mass centres seen from the centroids of the shapes: float64 array, shape (n_bodies, 3), body frames [m]."""
        return np.array([body.mass_offset for body in self.file.bodies])

    @property
    def centroid(self):
        """Centroids of the shapes at the start: float64 array, shape (n_bodies, 3), world frame [m]."""
        return np.array([body.position for body in self.file.bodies])

    def with_parameters(self, parameters: Mapping[str, Any] | None) -> "Structure":
        """The same structure with other values by dotted name, as of `load_structure`; its file is not read again.

        Raises
        ------
        InputError
            A parameter that the structure does not have, or a bad value.
        """
        if not parameters:
            return self
        mapping = self.file.model_dump(mode="json")
        with _keys_as_given(mapping, parameters, self.source):
            return self.with_mapping(mapping)

    def with_mapping(self, mapping):
        """Structure of another mapping of a structure file; solids of shapes that it keeps are taken over."""
        known = {name: (shape, self.solids[name]) for name, shape in self.file.shapes.items()}
        return build_structure(mapping, self.source, self.folder, known)

    @property
    def content(self):
        """Digest of the content: equal for equal structures, whatever they and their files are called."""
        without = {"name": True, "description": True, "shapes": {"__all__": {"mesh"}}}
        solids = (self.solids[name].vertices.tobytes() for name in sorted(self.solids))
        return content_digest(self.file.model_dump(mode="json", exclude=without), *solids)

    @property
    def digest(self):
        """Twelve hexadecimal digits of the file's content with its names, and of the solids of meshes."""
        solids = (solid.vertices.tobytes() for solid in self.solids.values())
        return content_digest(self.file.model_dump(mode="json"), *solids)

    def solid(self, body):
        """Solid of the body with this index, about its mass centre."""
        entry = self.file.bodies[body]
        return offset_solid(self.solids[entry.shape], np.array(entry.mass_offset))

    def carriers(self, points):
        """Bodies of markers, accelerometers, stoppers and the like: int64 array, shape (n_points,)."""
        names = self.body_names
        return np.array([names.index(point.body) for point in points], dtype=np.int64)

    def arms(self, points):
        """Places seen from the mass centres of their bodies: float64 array, shape (n_points, 3), body frames [m]."""
        positions = np.array([point.position for point in points], dtype=float).reshape(-1, 3)
        return positions - self.mass_offset[self.carriers(points)]


# a name, a path, what a file holds, or a structure
StructureSource = AnyPath | Mapping[str, Any] | Structure


def load_structure(source: StructureSource, parameters: Mapping[str, Any] | None = None) -> Structure:
    """Structure from a shipped name, a YAML file or a mapping, or a loaded one with other parameters.

    Parameters
    ----------
    source : str, path, mapping or Structure
        ``configuration-1`` to ``configuration-4``, a file, or what a file holds, as dictionaries and lists; what is
        loaded is not read again. Meshes of a mapping are paths.
    parameters : dict of str to value, optional
        Values by dotted name that replace the file's, such as
        ``{"friction.concrete.concrete": 0.6, "materials.concrete.density": 2350.0}``.

    Returns
    -------
    Structure

    Raises
    ------
    InputError
        Unknown key, missing friction pair, overlapping bodies, open mesh and the like.

    Examples
    --------
    >>> import blockshake
    >>> blockshake.load_structure("configuration-1", {"materials.concrete.density": 2300.0})
    <Structure configuration-1: 3 blocks of 2.117e+04 kg in all, 1 driven>
    """
    if isinstance(source, Structure):
        return source.with_parameters(parameters)
    if isinstance(source, Mapping):
        mapping, where, folder = copy.deepcopy(dict(source)), "structure", Path()
    else:
        path = named_file("structures", source)
        mapping, where, folder = _own_part(load_yaml(path)), str(source), path.parent
    mapping = spread(mapping, where)
    with _keys_as_given(mapping, parameters or {}, where):
        return build_structure(mapping, where, folder)


def _own_part(mapping):
    """The structure that a study's file holds, named as the study; another mapping as it is."""
    if "cases" in mapping and isinstance(mapping.get("structure"), dict):
        return {"name": mapping.get("name"), **mapping["structure"]}
    return mapping


@contextmanager
def _keys_as_given(mapping, parameters, source):
    """Set parameters in a mapping; a refusal of one inside names its key as it was given."""
    given = {replace_into(mapping, key, value, source): key for key, value in parameters.items()}
    try:
        yield
    except InputError as error:
        if error.key in given:
            raise InputError(error.where, given[error.key], error.expected) from None
        raise


def build_structure(mapping, source, folder, known=None):
    """Structure from the mapping of a structure file.

    Parameters
    ----------
    mapping : dict
    source : str
        To name in an error.
    folder : str or path
        Where its meshes lie.
    known : dict of str to (Shape, Solid), optional
        Solids by the name of their shape: one that has not changed is taken over.
    """
    file = validated(StructureFile, spread(mapping, source), source)
    check_names(file, source)
    solids = {}
    for name, shape in file.shapes.items():
        before, solid = (known or {}).get(name, (None, None))
        solids[name] = solid if shape == before else _solid(name, shape, source, folder)
    for body in file.bodies:
        check_offset(body, solids[body.shape], source)
    mass, inertia = _masses(file, solids, source)
    orientation = unit_quaternions(file, source)
    file = laid(file, solids, orientation, source)
    centroid = np.array([body.position for body in file.bodies])
    check_transducers(file, orientation, source)
    check_points(file, solids, source)
    offset = np.array([body.mass_offset for body in file.bodies])
    lever = np.einsum("bij,bj->bi", rotation_matrices(orientation), offset)
    angular_velocity = np.array([body.angular_velocity for body in file.bodies])
    return Structure(
        file=file,
        source=source,
        folder=Path(folder),
        solids=solids,
        mass=mass,
        inertia=inertia,
        driven=np.array([body.driven for body in file.bodies]),
        position=centroid + lever,
        orientation=orientation,
        velocity=np.array([body.velocity for body in file.bodies]) + np.cross(angular_velocity, lever),
        angular_velocity=angular_velocity,
        friction=friction_matrix(file, source),
        touching=_touching(file, source, solids, centroid, orientation),
    )


def _solid(name, shape, source, folder):
    if shape.mesh is None:
        round_one = shape.cylinder
        polyhedron = convex_polyhedron(
            box_vertices(shape.box, shape.chamfer) if round_one is None else prism_vertices(round_one)
        )
        vertices, faces = polyhedron.vertices, triangles(polyhedron)
        return Solid(vertices, faces, polyhedron, mass_properties(vertices, faces))
    vertices, faces = read_mesh(folder, shape.mesh, source, f"shapes.{name}.mesh")
    properties = mass_properties(vertices, faces)
    vertices = vertices - properties.centroid
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    polyhedron = convex_polyhedron(vertices) if mesh.is_convex else None
    return Solid(vertices, faces, polyhedron, mass_properties(vertices, faces))


def _masses(file, solids, source):
    density = np.array([body.density or file.materials[body.material].density for body in file.bodies])
    properties = [solids[body.shape].properties for body in file.bodies]
    mass = density * np.array([item.volume for item in properties])
    inertia = [
        offset_inertia(kilograms, unit * item.inertia, np.array(body.mass_offset))
        if body.inertia is None
        else stated_inertia(
            body, kilograms, offset_solid(solids[body.shape], np.array(body.mass_offset)), source
        )
        for kilograms, unit, item, body in zip(mass, density, properties, file.bodies, strict=True)
    ]
    return mass, np.array(inertia)


def _touching(file, source, solids, position, orientation):
    """Pairs that touch at the start; an overlap too deep to be an initial penetration is an error."""
    bodies = file.bodies
    shape = [body.shape for body in bodies]
    driven = np.array([body.driven for body in bodies])
    pairs = near_pairs([solids[name] for name in shape], position, orientation, START_TOLERANCE)
    depth = depths_of_pairs(pairs, shape, solids, position, orientation)
    for index in np.flatnonzero(depth > DEEPEST_OVERLAP + _ROUNDING)[:1]:
        a, b = pairs[index]
        raise InputError(
            source,
            f"bodies.{bodies[b].name}.position",
            f"overlaps {bodies[a].name} by {1e3 * depth[index]:.3g} mm; "
            f"expected at most {1e3 * DEEPEST_OVERLAP:.0f} mm, from boxes and positions in metres",
        )
    touching = np.zeros((len(bodies), len(bodies)), dtype=bool)
    a, b = pairs[(depth > -START_TOLERANCE) & ~driven[pairs].all(axis=1)].T
    touching[a, b] = touching[b, a] = True
    return touching
