"""Points fixed to bodies, such as sensors, held against the bodies that carry them."""

from typing import NamedTuple

import numpy as np

from blockshake.errors import InputError

# A mast or a bracket of a sensor is shorter than its block; a frame on a slab may be some times as high as wide. Places
# in centimetres or from the structure's origin lie farther off.
_REMARKED, _REFUSED = 0.5, 3.0  # of the body's longest edge


class _Point(NamedTuple):
    key: str
    body: str
    away: float
    edge: float


def check_points(file, solids, source):
    """Refuse points farther off their bodies than three times these bodies' longest edge.

    Parameters
    ----------
    file : StructureFile
    solids : dict of str to Solid
        By shape name.
    source : str

    Raises
    ------
    InputError
    """
    for point in _points(file, solids):
        if point.away > _REFUSED * point.edge:
            raise InputError(
                source, point.key,
                f"expected a place near {point.body}, whose longest edge is {point.edge:.3g} m, in its own frame; "
                f"it lies {point.away:.3g} m off",
            )  # fmt: skip


def point_remarks(structure):
    """One sentence for every point that is off its body by more than half of the longest edge; a list of str."""
    return [
        f"{point.key} lies {point.away:.3g} m off {point.body}, whose longest edge is {point.edge:.3g} m"
        for point in _points(structure.file, structure.solids)
        if point.away > _REMARKED * point.edge
    ]


def _points(file, solids):
    """Every point of the file, and how far it lies outside of its body's bounding box [m]."""
    boxes = {
        body.name: (solids[body.shape].vertices.min(axis=0), solids[body.shape].vertices.max(axis=0))
        for body in file.bodies
    }
    named = [
        (f"{kind}.{getattr(item, 'name', index)}.position", item.body, item.position)
        for kind in ("markers", "accelerometers", "displacement_transducers", "stoppers", "external_forces")
        for index, item in enumerate(getattr(file, kind))
    ]
    named += [
        (f"displacement_transducers.{item.name}.reference_position", item.reference, item.reference_position)
        for item in file.displacement_transducers
    ]
    for key, body, position in named:
        low, high = boxes[body]
        outside = np.maximum(np.maximum(low - position, position - high), 0.0)
        yield _Point(key, body, float(np.linalg.norm(outside)), float((high - low).max()))
