"""Products of three numbers, without arrays in between: vectors are anything with three entries, answers are tuples."""

from blockshake.jit import kernel_without_allocation


@kernel_without_allocation
def matrix_product(A, x):
    """``A x`` for a matrix of three rows and columns."""
    return (
        A[0, 0] * x[0] + A[0, 1] * x[1] + A[0, 2] * x[2],
        A[1, 0] * x[0] + A[1, 1] * x[1] + A[1, 2] * x[2],
        A[2, 0] * x[0] + A[2, 1] * x[1] + A[2, 2] * x[2],
    )


@kernel_without_allocation
def transposed_product(A, x):
    """``A^T x``: world to body for a rotation; to the world from a contact's basis, whose rows are its axes."""
    return (
        A[0, 0] * x[0] + A[1, 0] * x[1] + A[2, 0] * x[2],
        A[0, 1] * x[0] + A[1, 1] * x[1] + A[2, 1] * x[2],
        A[0, 2] * x[0] + A[1, 2] * x[1] + A[2, 2] * x[2],
    )


@kernel_without_allocation
def cross(x, y):
    """``x`` cross ``y``."""
    return (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])


@kernel_without_allocation
def dot(x, y):
    """``x`` times ``y``."""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


@kernel_without_allocation
def difference(x, y):
    """``x`` less ``y``."""
    return x[0] - y[0], x[1] - y[1], x[2] - y[2]


@kernel_without_allocation
def add_impulse_into(sign, f, arm, total):
    """Add ``sign`` times an impulse, or a force, at ``arm``, and its moment, to ``total`` (6,)."""
    moment = cross(arm, f)
    for axis in range(3):
        total[axis] += sign * f[axis]
        total[3 + axis] += sign * moment[axis]


@kernel_without_allocation
def rows_product(rows, x):
    """``R x`` for a matrix given by its rows, three tuples."""
    return dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)


@kernel_without_allocation
def columns_product(rows, x):
    """``R^T x`` for a matrix given by its rows, three tuples."""
    first, second, third = rows
    return (
        first[0] * x[0] + second[0] * x[1] + third[0] * x[2],
        first[1] * x[0] + second[1] * x[1] + third[1] * x[2],
        first[2] * x[0] + second[2] * x[1] + third[2] * x[2],
    )


@kernel_without_allocation
def put_into(x, out):
    """Copy three numbers into an array."""
    out[0], out[1], out[2] = x[0], x[1], x[2]


@kernel_without_allocation
def tensor_in_world_into(R, A, out):
    """``R A R^T``: a symmetric body-frame tensor in the world frame, written into ``out``."""
    for i in range(3):
        row = transposed_product(A, R[i])
        for j in range(3):
            out[i, j] = row[0] * R[j, 0] + row[1] * R[j, 1] + row[2] * R[j, 2]


@kernel_without_allocation
def velocity_at(v, arm):
    """Velocity [m/s] of a body's point at ``arm`` from its mass centre; ``v`` (6,): velocity and spin."""
    return (
        v[0] + v[4] * arm[2] - v[5] * arm[1],
        v[1] + v[5] * arm[0] - v[3] * arm[2],
        v[2] + v[3] * arm[1] - v[4] * arm[0],
    )


@kernel_without_allocation
def copy_into(given, out):
    """Write an array of one to three dimensions over another one, or over the first entries of one with more room."""
    if given.ndim == 1:
        for i in range(given.shape[0]):
            out[i] = given[i]
    elif given.ndim == 2:
        for i in range(given.shape[0]):
            for j in range(given.shape[1]):
                out[i, j] = given[i, j]
    else:
        for i in range(given.shape[0]):
            for j in range(given.shape[1]):
                for k in range(given.shape[2]):
                    out[i, j, k] = given[i, j, k]
