"""Pose of one body in the frame of another; of two boxes face to face, the flats that meet and where, on a fine raster.

The raster makes the areas of a joint's nodes a function of where the bodies stand, not of how they came there, and so
independent of when the lists of near nodes were made.
"""

from typing import NamedTuple

import numpy as np

from blockshake.geometry.vectors import difference, dot, transposed_product
from blockshake.jit import kernel_without_allocation

_PARALLEL = 0.94  # cosine of 20 degrees: boxes turned further against each other meet at edges
_RASTER = 1e-3  # steps of the raster, over the narrowest width of the two flats
N_KEY = 4


class Poses(NamedTuple):
    """Poses now, a step before, and another step earlier, world frame.

    ``position``, ``position_before``, ``position_earlier`` (n_bodies, 3) [m]; ``rotation``, ``rotation_before``,
    ``rotation_earlier`` (n_bodies, 3, 3), body to world.
    """

    position: np.ndarray
    rotation: np.ndarray
    position_before: np.ndarray
    rotation_before: np.ndarray
    position_earlier: np.ndarray
    rotation_earlier: np.ndarray


def poses_at_rest(position, rotation):
    """`Poses` of bodies that were where they are."""
    return Poses(position, rotation, position.copy(), rotation.copy(), position.copy(), rotation.copy())


@kernel_without_allocation
def keep_poses(poses):
    """Make the poses now those of the step before."""
    for body in range(poses.position.shape[0]):
        for i in range(3):
            poses.position_earlier[body, i] = poses.position_before[body, i]
            poses.position_before[body, i] = poses.position[body, i]
            for j in range(3):
                poses.rotation_earlier[body, i, j] = poses.rotation_before[body, i, j]
                poses.rotation_before[body, i, j] = poses.rotation[body, i, j]


@kernel_without_allocation
def relative_pose_into(position, rotation, offset, pair, shift, R, d):
    """Pose of each body of a pair in the frame of the other's shape, whose origin is the shape's centroid.

    The owner of side 0 is the pair's first body, that of side 1 the second, whose axes in the first's frame are the
    columns of ``R`` (3, 3). The owner's mass centre is ``d[side]`` (3,); ``offset`` as in `Surfaces`, ``shift`` (3,) as
    in `NearPairs`.
    """
    a, b = pair[0], pair[1]
    of_first = transposed_product(rotation[b], difference(position[a], position[b]))
    of_second = transposed_product(rotation[a], difference(position[b], position[a]))
    for i in range(3):
        for j in range(3):
            R[i, j] = (
                rotation[a, 0, i] * rotation[b, 0, j]
                + rotation[a, 1, i] * rotation[b, 1, j]
                + rotation[a, 2, i] * rotation[b, 2, j]
            )
        d[0, i] = of_first[i] + offset[b, i] + shift[i]
        d[1, i] = of_second[i] + offset[a, i] - dot(R[i], shift)


class Facing(NamedTuple):
    """How a box lies on another, by the flats that meet, in the plane of the first box's flat.

    ``axis_a``, ``axis_b``: body axes along the flats' normals; ``sign_a``, ``sign_b`` 1.0 or -1.0: at which end.
    The plane's axes are the two axes of the first body that follow ``axis_a``. ``u``, ``v``: middle of the second's
    flat [m]; ``cosine``, ``sine``: direction of the body axis that follows ``axis_b``; ``step``: of the raster [m].
    """

    axis_a: int
    sign_a: float
    axis_b: int
    sign_b: float
    u: float
    v: float
    cosine: float
    sine: float
    step: float


@kernel_without_allocation
def facing_key(surfaces, a, b, R, d):
    """Position on the raster of body ``b`` as ``a`` sees it: four whole numbers, the first -1 where no flats meet.

    ``R`` (3, 3) and ``d`` (2, 3) are those of `relative_pose_into`. The numbers are the code of axes, ends and quarter
    turn; the middle along both axes of the plane, and the turn, in steps.

    Notes
    -----
    Two bodies meet on the pair of flats, parallel within 20 degrees, that is farthest apart along its normal, or
    overlaps least.
    """
    shape_a, shape_b = surfaces.shape[a], surfaces.shape[b]
    if surfaces.wide[shape_a] == 0.0 or surfaces.wide[shape_b] == 0.0:
        return -1, 0, 0, 0
    half_a, half_b, offset = surfaces.half[shape_a], surfaces.half[shape_b], surfaces.offset[b]
    gap, axis_a, axis_b = -np.inf, -1, -1
    for i in range(3):
        for j in range(3):
            if abs(R[j, i]) > _PARALLEL:
                centre = d[1, j] - R[j, 0] * offset[0] - R[j, 1] * offset[1] - R[j, 2] * offset[2]
                apart = abs(centre) - half_a[j] - half_b[i]
                if apart > gap:
                    gap, axis_a, axis_b = apart, j, i
    if axis_a < 0:
        return -1, 0, 0, 0
    p, q, r = (axis_a + 1) % 3, (axis_a + 2) % 3, (axis_b + 1) % 3
    height = R[axis_a, 0] * offset[0] + R[axis_a, 1] * offset[1] + R[axis_a, 2] * offset[2]
    above = d[1, axis_a] - height > 0.0
    # the end of b whose normal points at a
    upper = (R[axis_a, axis_b] > 0.0) != above
    reach = half_b[axis_b] if upper else -half_b[axis_b]
    u, v = d[1, p] + R[p, axis_b] * reach, d[1, q] + R[q, axis_b] * reach
    for k in range(3):
        u -= R[p, k] * offset[k]
        v -= R[q, k] * offset[k]
    step, turn_step = _raster(surfaces, shape_a, shape_b, axis_a, axis_b)
    cosine, sine = R[p, r], R[q, r]
    along = abs(cosine) >= abs(sine)
    quarter = (0 if cosine > 0.0 else 1) if along else (2 if sine > 0.0 else 3)
    small = sine if along else cosine
    ends = (1 if above else 0) + (2 if upper else 0)
    code = ((axis_a * 3 + axis_b) * 4 + ends) * 4 + quarter
    return (
        code,
        np.int64(np.floor(u / step + 0.5)),
        np.int64(np.floor(v / step + 0.5)),
        np.int64(np.floor(small / turn_step + 0.5)),
    )


@kernel_without_allocation
def facing_of(surfaces, a, b, key):
    """The `Facing` of a key that is not -1."""
    code = key[0]
    quarter, ends, axes = code % 4, (code // 4) % 4, code // 16
    axis_a, axis_b = axes // 3, axes % 3
    step, turn_step = _raster(surfaces, surfaces.shape[a], surfaces.shape[b], axis_a, axis_b)
    small = key[3] * turn_step
    large = np.sqrt(max(1.0 - small * small, 0.0))
    if quarter % 2 == 1:
        large = -large
    cosine, sine = (large, small) if quarter < 2 else (small, large)
    return Facing(
        axis_a, 1.0 if ends % 2 == 1 else -1.0, axis_b, 1.0 if ends >= 2 else -1.0,
        key[1] * step, key[2] * step, cosine, sine, step,
    )  # fmt: skip


@kernel_without_allocation
def _raster(surfaces, shape_a, shape_b, axis_a, axis_b):
    """Step of the raster [m], and that of the sine of the turn, which moves the smaller flat's corners as far."""
    half_a, half_b = surfaces.half[shape_a], surfaces.half[shape_b]
    p, q, r, s = (axis_a + 1) % 3, (axis_a + 2) % 3, (axis_b + 1) % 3, (axis_b + 2) % 3
    step = 2.0 * _RASTER * min(min(half_a[p], half_a[q]), min(half_b[r], half_b[s]))
    corner = min(half_a[p] * half_a[p] + half_a[q] * half_a[q], half_b[r] * half_b[r] + half_b[s] * half_b[s])
    return step, step / np.sqrt(corner)
