"""The largest time step that the joints of a structure allow."""

import numpy as np
from scipy.sparse import block_diag, coo_array
from scipy.sparse.linalg import eigsh


def assembled(pairs, stiffness, size):
    """Sparse matrix (size, size) of the 12 x 12 blocks of pairs of bodies."""
    entries = (6 * pairs[:, :, None] + np.arange(6)).reshape(-1, 12)
    row = np.repeat(entries, 12, axis=1).ravel()
    column = np.tile(entries, (1, 12)).ravel()
    return coo_array((stiffness.ravel(), (row, column)), shape=(size, size)).tocsr()


def stable_time_step(pairs, stiffness, relaxation, bodies):
    """Largest stable time step of the joints at the start [s]; infinite where nothing holds a body.

    Parameters
    ----------
    pairs : int64 array, shape (n_pairs, 2)
    stiffness : float64 array, shape (n_pairs, 12, 12)
        Of the pairs' springs, as from `joint_stiffness`.
    relaxation : float64 array, shape (n_pairs,)
        Of the dashpots beside them [s].
    bodies : Bodies

    Notes
    -----
    With the fastest mode's angular frequency w and fraction of critical damping z, leapfrog whose dashpots see
    ``3/2 v(n-1/2) - 1/2 v(n-3/2)`` is stable while ``w dt <= 2 (sqrt(1 + 4 z^2) - 2 z)``: there the root of its
    characteristic polynomial reaches -1. Joints that close later may allow less.
    """
    free = np.flatnonzero(~bodies.driven)
    chosen = (6 * free[:, None] + np.arange(6)).ravel()
    K, C = (
        assembled(pairs, part, 6 * len(bodies.mass))[chosen][:, chosen]
        for part in (stiffness, stiffness * relaxation[:, None, None])
    )
    if len(free) == 0 or abs(K).max() == 0.0:
        return np.inf
    M = block_diag(
        [block for body in free for block in (bodies.mass[body] * np.eye(3), bodies.inertia[body])],
        format="csc",
    )
    # any vector that no mode is orthogonal to, always the same
    start = np.cos(np.arange(1, len(chosen) + 1))
    value, vector = eigsh(K, k=1, M=M, which="LM", v0=start, tol=1e-3, rng=0)
    frequency, mode = np.sqrt(value[0]), vector[:, 0]
    ratio = mode @ (C @ mode) / (2.0 * frequency * (mode @ (M @ mode)))
    return float(2.0 * (np.sqrt(1.0 + 4.0 * ratio**2) - 2.0 * ratio) / frequency)
