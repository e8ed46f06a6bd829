"""Unit quaternions (w, x, y, z) that turn body axes into world axes."""

import numpy as np

from blockshake.jit import kernel_without_allocation


@kernel_without_allocation
def rotation_rows(q):
    """Rows of the rotation matrix of a unit quaternion (w, x, y, z), body to world, as three tuples of three."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


@kernel_without_allocation
def rotation_matrix_into(q, R):
    """Rotation matrix of a unit quaternion (w, x, y, z), body to world, written into ``R`` (3, 3)."""
    first, second, third = rotation_rows(q)
    R[0, 0], R[0, 1], R[0, 2] = first
    R[1, 0], R[1, 1], R[1, 2] = second
    R[2, 0], R[2, 1], R[2, 2] = third


@kernel_without_allocation
def turned(w, x, y, z, rx, ry, rz):
    """Unit quaternion ``w, x, y, z`` turned further by a world-frame rotation vector ``rx, ry, rz`` [rad]."""
    angle = np.sqrt(rx * rx + ry * ry + rz * rz)
    square = angle * angle
    if angle < 1e-4:
        # the series near zero, exact to the last bit: sin(a/2)/a would be 0/0, and the cosine takes long
        c, s = 1.0 - (square / 8.0 - square * square / 384.0), 0.5 - square / 48.0
    else:
        c, s = np.cos(0.5 * angle), np.sin(0.5 * angle) / angle
    ax, ay, az = s * rx, s * ry, s * rz
    nw = c * w - ax * x - ay * y - az * z
    nx = c * x + ax * w + ay * z - az * y
    ny = c * y + ay * w + az * x - ax * z
    nz = c * z + az * w + ax * y - ay * x
    norm = np.sqrt(nw * nw + nx * nx + ny * ny + nz * nz)
    return nw / norm, nx / norm, ny / norm, nz / norm


@kernel_without_allocation
def rotate_into(q, rotation, out):
    """Quaternion ``q`` turned further by a world-frame rotation vector [rad], written into ``out``, which may be ``q``.

    The vector is such as angular velocity times time step. The answer has the same sign branch as ``q``.
    """
    out[0], out[1], out[2], out[3] = turned(q[0], q[1], q[2], q[3], rotation[0], rotation[1], rotation[2])


def rotation_matrices(q):
    """Rotation matrices, shape (..., 3, 3), of unit quaternions (w, x, y, z), shape (..., 4)."""
    w, x, y, z = np.moveaxis(np.asarray(q, dtype=float), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
