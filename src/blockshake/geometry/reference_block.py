"""The block that stands for a structure: of the material and of the height that most of its free mass has."""

from typing import NamedTuple

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices

_SAME_HEIGHT = 6  # decimals of a metre


class ReferenceBlock(NamedTuple):
    """One body, and its edge lengths as it stands in the structure."""

    body: int  # index of the narrowest body of that material and height, the first of equals
    size: np.ndarray  # float64 (3,); of the box around its shape, the upright edge last [m]


def reference_body(structure):
    """Index of the first body of the material of which the free bodies have most mass, whatever their order."""
    names = [body.material for body in structure.file.bodies]
    weight = {name: 0.0 for name in sorted(names)}
    for name, mass, driven in zip(names, structure.mass, structure.driven, strict=True):
        weight[name] += 0.0 if driven else mass
    return names.index(max(weight, key=weight.get))


def reference_block(structure):
    """`ReferenceBlock` of a structure; an `InputError` where all of its bodies are driven."""
    bodies = structure.file.bodies
    if structure.driven.all():
        raise InputError(structure.source, "bodies", "expected a body that is not driven")
    material = bodies[reference_body(structure)].material
    candidates = [body for body in np.flatnonzero(~structure.driven) if bodies[body].material == material]
    sizes = {int(body): upright_size(structure, body) for body in candidates}
    weight = {}
    for body, size in sizes.items():
        height = round(float(size[2]), _SAME_HEIGHT)
        weight[height] = weight.get(height, 0.0) + structure.mass[body]
    most = max(weight, key=weight.get)
    alike = [body for body, size in sizes.items() if round(float(size[2]), _SAME_HEIGHT) == most]
    body = min(alike, key=lambda body: sizes[body][:2].min())
    return ReferenceBlock(body, sizes[body])


def upright_size(structure, body):
    """Edge lengths of the box around a shape, the axis that is nearest to the vertical last [m]."""
    name = structure.file.bodies[body].shape
    box = structure.file.shapes[name].box
    size = np.array(box) if box else np.ptp(structure.solids[name].vertices, axis=0)
    upright = int(np.argmax(np.abs(rotation_matrices(structure.orientation[body])[2])))
    return size[[axis for axis in range(3) if axis != upright] + [upright]]
