"""A mesh file as a closed surface that encloses a solid, or a refusal in one line."""

import io

import numpy as np
import trimesh

from blockshake.errors import InputError
from blockshake.files import read_bytes
from blockshake.geometry.meshes.crossings import shown, solid_fault
from blockshake.paths import file_below

MESHES = (".stl", ".ply", ".obj", ".off")  # suffixes of mesh files
_OF_32_BITS = (".stl", ".ply")  # those that may hold coordinates of 32 bits
_FARTHEST = 1e8  # m, from the origin: beyond any survey
_COARSEST = 1e-4  # of the shortest edge of the box: steps of coordinates that still give the shape


def read_mesh(folder, name, source, key):
    """Vertices and triangles of a mesh file.

    Parameters
    ----------
    folder : str or path
        The file lies below it.
    name : str
        Relative path of an STL, PLY, OBJ or OFF file with coordinates in m.
    source, key : str
        File and key that an error names.

    Returns
    -------
    vertices : float64 array, shape (n_vertices, 3)
        Axes of the file, from the middle of the surface's box [m].
    faces : int64 array, shape (n_triangles, 3)
        Outward triangles.

    Raises
    ------
    InputError
        The file is missing or no mesh; the surface is not closed, is turned inwards, crosses or touches itself, or
        has parts that overlap; or its coordinates are too coarse where they lie. Separate parts are allowed, and so
        are cavities whose surface is turned inwards.
    """
    path = file_below(folder, name, source, key)
    if path.suffix.lower() not in MESHES:
        raise InputError(source, key, f"expected a mesh file {', '.join(MESHES)}, not '{path}'")
    try:
        with np.errstate(over="ignore", invalid="ignore"):  # of corners that are refused below
            # from its bytes, so that it cannot name further files
            mesh = trimesh.load_mesh(io.BytesIO(read_bytes(path)), file_type=path.suffix.lower()[1:])
            mesh.merge_vertices(
                merge_tex=True, merge_norm=True
            )  # textures part the corners of a closed surface
            mesh.update_faces(
                (mesh.faces != np.roll(mesh.faces, 1, axis=1)).all(axis=1)
            )  # edges as triangles
            mesh.remove_unreferenced_vertices()
        given, faces = np.array(mesh.vertices, dtype=float), np.array(mesh.faces, dtype=np.int64)
    except Exception as error:  # trimesh raises whatever its many readers raise
        raise InputError(source, key, f"expected a readable mesh file {path}; {error}") from None
    if fault := _surface_fault(given, faces, path.suffix.lower()):
        raise InputError(
            source, key, f"expected a closed surface with outward triangles; {path.name}: {fault}"
        )
    # about its middle, so that sums keep their digits in a surveyor's coordinates
    return given - 0.5 * (given.min(axis=0) + given.max(axis=0)), faces


def _surface_fault(vertices, faces, suffix):
    """Reason in words why a surface is no block's; None where it is one."""
    if not len(faces) or not (np.abs(vertices) < _FARTHEST).all():
        return f"it has no triangles, or corners that are no numbers below {_FARTHEST:.0e} m"
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    forward, backward = start * len(vertices) + end, end * len(vertices) + start
    known, uses = np.unique(forward, return_counts=True)
    alone = ~np.isin(backward, known[uses == 1]) | ~np.isin(forward, known[uses == 1])
    if alone.any():
        place = 0.5 * (vertices[start] + vertices[end])[alone.argmax()]
        return f"at {shown(place)} m an edge does not join just two triangles that agree on the outside"
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    step = float(np.spacing(np.float32(max(abs(low).max(), abs(high).max()))))
    rounded = suffix in _OF_32_BITS and np.array_equal(vertices.astype(np.float32), vertices)
    if rounded and step > _COARSEST * (high - low).min():
        return f"so far from its origin its 32-bit coordinates are {step:.2g} m apart"
    if np.linalg.det((vertices - 0.5 * (low + high))[faces]).sum() <= 0.0:
        return "it is flat, or turned inwards"
    return solid_fault(vertices, faces)
