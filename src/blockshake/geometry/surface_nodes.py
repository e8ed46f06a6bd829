"""Surface nodes of a chamfered box: where LS-DEM looks for contact, and how much area each stands for."""

import numpy as np

from blockshake.geometry.level_set import hollow_depth


def box_nodes(size, chamfer, hollow, spacing, inset):
    """Nodes on the six flats of a box, evenly spaced, the outer ones just inside the perimeter.

    Parameters
    ----------
    size : sequence of 3 floats
        Full edge lengths along body x, y, z [m].
    chamfer : float
        Leg of the chamfer [m]; the flats end there.
    hollow : float
        Depth of the middle of each face below its perimeter [m]; the nodes lie on the concave face.
    spacing : float
        Aimed distance of nodes along each edge [m]; at least two intervals an edge.
    inset : float
        Distance of the outermost nodes from a flat's perimeter, over the narrower width of the flat [1], and at most a
        quarter of the spacing. On the ridge itself the normal of the level set jumps by 45 degrees.

    Returns
    -------
    points : float64 array, shape (n_nodes, 3)
        Body frame [m].
    areas : float64 array, shape (n_nodes,)
        Area that each node stands for [m2]. Over a flat they integrate a constant and a linear pressure exactly: their
        sum is the flat's area, and their second moments are its second moments, whatever spacing and inset, so that the
        number of nodes does not change the stiffness of an interface in compression or in rocking.
    """
    size = np.asarray(size, dtype=float)
    points, areas = [], []
    for axis in range(3):
        across = [other for other in range(3) if other != axis]
        widths = [size[other] - 2.0 * chamfer for other in across]
        # farther in, the weight of a node would be negative
        inside = min(inset * min(widths), 0.25 * spacing)
        first, first_weight = line_nodes(widths[0], spacing, inside)
        second, second_weight = line_nodes(widths[1], spacing, inside)
        u, v = 2.0 * first / widths[0], 2.0 * second / widths[1]
        depth = np.array([[hollow_depth(along, other, hollow) for other in v] for along in u])
        for side in (-0.5, 0.5):
            flat = np.zeros((first.size, second.size, 3))
            flat[..., axis] = side * (size[axis] - 2.0 * depth)
            flat[..., across[0]] = first[:, None]
            flat[..., across[1]] = second[None, :]
            points.append(flat.reshape(-1, 3))
            areas.append(np.outer(first_weight, second_weight).ravel())
    return np.vstack(points), np.concatenate(areas)


def line_nodes(length, spacing, inset):
    """Evenly spaced nodes on a centred line, with weights exact for cubic functions: float64 arrays (n,) each [m].

    ``length`` [m]; ``spacing``: aimed distance, at least two intervals [m]; ``inset``: distance of the end nodes from
    the line's ends [m]. The weights are trapezoidal, scaled to the whole length, with part of the end weights moved to
    their neighbours so that the second moment is ``length**3 / 12``. With two intervals and no inset this is Simpson's
    rule.
    """
    n_intervals = max(2, round(length / spacing))
    positions = np.linspace(-0.5, 0.5, n_intervals + 1) * (length - 2.0 * inset)
    weights = np.ones(n_intervals + 1)
    weights[[0, -1]] = 0.5
    weights *= length / weights.sum()
    excess = weights @ positions**2 - length**3 / 12.0
    moved = excess / (2.0 * (positions[-1] ** 2 - positions[-2] ** 2))
    weights[[0, -1]] -= moved
    weights[1] += moved
    weights[-2] += moved
    return positions, weights
