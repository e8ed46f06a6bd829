"""Level set of a chamfered box: the signed distance of Eq. (1) and its gradient, in closed form."""

import numpy as np

from blockshake.jit import inline_kernel

HALF_SQRT2 = np.sqrt(0.5)


@inline_kernel
def box_distance(x, y, z, a, b, c, chamfer):
    """Level-set value and unit gradient of a chamfered box at a point.

    Parameters
    ----------
    x, y, z : float
        Point in the body frame [m].
    a, b, c : float
        Half edge lengths along body x, y, z [m].
    chamfer : float
        Leg of the 45-degree chamfer [m].

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
    Zhou et al. (2023), Eq. (1). The box is symmetric, so that three flats and three chamfers
    in ``(|x|, |y|, |z|)`` are all its 18 faces. There is no branch: each choice is a select.
    Ties go to the flats, then to x before y before z.
    """
    ux, uy, uz = abs(x), abs(y), abs(z)
    fx, fy, fz = ux - a, uy - b, uz - c
    exy = (fx + fy + chamfer) * HALF_SQRT2
    exz = (fx + fz + chamfer) * HALF_SQRT2
    eyz = (fy + fz + chamfer) * HALF_SQRT2
    phi = fx
    nx, ny, nz = 1.0, 0.0, 0.0
    nearer = fy > phi
    phi = fy if nearer else phi
    nx = 0.0 if nearer else nx
    ny = 1.0 if nearer else ny
    nearer = fz > phi
    phi = fz if nearer else phi
    nx = 0.0 if nearer else nx
    ny = 0.0 if nearer else ny
    nz = 1.0 if nearer else nz
    nearer = exy > phi
    phi = exy if nearer else phi
    nx = HALF_SQRT2 if nearer else nx
    ny = HALF_SQRT2 if nearer else ny
    nz = 0.0 if nearer else nz
    nearer = exz > phi
    phi = exz if nearer else phi
    nx = HALF_SQRT2 if nearer else nx
    ny = 0.0 if nearer else ny
    nz = HALF_SQRT2 if nearer else nz
    nearer = eyz > phi
    phi = eyz if nearer else phi
    nx = 0.0 if nearer else nx
    ny = HALF_SQRT2 if nearer else ny
    nz = HALF_SQRT2 if nearer else nz
    nx = -nx if x < 0.0 else nx
    ny = -ny if y < 0.0 else ny
    nz = -nz if z < 0.0 else nz
    return phi, nx, ny, nz
