"""When a structure has collapsed: a body that stood on something has tipped over or dropped."""

import numpy as np

from blockshake.geometry.rotations import rotation_rows
from blockshake.geometry.vectors import difference, dot, rows_product
from blockshake.jit import kernel_without_allocation

# Cosine of the tilt from which a block does not come back.
COSINE_OF_TILT = np.sqrt(0.5)


def collapse_limits(structure):
    """Bodies of a `Structure` that are watched for collapse, and the drop that each may take.

    Returns
    -------
    supported : bool array, shape (n_bodies,)
        Bodies that are not driven and touch another at the start; none where nothing is driven.
    drop_limit : float64 array, shape (n_bodies,)
        Half the smallest extent of each along its own axes [m].
    """
    smallest = [np.ptp(structure.solid(body).vertices, axis=0).min() for body in range(len(structure.mass))]
    supported = structure.touching.any(axis=1) & ~structure.driven & structure.driven.any()
    return supported, 0.5 * np.array(smallest)


@kernel_without_allocation
def find_collapsed(bodies, state, supported, drop_limit):
    """First body that has collapsed, or -1; ``supported``, ``drop_limit`` (n_bodies,) are those of `collapse_limits`.

    Notes
    -----
    Collapsed means, in the frame of the first driven body, that the body axis that was vertical at the start leans by
    more than 45 degrees, or that the mass centre has dropped by more than ``drop_limit``: a table that tilts carries
    its blocks along. The criterion is this program's; the paper states none. Turning about the vertical is no collapse.
    """
    base = 0
    while base < supported.size - 1 and not bodies.driven[base]:
        base += 1
    # the axis of the base that was vertical at the start, where it points now
    _, _, start = rotation_rows(bodies.home_orientation[base])
    up = rows_product(rotation_rows(state.orientation[base]), start)
    for body in range(supported.size):
        if not supported[body]:
            continue
        height = bodies.home[body, 2] - bodies.home[base, 2]
        if height - dot(up, difference(state.position[body], state.position[base])) > drop_limit[body]:
            return body
        _, _, start = rotation_rows(bodies.home_orientation[body])
        if dot(up, rows_product(rotation_rows(state.orientation[body]), start)) < COSINE_OF_TILT:
            return body
    return -1
