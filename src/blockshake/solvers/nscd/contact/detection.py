"""Contact points of a pair of convex polyhedra: separating axes, then the common plane."""

import numpy as np

from blockshake.geometry.vectors import cross, difference, dot, put_into
from blockshake.jit import kernel_without_allocation
from blockshake.solvers.nscd.contact.overlap_polygon import (
    area_and_centroid_into,
    choose_four_into,
    clip_face_into,
    shrink_polygon_into,
)

# Relative to the smaller radius of the pair: an axis must separate this much better than the one of
# the step before, or an edge axis than a face, to take its place; so resting contacts do not flip.
_BIAS = 1e-4
# Relative as well: with a face normal that overlaps less than this, edges are not looked at.
_TOUCH = 1e-5
# Two edges that cross at a smaller sine are parallel, and parallel edges meet in a face axis.
_PARALLEL = 1e-6
# Share of a joint's area that a corner stands for where its middle stands for the rest: exact for the axial and the
# rotational stiffness of a parallelogram, and of a triangle.
_CORNER = 1.0 / 12.0
LEAST_AREA = 1e-12  # m2, of a joint that has none


@kernel_without_allocation
def detect_pair_into(polyhedra, placed, a, b, margin, shrink, layer, memory, normal, points, gaps, areas):
    """Contact points of bodies ``a`` and ``b``, at most four and the middle of a joint with a layer; their number.

    Parameters
    ----------
    polyhedra, placed, a, b : Polyhedra, Placed, int, int
        The outline of ``placed`` is worked in.
    margin, shrink : float
        Points with a larger gap are left out [m]; `NscdParameters` has the shrinking [1].
    layer : float
        Compliance of the layer between them [m3/N]; without one the middle of a joint is no contact.
    memory : int64 array, shape (n_bodies, n_bodies)
        Row of the reference face of each pair at the step before, -1 for none; updated.
    normal, points, gaps, areas : float64 arrays, shape (3,), (5, 3), (5,), (5,)
        Overwritten: unit normal from ``a`` to ``b``; points midway between the two surfaces, world frame [m]; clearance
        along the normal, negative in penetration [m]; area of a layer that each stands for, infinite where edges meet
        and no layer is between [m2].

    Notes
    -----
    The common plane of Cundall (1988) is found by the separating-axis theorem (Gottschalk et
    al. 1996): of all face normals and all crosses of edge directions, the one along which the bodies are
    farthest apart. An axis that cannot beat the best one so far, by the distance of the mass
    centres along it, is skipped. The mass centre is taken to lie inside its body.
    """
    size = min(polyhedra.radius[a], polyhedra.radius[b])
    bias = _BIAS * size
    # candidates in two classes: face normals first, since most contacts of blocks are face to face
    face, separation = _best_face(polyhedra, placed, a, b, margin, memory[a, b], bias)
    if separation > margin:
        return 0
    memory[a, b] = face
    owner, other = (
        (a, b) if face < polyhedra.first_face[a + 1] and face >= polyhedra.first_face[a] else (b, a)
    )
    count = _face_points_into(polyhedra, placed, other, face, margin, shrink, layer, points, gaps, areas)
    # crosses of edges only where faces overlap nowhere, or press deeper than a touch: they are many
    if count == 0 or separation < -_TOUCH * size:
        edge_normal = placed.outline.axis
        edge_separation = _best_edge_into(polyhedra, placed, a, b, edge_normal)
        if edge_separation > margin:
            return 0
        better = edge_separation > separation + bias
        if better and _edge_point_into(polyhedra, placed, a, b, edge_normal, points):
            gaps[0], areas[0] = edge_separation, np.inf
            put_into(edge_normal, normal)
            return 1
    sign = 1.0 if owner == a else -1.0
    for axis in range(3):
        normal[axis] = sign * placed.normals[face, axis]
    return count


@kernel_without_allocation
def _face_separation(polyhedra, placed, face, other):
    n = placed.normals[face]
    lowest = np.inf
    for row in range(polyhedra.first_vertex[other], polyhedra.first_vertex[other + 1]):
        lowest = min(lowest, dot(n, placed.vertices[row]))
    return lowest - placed.offsets[face]


@kernel_without_allocation
def _best_face(polyhedra, placed, a, b, margin, last_face, bias):
    """Face whose normal separates best, and by how much; the last one has the bias, then ``a``."""
    best_face, best = last_face, -np.inf
    if last_face >= 0:
        other = b if polyhedra.first_face[a] <= last_face < polyhedra.first_face[a + 1] else a
        best = _face_separation(polyhedra, placed, last_face, other)
        if best > margin:
            return best_face, best
    threshold = best + bias
    for owner, other in ((a, b), (b, a)):
        for face in range(polyhedra.first_face[owner], polyhedra.first_face[owner + 1]):
            # the other's mass centre bounds its nearest vertex from above: no need to look at vertices
            if dot(placed.normals[face], placed.center[other]) - placed.offsets[face] <= threshold:
                continue
            separation = _face_separation(polyhedra, placed, face, other)
            if separation > threshold:
                best_face, best, threshold = face, separation, separation
                if best > margin:
                    return best_face, best
        if owner == a and last_face < 0:
            threshold = best + bias
    return best_face, best


@kernel_without_allocation
def _incident_face(polyhedra, placed, face, other):
    """Face of ``other`` that holds its nearest vertex and looks most against the reference face."""
    n = placed.normals[face]
    lowest = _face_separation(polyhedra, placed, face, other) + placed.offsets[face]
    limit = lowest + 1e-6 * polyhedra.radius[other]
    best, chosen = np.inf, -1
    for candidate in range(polyhedra.first_face[other], polyhedra.first_face[other + 1]):
        cosine = dot(n, placed.normals[candidate])
        if cosine >= best - 1e-12:
            continue
        for corner in range(polyhedra.first_corner[candidate], polyhedra.first_corner[candidate + 1]):
            if dot(n, placed.vertices[polyhedra.corners[corner]]) <= limit:
                best, chosen = cosine, candidate
                break
    return chosen


@kernel_without_allocation
def _face_points_into(polyhedra, placed, other, face, margin, shrink, layer, points, gaps, areas):
    """Corners of the overlap, and its middle where there is a layer; those within ``margin``.

    Every corner stands for a twelfth of the area and the middle for the rest, so that springs there have the axial
    stiffness ``A / c`` and the rotational one ``I / c`` of a layer over a parallelogram; corners alone with the right
    axial stiffness would have three times the rotational one. With a layer all points lie in the plane of the deepest:
    points that all press and stick at different heights would hold a block that turns about an axis along the joint.
    """
    incident = _incident_face(polyhedra, placed, face, other)
    polygon, distance, chosen = placed.outline.corners, placed.outline.gaps, placed.outline.chosen
    middle, n_corners = placed.outline.middle, clip_face_into(polyhedra, placed, face, incident)
    if shrink > 0.0:
        shrink_polygon_into(shrink, polygon, n_corners, middle)
    n, offset = placed.normals[face], placed.offsets[face]
    area = max(area_and_centroid_into(polygon, n_corners, middle), LEAST_AREA)
    corners = min(n_corners, 4)
    count = 0
    for index in range(n_corners):
        x = polygon[index]
        gap = dot(n, x) - offset
        if gap <= margin:
            put_into(x, polygon[count])
            distance[count] = gap
            count += 1
    count = choose_four_into(polygon, distance, count, n, chosen)
    gap = dot(n, middle) - offset
    lowest = gap
    for index in range(count):
        lowest = min(lowest, distance[chosen[index]])
    for index in range(count):
        gaps[index], areas[index] = distance[chosen[index]], _CORNER * area
        height = 0.5 * (lowest if layer > 0.0 else gaps[index])
        for axis in range(3):
            points[index, axis] = polygon[chosen[index], axis] - (gaps[index] - height) * n[axis]
    if layer > 0.0 and corners > 2 and gap <= margin:
        gaps[count], areas[count] = gap, (1.0 - corners * _CORNER) * area
        for axis in range(3):
            points[count, axis] = middle[axis] - (gap - 0.5 * lowest) * n[axis]
        count += 1
    return count


@kernel_without_allocation
def _best_edge_into(polyhedra, placed, a, b, normal):
    """Largest separation along a cross of edge directions [m]; its unit vector from ``a`` to ``b``."""
    best = -np.inf
    way = difference(placed.center[b], placed.center[a])
    reach = polyhedra.inradius[a] + polyhedra.inradius[b]
    for i in range(polyhedra.first_direction[a], polyhedra.first_direction[a + 1]):
        u = placed.directions[i]
        for j in range(polyhedra.first_direction[b], polyhedra.first_direction[b + 1]):
            x, y, z = cross(u, placed.directions[j])
            sine = np.sqrt(x * x + y * y + z * z)
            if sine < _PARALLEL:
                continue
            n = x / sine, y / sine, z / sine
            along = dot(n, way)
            if along < 0.0:
                n, along = (-n[0], -n[1], -n[2]), -along
            if along - reach <= best:
                continue
            highest, lowest = -np.inf, np.inf
            for row in range(polyhedra.first_vertex[a], polyhedra.first_vertex[a + 1]):
                highest = max(highest, dot(n, placed.vertices[row]))
            for row in range(polyhedra.first_vertex[b], polyhedra.first_vertex[b + 1]):
                lowest = min(lowest, dot(n, placed.vertices[row]))
            if lowest - highest > best:
                best = lowest - highest
                put_into(n, normal)
    return best


@kernel_without_allocation
def _support_edge(polyhedra, placed, body, normal, sign):
    """Edge perpendicular to ``normal`` that lies farthest along ``sign`` times it."""
    best, chosen = -np.inf, -1
    for edge in range(polyhedra.first_edge[body], polyhedra.first_edge[body + 1]):
        p, q = placed.vertices[polyhedra.edges[edge, 0]], placed.vertices[polyhedra.edges[edge, 1]]
        lower = min(sign * dot(normal, p), sign * dot(normal, q))
        if lower > best:
            best, chosen = lower, edge
    return chosen


@kernel_without_allocation
def _edge_point_into(polyhedra, placed, a, b, normal, points):
    """Midpoint of the two support edges' common perpendicular; False where they pass each other."""
    edge_a = polyhedra.edges[_support_edge(polyhedra, placed, a, normal, 1.0)]
    edge_b = polyhedra.edges[_support_edge(polyhedra, placed, b, normal, -1.0)]
    p, q = placed.vertices[edge_a[0]], placed.vertices[edge_b[0]]
    u, v = difference(placed.vertices[edge_a[1]], p), difference(placed.vertices[edge_b[1]], q)
    w = difference(q, p)
    uu, uv, vv = dot(u, u), dot(u, v), dot(v, v)
    determinant = uu * vv - uv * uv
    if determinant < _PARALLEL * _PARALLEL * uu * vv:
        return False
    s = (dot(w, u) * vv - dot(w, v) * uv) / determinant
    t = (dot(w, u) * uv - dot(w, v) * uu) / determinant
    if s < 0.0 or s > 1.0 or t < 0.0 or t > 1.0:
        return False
    for axis in range(3):
        points[0, axis] = 0.5 * (p[axis] + s * u[axis] + q[axis] + t * v[axis])
    return True
