"""Blocks as the eye sees them: outlines and faces, nearest last, in parallel projection."""

import numpy as np

from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.joints import parting_normal


def _turned(azimuth, elevation):
    """Rows: right, up and towards the eye, for an eye at these angles from -y and from the horizon [rad]."""
    (c, s), (e, f) = ((np.cos(angle), np.sin(angle)) for angle in (azimuth, elevation))
    towards = np.array([s * e, -c * e, f])
    right = np.array([c, s, 0.0])
    return np.array([right, np.cross(towards, right), towards])


# front: x to the right; side: from +x, y to the right; far side: from -x; 3d: from the front, the right and above
VIEWS = {
    "front": _turned(0.0, 0.0),
    "side": _turned(0.5 * np.pi, 0.0),
    "far side": _turned(-0.5 * np.pi, 0.0),
    "3d": _turned(np.radians(35.0), np.radians(20.0)),
}
_LIGHT = np.array([-0.35, 0.45, 0.82])  # from the left, above and behind the eye, in axes of the view
_DARKEST = 0.62
_ALONG = 1e-6  # of a normal towards the eye: a face seen edge on hides nothing


class Scene:
    """Faces of the bodies of a structure, seen along a direction.

    Parameters
    ----------
    structure : Structure
    view : str
        One of `VIEWS`.
    shown : sequence of int, optional
        Bodies that are seen, all by default.
    """

    def __init__(self, structure, view, shown=None):
        self._axes = VIEWS[view]
        self.shown = frozenset(range(len(structure.mass)) if shown is None else map(int, shown))
        self._solids = [structure.solid(body) for body in range(len(structure.mass))]
        self._driven = structure.driven

    def seen(self, points):
        """Points, shape (..., 3), to the right, up and towards the eye [m]."""
        return points @ self._axes.T

    def extent(self, position, orientation):
        """Lowest and highest place to the right and up of any corner over all poses, two arrays of shape (2,) [m]."""
        low, high = np.full(2, np.inf), np.full(2, -np.inf)
        for body in self.shown:
            solid = self._solids[body]
            seen = self._axes[:2] @ rotation_matrices(orientation[:, body])
            places = np.einsum("tij,vj->tvi", seen, solid.vertices)
            places += self.seen(position[:, body])[:, None, :2]
            low, high = np.minimum(low, places.min(axis=(0, 1))), np.maximum(high, places.max(axis=(0, 1)))
        return low, high

    def faces(self, position, orientation):
        """Faces that look to the eye, those farther away first.

        Parameters
        ----------
        position, orientation : float64 arrays, shape (n_bodies, 3) and (n_bodies, 4)
            Mass centres [m] and unit quaternions, body to world.

        Returns
        -------
        outlines : list of float64 arrays, shape (n_corners, 2)
            To the right and up [m].
        bodies : list of int
        light : list of float
            1 for a face that looks into the light.
        """
        turns = self._axes @ rotation_matrices(orientation)
        places = self.seen(position)
        corners = [
            solid.vertices @ turn.T + place
            for solid, turn, place in zip(self._solids, turns, places, strict=True)
        ]
        outlines, bodies, light = [], [], []
        for body in filter(self.shown.__contains__, self._farthest_first(places, corners, turns)):
            for outline, normal in self._visible(self._solids[body], corners[body], turns[body]):
                outlines.append(outline)
                bodies.append(body)
                light.append(_DARKEST + (1.0 - _DARKEST) * max(0.0, float(normal @ _LIGHT)))
        return outlines, bodies, light

    def _farthest_first(self, places, corners, turns):
        """Bodies in an order in which none hides one after it, where there is such an order.

        Two convex bodies whose outlines overlap: the one on the eye's side of the face that parts them is nearer.
        """
        left = sorted(range(len(places)), key=lambda body: (not self._driven[body], places[body, 2]))
        low, high = (np.array([end(own[:, :2], axis=0) for own in corners]) for end in (np.min, np.max))
        overlap = ((low[:, None] < high) & (low < high[:, None])).all(axis=2)
        farther = {body: set() for body in left}
        for a, b in np.argwhere(np.triu(overlap, 1)).tolist():
            towards = parting_normal(
                self._solids[a], corners[a], turns[a], self._solids[b], corners[b], turns[b]
            )[2]
            if abs(towards) > _ALONG:  # no number where a body is not convex
                farther[b if towards > 0.0 else a].add(a if towards > 0.0 else b)
        order = []
        while left:
            following = next((body for body in left if not farther[body] & set(left)), left[0])
            left.remove(following)
            order.append(following)
        return order

    def _visible(self, solid, corners, turn):
        """Outlines of the faces that look to the eye, with their unit normals, farther ones first."""
        if solid.polyhedron is not None:
            normals = solid.polyhedron.normals @ turn.T
            faces = solid.polyhedron.faces
        else:
            faces = solid.triangles
            a, b, c = (corners[faces[:, corner]] for corner in range(3))
            normals = np.cross(b - a, c - a)
            normals /= np.linalg.norm(normals, axis=1)[:, None]
        shown = [face for face in range(len(faces)) if normals[face, 2] > 1e-6]
        shown.sort(key=lambda face: corners[faces[face], 2].mean())
        return [(corners[faces[face], :2], normals[face]) for face in shown]
