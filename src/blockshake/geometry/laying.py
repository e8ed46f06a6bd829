"""Bodies laid on others: their places follow from the shapes, so that a changed size keeps them touching."""

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.schema import Array, Body
from blockshake.validation import validated


def laid(file, solids, orientation, source):
    """A structure file in which every body that is laid ``on`` another has its position.

    Parameters
    ----------
    file : StructureFile
    solids : dict of str to Solid
        By shape name, about the centroids.
    orientation : float64 array, shape (n_bodies, 4)
        Unit quaternions (w, x, y, z), body to world.
    source : str
        To name in an error.

    Raises
    ------
    InputError
        A body on none of the structure's, or bodies that lie on each other in a circle.

    Notes
    -----
    The lowest point of a body comes to the height of the highest point of the one below, plus the offset along z; its
    centroid stands over that of the one below, plus the offset, and the steps times the body's widths, along x and y.
    """
    if all(body.on is None for body in file.bodies):
        return file
    names, position = [body.name for body in file.bodies], {}
    corners = {
        body.name: solids[body.shape].vertices @ turn.T
        for body, turn in zip(file.bodies, rotation_matrices(orientation), strict=True)
    }
    left = list(file.bodies)
    for body in left:
        if body.on is not None and (body.on not in names or body.on == body.name):
            expected = f"expected another body of this structure, not '{body.on}'"
            raise InputError(source, f"bodies.{body.name}.on", expected)
    while left:
        ready = [body for body in left if body.on is None or body.on in position]
        if not ready:
            raise InputError(
                source, f"bodies.{left[0].name}.on", "expected bodies that end on one with a position"
            )
        for body in ready:
            position[body.name] = body.position
            if body.on is not None:
                own, place = corners[body.name], np.add(position[body.on], body.offset)
                place[:2] += np.multiply(body.steps or (0.0, 0.0), np.ptp(own, axis=0)[:2])
                place[2] += corners[body.on][:, 2].max() - own[:, 2].min()
                position[body.name] = tuple(place.tolist())
        left = [body for body in left if body.name not in position]
    bodies = tuple(body.model_copy(update={"position": position[body.name]}) for body in file.bodies)
    return file.model_copy(update={"bodies": bodies})


def spread(mapping, source):
    """Mapping of a structure file whose arrays of bodies are bodies of their own, each laid ``on`` the one below.

    Raises
    ------
    InputError
        An array that is wrong, or of a body with a position.

    Notes
    -----
    The middle of the wall stands over that of the body below the first course, plus the entry's offset. Places are in
    widths of the body, so that the copies follow a changed size. Copies next to each other touch where there is no gap.
    """
    bodies = mapping.get("bodies")
    if not isinstance(bodies, (list, tuple)):
        return mapping
    made = [_copies(one, source) if isinstance(one, dict) and "array" in one else [one] for one in bodies]
    return {**mapping, "bodies": [body for copies in made for body in copies]}


def _copies(entry, source):
    key = f"bodies.{entry.get('name')}"
    array = validated(Array, entry["array"], source, f"{key}.array")
    body = validated(Body, entry, source, key).model_dump(mode="json", exclude_defaults=True)
    del body["array"]
    (along, across, courses), made = array.counts, []
    for course in range(courses):
        side = array.bond * (course % 2 - 0.5) if courses > 1 else 0.0
        for row in range(across):
            for place in range(along):
                steps = np.array([place - (along - 1) / 2 + side, row - (across - 1) / 2])
                below = {"on": f"{entry['name']}-{len(made) - along * across + 1}"}
                shift = np.zeros(3)
                if course > 0:
                    steps = np.array([2.0 * side, 0.0])
                shift[:2] = array.gap * steps
                if course == 0:
                    below, shift = {"on": body["on"]}, shift + body["offset"]
                    steps += body.get("steps", (0.0, 0.0))
                name = {"name": f"{entry['name']}-{len(made) + 1}"}
                made.append(body | name | below | {"offset": shift.tolist(), "steps": steps.tolist()})
    return made
