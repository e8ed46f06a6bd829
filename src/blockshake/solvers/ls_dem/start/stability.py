"""The largest time step that the joints of a structure allow."""

import numpy as np
from scipy.sparse import block_diag
from scipy.sparse.linalg import eigsh


def stable_time_step(stiffness, damping, bodies, solved):
    """Largest stable time step of the joints at the start [s]; infinite where nothing holds a body.

    Parameters
    ----------
    stiffness, damping : scipy sparse arrays, shape (6 n_solved, 6 n_solved)
        Of the free bodies' displacements and rotations; what the dashpots give.
    bodies : Bodies
    solved : int array, shape (n_solved,)
        The free bodies.

    Notes
    -----
    With the fastest mode's angular frequency w and fraction of critical damping z, leapfrog whose dashpots see
    ``3/2 v(n-1/2) - 1/2 v(n-3/2)`` is stable while ``w dt <= 2 (sqrt(1 + 4 z^2) - 2 z)``: there the root of its
    characteristic polynomial reaches -1. Joints that close later may allow less.
    """
    mass = block_diag(
        [
            block
            for body in solved
            for block in (bodies.mass[body] * np.eye(3), bodies.inertia[body])
        ],
        format="csc",
    )  # fmt: skip
    if len(solved) == 0 or abs(stiffness).max() == 0.0:
        return np.inf
    start = np.cos(
        np.arange(1, 6 * len(solved) + 1)
    )  # any vector that no mode is orthogonal to, always the same
    value, vector = eigsh(stiffness, k=1, M=mass, which="LM", v0=start, tol=1e-3, rng=0)
    frequency, mode = np.sqrt(value[0]), vector[:, 0]
    ratio = mode @ (damping @ mode) / (2.0 * frequency * (mode @ (mass @ mode)))
    return float(2.0 * (np.sqrt(1.0 + 4.0 * ratio**2) - 2.0 * ratio) / frequency)
