"""Bodies laid on others: their places follow from the shapes, so that a changed size keeps them touching."""

import numpy as np

from blockshake.errors import InputError
from blockshake.geometry.rotations import rotation_matrices


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
    centroid stands over that of the one below, plus the offset along x and y.
    """
    if all(body.on is None for body in file.bodies):
        return file
    names, position = [body.name for body in file.bodies], {}
    heights = {
        body.name: (solids[body.shape].vertices @ turn.T)[:, 2]
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
                x, y, z = np.add(position[body.on], body.offset).tolist()
                z += float(heights[body.on].max() - heights[body.name].min())
                position[body.name] = (x, y, z)
        left = [body for body in left if body.name not in position]
    bodies = tuple(body.model_copy(update={"position": position[body.name]}) for body in file.bodies)
    return file.model_copy(update={"bodies": bodies})
