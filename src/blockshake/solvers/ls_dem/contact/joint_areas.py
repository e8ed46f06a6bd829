"""Areas of the nodes of a joint: together they integrate a linear pressure over the overlap of the two flats."""

import numpy as np

from blockshake.geometry.level_set import hollow_depth
from blockshake.geometry.vectors import copy_into
from blockshake.jit import inner_kernel, kernel_without_allocation
from blockshake.solvers.ls_dem.contact.packets import FACTOR, LANES
from blockshake.solvers.ls_dem.contact.relative_pose import facing_of

_ON_FACE = 1e-9  # m
# A node counts where it stays inside the other's flat wherever the raster's place stands for, in steps of the raster;
# at most this share of its distance from the edge of its own flat, which may lie flush with the other's.
_MARGIN, _FLUSH = 1.5, 0.75
# Share of its area that another node of a face keeps, so that its shear spring slips along with the joint.
_IDLE = 1e-6
_LEAST_PIVOT = 1e-6  # of moments over a length of the overlap's size, where 1 is usual
_ORDERS = (6, 3, 1)  # terms of a polynomial of degree two, one and none


@inner_kernel
def joint_areas_into(candidates, surfaces, pair, key):
    """Factors of the areas of the listed nodes of a pair, whose key (4,) is that of `facing_key`; overwritten.

    Notes
    -----
    The nodes of a flat integrate over that flat. Where the edge of the other flat cuts it, each node's area is
    multiplied by a polynomial of its place, of the least change by least squares, for which all nodes of both flats
    inside the overlap have the overlap's area, and its first and second moments (moment fitting; Mueller, Kummer and
    Oberlack 2013, Int. J. Numer. Methods Eng. 96, 512). Its degree is two, or less where nodes are too few or an
    area would be negative.
    """
    factors, centre = np.zeros(6), np.zeros(3)
    fitted = key[0] >= 0 and _fit_into(candidates, surfaces, pair, key, factors, centre)
    for side in range(2):
        for packet in range(candidates.first[2 * pair + side], candidates.first[2 * pair + side + 1]):
            for lane in range(LANES):
                node = candidates.node[packet * LANES + lane]
                if node >= 0:
                    factor = candidates.share[2 * pair + side]
                    if fitted:
                        factor *= _factor(candidates, surfaces, pair, key, side == 1, node, factors, centre)
                    candidates.packets.kept[packet, FACTOR + lane] = factor


@inner_kernel
def _factor(candidates, surfaces, pair, key, second, node, factors, centre):
    """Factor of a node's area [1]: that of the polynomial in the overlap, next to none beyond it on the same flat."""
    a, b = candidates.pairs[pair, 0], candidates.pairs[pair, 1]
    on_face, counts, u, v = _place(surfaces, a, b, facing_of(surfaces, a, b, key), second, node)
    if not on_face:
        return 1.0
    if not counts:
        return _IDLE
    return max(_value(factors, (u - centre[0]) * centre[2], (v - centre[1]) * centre[2]), _IDLE)


@inner_kernel
def _fit_into(candidates, surfaces, pair, key, factors, centre):
    """Polynomial by which areas are multiplied, and whether there is one: not where the nodes' own flats overlap whole.

    ``factors`` (6,) of 1, x, y, x^2, x y, y^2; ``centre`` (3,): origin [m] and inverse unit [1/m] of x and y.
    """
    a, b = candidates.pairs[pair, 0], candidates.pairs[pair, 1]
    facing = facing_of(surfaces, a, b, key)
    polygon, n_corners = _overlap(surfaces, a, b, facing)
    wanted = np.zeros(6)
    area = _integral_into(polygon, n_corners, np.array([0.0, 0.0, 1.0]), wanted)
    flats = _flat_areas(surfaces, a, b, facing)
    whole = True
    for side in range(2):
        if candidates.share[2 * pair + side] > 0.0 and area < flats[side] * (1.0 - 1e-9):
            whole = False
    if whole or area <= 1e-9 * min(flats[0], flats[1]):
        return False
    centre[0], centre[1], centre[2] = wanted[1] / area, wanted[2] / area, 1.0 / np.sqrt(area)
    wanted[:] = 0.0
    _integral_into(polygon, n_corners, centre, wanted)
    # of all nodes of both faces, near or not: the areas are not to depend on the lists
    most = 0
    for side in range(2):
        shape = surfaces.shape[candidates.pairs[pair, side]]
        most += surfaces.first_node[shape + 1] - surfaces.first_node[shape]
    terms, weights = np.empty((most, 6)), np.empty(most)
    count = 0
    for side in range(2):
        owner, share = candidates.pairs[pair, side], candidates.share[2 * pair + side]
        shape = surfaces.shape[owner]
        for node in range(surfaces.first_node[shape], surfaces.first_node[shape + 1] if share > 0.0 else 0):
            on_face, counts, u, v = _place(surfaces, a, b, facing, side == 1, node)
            if on_face and counts:
                x, y = (u - centre[0]) * centre[2], (v - centre[1]) * centre[2]
                row = terms[count]
                row[0], row[1], row[2], row[3], row[4], row[5] = 1.0, x, y, x * x, x * y, y * y
                weights[count] = 0.5 * share * surfaces.areas[node]
                count += 1
    solved = False
    for n_terms in _ORDERS:
        solved = solved or _solve_into(terms[:count], weights[:count], wanted, n_terms, factors)
    return solved


@inner_kernel
def _solve_into(terms, weights, wanted, n_terms, factors):
    """Factors of the first terms by which the weights get the moments wanted; whether they exist and keep all positive.

    ``factors`` are overwritten. Of all changes of the weights this one has the least weighted square.
    """
    factors[:] = 0.0
    if len(weights) < n_terms:
        return False
    moments = np.zeros((n_terms, n_terms))
    lack = wanted[:n_terms].copy()
    for node in range(len(weights)):
        for i in range(n_terms):
            lack[i] -= weights[node] * terms[node, i]
            for j in range(n_terms):
                moments[i, j] += weights[node] * terms[node, i] * terms[node, j]
    # Cholesky's factor of the moments, in place, and both triangles solved; over the area all entries are near one
    area = wanted[0]
    for j in range(n_terms):
        for k in range(j):
            moments[j, j] -= moments[j, k] * moments[j, k]
        if not moments[j, j] > _LEAST_PIVOT * area:
            return False
        moments[j, j] = np.sqrt(moments[j, j])
        for i in range(j + 1, n_terms):
            for k in range(j):
                moments[i, j] -= moments[i, k] * moments[j, k]
            moments[i, j] /= moments[j, j]
    for i in range(n_terms):
        for k in range(i):
            lack[i] -= moments[i, k] * lack[k]
        lack[i] /= moments[i, i]
    for i in range(n_terms - 1, -1, -1):
        for k in range(i + 1, n_terms):
            lack[i] -= moments[k, i] * lack[k]
        lack[i] /= moments[i, i]
    copy_into(lack, factors)
    factors[0] += 1.0
    least = np.inf
    for node in range(len(weights)):
        least = min(least, _value(factors, terms[node, 1], terms[node, 2]))
    return least >= 0.0


@inner_kernel
def _value(factors, x, y):
    """Polynomial at a place [1]."""
    f = factors
    return f[0] + f[1] * x + f[2] * y + f[3] * x * x + f[4] * x * y + f[5] * y * y


@inner_kernel
def _place(surfaces, a, b, facing, second, node):
    """Whether a node is on the flat that meets, whether it counts in the overlap, and its place in the plane [m]."""
    body = b if second else a
    axis, sign = (facing.axis_b, facing.sign_b) if second else (facing.axis_a, facing.sign_a)
    shape = surfaces.shape[body]
    half, point, chamfer = surfaces.half[shape], surfaces.points[node], surfaces.chamfer[shape]
    p, q = (axis + 1) % 3, (axis + 2) % 3
    wide_p, wide_q = half[p] - chamfer, half[q] - chamfer
    x, y = point[p], point[q]
    depth = hollow_depth(x / wide_p, y / wide_q, surfaces.hollow[shape])
    on_face = (
        sign * point[axis] >= half[axis] - depth - _ON_FACE
        and abs(x) <= wide_p + _ON_FACE
        and abs(y) <= wide_q + _ON_FACE
    )
    # the second's plane is seen from below where both normals point the same way along the axes
    mirror = -facing.sign_a * facing.sign_b
    c, s = facing.cosine, facing.sine
    other = surfaces.shape[a if second else b]
    other_axis = facing.axis_a if second else facing.axis_b
    margin = min(_MARGIN * facing.step, _FLUSH * min(wide_p - abs(x), wide_q - abs(y)))
    limit_p, limit_q = _half_edges(surfaces, other, other_axis)
    limit_p, limit_q = limit_p - margin, limit_q - margin
    if second:
        u, v = facing.u + c * x - mirror * s * y, facing.v + s * x + mirror * c * y
        counts = abs(u) <= limit_p and abs(v) <= limit_q
        return on_face, counts, u, v
    du, dv = x - facing.u, y - facing.v
    counts = abs(c * du + s * dv) <= limit_p and abs(mirror * (c * dv - s * du)) <= limit_q
    return on_face, counts, x, y


@inner_kernel
def _flat_areas(surfaces, a, b, facing):
    """Areas of both flats [m2]."""
    i, j = surfaces.shape[a], surfaces.shape[b]
    p, q = _half_edges(surfaces, i, facing.axis_a)
    other_p, other_q = _half_edges(surfaces, j, facing.axis_b)
    return 4.0 * p * q, 4.0 * other_p * other_q


@kernel_without_allocation
def _half_edges(surfaces, shape, axis):
    """Half the edges of a flat across an axis of its shape [m]."""
    half, chamfer = surfaces.half[shape], surfaces.chamfer[shape]
    return half[(axis + 1) % 3] - chamfer, half[(axis + 2) % 3] - chamfer


@inner_kernel
def _overlap(surfaces, a, b, facing):
    """Corners of the overlap of two flats in the plane of the first, (12, 2) [m], and how many there are.

    The second flat clipped at the first's edges one by one (Sutherland and Hodgman 1974).
    """
    i, j = surfaces.shape[a], surfaces.shape[b]
    limit, (x, y) = _half_edges(surfaces, i, facing.axis_a), _half_edges(surfaces, j, facing.axis_b)
    polygon, clipped = np.empty((12, 2)), np.empty((12, 2))
    c, s = facing.cosine, facing.sine
    for corner, (p, q) in enumerate(((x, y), (-x, y), (-x, -y), (x, -y))):
        polygon[corner, 0], polygon[corner, 1] = facing.u + c * p - s * q, facing.v + s * p + c * q
    count = 4
    for edge in range(4):
        axis, sign = edge // 2, 1.0 if edge % 2 == 0 else -1.0
        kept = 0
        for index in range(count):
            here, there = polygon[index], polygon[(index + 1) % count]
            beyond, next_beyond = sign * here[axis] - limit[axis], sign * there[axis] - limit[axis]
            if beyond <= 0.0:
                clipped[kept, 0], clipped[kept, 1] = here[0], here[1]
                kept += 1
            if beyond * next_beyond < 0.0:
                share = beyond / (beyond - next_beyond)
                for part in range(2):
                    clipped[kept, part] = here[part] + share * (there[part] - here[part])
                kept += 1
        polygon, clipped = clipped, polygon
        count = kept
    return polygon, count


@inner_kernel
def _integral_into(polygon, count, centre, moments):
    """Area of a convex polygon [m2]; its moments are added, of 1, x, y, x^2, x y, y^2.

    ``x`` and ``y`` are places from ``centre[:2]`` times ``centre[2]``. In each triangle the middles of the edges
    integrate a polynomial of degree two exactly.
    """
    area = 0.0
    for index in range(1, count - 1):
        o, p, q = polygon[0], polygon[index], polygon[index + 1]
        part = 0.5 * abs((p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]))
        area += part
        for start, end in ((o, p), (p, q), (q, o)):
            x = (0.5 * (start[0] + end[0]) - centre[0]) * centre[2]
            y = (0.5 * (start[1] + end[1]) - centre[1]) * centre[2]
            moments[0] += part / 3.0
            moments[1] += part / 3.0 * x
            moments[2] += part / 3.0 * y
            moments[3] += part / 3.0 * x * x
            moments[4] += part / 3.0 * x * y
            moments[5] += part / 3.0 * y * y
    return area
