"""Overlap of two faces on a common plane, and its reduction to at most four contact points."""

import numpy as np

from blockshake.geometry.vectors import cross, difference, dot, put_into
from blockshake.jit import kernel_without_allocation

# Points this far outside a side plane count as inside, so that flush faces do not flicker [m].
_FLUSH = 1e-9
# Corners closer than this are one point; gaps that differ by less are equal [m].
_SAME_POINT = 1e-7


@kernel_without_allocation
def clip_face_into(polyhedra, placed, reference, incident):
    """Part of the incident face inside the prism over the reference face; the number of its corners.

    The corners of the outline of ``placed`` are overwritten with a convex polygon in the plane of the incident face
    [m], by Sutherland and Hodgman (1974). ``reference`` and ``incident`` are rows of faces.
    """
    first, last = polyhedra.first_corner[incident], polyhedra.first_corner[incident + 1]
    ref_first, ref_last = polyhedra.first_corner[reference], polyhedra.first_corner[reference + 1]
    polygon, clipped = placed.outline.corners, placed.outline.other
    count = last - first
    for corner in range(count):
        put_into(placed.vertices[polyhedra.corners[first + corner]], polygon[corner])
    n = placed.normals[reference]
    for corner in range(ref_first, ref_last):
        start = placed.vertices[polyhedra.corners[corner]]
        following = corner + 1 if corner + 1 < ref_last else ref_first
        end = placed.vertices[polyhedra.corners[following]]
        # edge x normal points out of a face that is counter-clockwise about its normal
        m = cross(difference(end, start), n)
        length = np.sqrt(dot(m, m))
        m = m[0] / length, m[1] / length, m[2] / length
        limit = dot(m, start) + _FLUSH
        kept = 0
        for index in range(count):
            here = polygon[index]
            there = polygon[index + 1 if index + 1 < count else 0]
            d_here, d_there = dot(m, here) - limit, dot(m, there) - limit
            if d_here <= 0.0:
                put_into(here, clipped[kept])
                kept += 1
            if (d_here < 0.0 and d_there > 0.0) or (d_here > 0.0 and d_there < 0.0):
                share = d_here / (d_here - d_there)
                for axis in range(3):
                    clipped[kept, axis] = here[axis] + share * (there[axis] - here[axis])
                kept += 1
        for index in range(kept):
            put_into(clipped[index], polygon[index])
        count = kept
        if count == 0:
            break
    return _without_doubles_into(polygon, count)


@kernel_without_allocation
def _without_doubles_into(polygon, count):
    """Number of the first ``count`` corners without those that repeat the one before, which are taken out."""
    kept = 0
    for index in range(count):
        double = False
        for other in (kept - 1, 0):
            if kept > 0 and not double:
                double = _squared_distance(polygon[index], polygon[other]) < _SAME_POINT * _SAME_POINT
        if not double:
            put_into(polygon[index], polygon[kept])
            kept += 1
    return kept


@kernel_without_allocation
def _squared_distance(x, y):
    d = difference(x, y)
    return dot(d, d)


@kernel_without_allocation
def area_and_centroid_into(polygon, count, center):
    """Area of a convex polygon of so many corners [m2]; its centroid, or else the mean corner, into ``center``."""
    weight = 0.0
    center[0] = center[1] = center[2] = 0.0
    for index in range(1, count - 1):
        normal = cross(difference(polygon[index], polygon[0]), difference(polygon[index + 1], polygon[0]))
        area = np.sqrt(dot(normal, normal))
        weight += area
        for axis in range(3):
            center[axis] += area * (polygon[0, axis] + polygon[index, axis] + polygon[index + 1, axis]) / 3.0
    if weight > 0.0:
        for axis in range(3):
            center[axis] /= weight
    else:
        for index in range(count):
            for axis in range(3):
                center[axis] += polygon[index, axis] / count
    return 0.5 * weight


@kernel_without_allocation
def shrink_polygon_into(shrink, polygon, count, center):
    """Scale a polygon by ``1 - shrink`` about its area centroid, in place, which is put into ``center``."""
    area_and_centroid_into(polygon, count, center)
    for index in range(count):
        for axis in range(3):
            polygon[index, axis] = center[axis] + (1.0 - shrink) * (polygon[index, axis] - center[axis])


@kernel_without_allocation
def choose_four_into(points, gaps, count, normal, chosen):
    """Indices of at most four points that hold the deepest and keep the extent; their number.

    ``points`` (n, 3): corners of a polygon in order [m], with ``gaps`` (n,) [m], of which the first ``count`` are used;
    ``normal`` (3,): of the common plane. ``chosen`` int64 (4,) is overwritten with increasing indices.

    Notes
    -----
    The deepest point (of equally deep ones the farthest from the mean), the farthest from it,
    the one that spans the largest triangle with both, and the one that adds the largest area to
    that triangle. A choice of this program: Cundall (1988) and the paper only say "at most four".
    """
    if count <= 4:
        for index in range(count):
            chosen[index] = index
        return count
    x, y, z = 0.0, 0.0, 0.0
    lowest = np.inf
    for index in range(count):
        lowest = min(lowest, gaps[index])
        x, y, z = x + points[index, 0] / count, y + points[index, 1] / count, z + points[index, 2] / count
    p, q, r, s = -1, -1, -1, -1
    best = -1.0
    for index in range(count):
        if gaps[index] <= lowest + _SAME_POINT:
            distance = _squared_distance(points[index], (x, y, z))
            # the small factor keeps equal distances, rounded differently, on the first of them
            if distance > best * (1.0 + 1e-9):
                best, p = distance, index
    best = -1.0
    for index in range(count):
        distance = _squared_distance(points[index], points[p])
        if distance > best * (1.0 + 1e-9):
            best, q = distance, index
    best = -1.0
    for index in range(count):
        area = abs(_signed_area(points[p], points[q], points[index], normal))
        if index != p and index != q and area > best * (1.0 + 1e-9):
            best, r = area, index
    turn = 1.0 if _signed_area(points[p], points[q], points[r], normal) >= 0.0 else -1.0
    best = 0.0
    for index in range(count):
        if index in (p, q, r):
            continue
        a = -turn * _signed_area(points[p], points[q], points[index], normal)
        b = -turn * _signed_area(points[q], points[r], points[index], normal)
        c = -turn * _signed_area(points[r], points[p], points[index], normal)
        added = max(a, max(b, c))
        if added > best * (1.0 + 1e-9):
            best, s = added, index
    kept = 0
    for index in range(count):
        if index in (p, q, r, s):
            chosen[kept] = index
            kept += 1
    return kept


@kernel_without_allocation
def _signed_area(a, b, c, normal):
    return 0.5 * dot(cross(difference(b, a), difference(c, a)), normal)
