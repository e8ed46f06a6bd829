"""Level set of a chamfered box with flat or concave faces: the distance of Eq. (1) and its gradient, in closed form."""

from math import copysign

import numpy as np

from blockshake.jit import kernel_without_allocation

HALF_SQRT2 = np.sqrt(0.5)


@kernel_without_allocation
def box_distance(x, y, z, a, b, c, chamfer):
    """Level-set value and unit gradient of a chamfered box at a point.

    Parameters
    ----------
    x, y, z, a, b, c, chamfer : float
        Point in the body frame; half edge lengths along body x, y, z; leg of the 45-degree chamfer [m].

    Returns
    -------
    phi : float
        Signed distance [m], negative inside. Inside it is exact; outside it is the distance to
        the farthest face plane, at most the true distance: contact needs the inside alone, and
        a list of near nodes may only err on the side of keeping too many.
    nx, ny, nz : float
        Unit outward normal of the face that is nearest.

    Notes
    -----
    Zhou et al. (2023), Eq. (1). The box is symmetric, so that three flats and three chamfers in ``(|x|, |y|, |z|)`` are
    all its 18 faces, and of the chamfers the nearest is that between the two nearest flats. There is no branch: each
    choice is a select. A tie between a flat and a chamfer goes to the flat; where two flats (or two chamfers) tie, the
    normal is still a unit vector, that of the axis that comes first.
    """
    return _nearest_face(x, y, z, abs(x) - a, abs(y) - b, abs(z) - c, chamfer)


@kernel_without_allocation
def hollow_depth(u, v, hollow):
    """Depth of a concave face below its perimeter: ``hollow (1 - u^2)^2 (1 - v^2)^2``, without a kink there [m].

    ``u, v``: across the face over its half widths [1]; ``hollow``: in the middle [m]. It is zero beyond the perimeter.
    """
    p, q = 1.0 - u * u, 1.0 - v * v
    p, q = p if p > 0.0 else 0.0, q if q > 0.0 else 0.0
    return hollow * ((p * p) * (q * q))


@kernel_without_allocation
def hollow_box_distance(x, y, z, a, b, c, chamfer, hollow):
    """Level-set value and normal of a chamfered box whose six faces are concave, by arguments of `box_distance`.

    ``hollow``: depth of the middle of each face below its perimeter [m], see `hollow_depth`. The value is the distance
    along the normal of the face that is nearest [m], negative inside; the normal is that of the face as if it were
    flat: a concavity of 1 mm tilts it by some mrad.
    """
    u, v, w = x * (1.0 / (a - chamfer)), y * (1.0 / (b - chamfer)), z * (1.0 / (c - chamfer))
    fx = abs(x) - a + hollow_depth(v, w, hollow)
    fy = abs(y) - b + hollow_depth(u, w, hollow)
    fz = abs(z) - c + hollow_depth(u, v, hollow)
    return _nearest_face(x, y, z, fx, fy, fz, chamfer)


@kernel_without_allocation
def _nearest_face(x, y, z, fx, fy, fz, chamfer):
    """Level-set value and normal of the face that is nearest, from the distances out of the flats' planes [m]."""
    x_over_y, x_over_z, y_over_z = fx >= fy, fx >= fz, fy >= fz
    # farthest out of the flats' planes, and the next
    larger = fx if x_over_y else fy
    smaller = fy if x_over_y else fx
    first = larger if larger >= fz else fz
    other = fz if larger >= fz else larger
    second = smaller if smaller >= other else other
    cut = (first + second + chamfer) * HALF_SQRT2
    on_flat = first >= cut
    phi = first if on_flat else cut
    share = 1.0 if on_flat else HALF_SQRT2
    # each axis by how many of the others lie farther out: on a flat none may, on a chamfer one
    x_rank = (0.0 if x_over_y else 1.0) + (0.0 if x_over_z else 1.0)
    y_rank = (1.0 if x_over_y else 0.0) + (0.0 if y_over_z else 1.0)
    allowed = 0.0 if on_flat else 1.0
    nx = share if x_rank <= allowed else 0.0
    ny = share if y_rank <= allowed else 0.0
    nz = share if 3.0 - x_rank - y_rank <= allowed else 0.0
    return phi, copysign(nx, x), copysign(ny, y), copysign(nz, z)
