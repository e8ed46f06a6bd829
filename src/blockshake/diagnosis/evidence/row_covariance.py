"""Covariance of a test's rows: the sensors through the smoothing kernel, and errors of the joints' own model."""

import numpy as np

_LEVER, _LEVER_MEMORY, _LEVER_WHITE = 0.001, 0.3, 0.0003  # m, s, m: of the point where a turned face bears
_FRICTION = 0.04  # of the coefficient of a slipping face: as much coloured and as much white
_FORM = 0.04  # of a cause's own rows: as much coloured and as much white
_RIDGE = 1e-5  # of every variance, for the factorisation


def row_covariance(test, noise, discrepancy):
    """Covariance matrix of the rows of one test, (n_rows, n_rows).

    Parameters
    ----------
    test : JointRows
    noise : float
        Standard deviation of the sensors over the stated one [1].
    discrepancy : float
        The joints' own errors over the usual ones [1].

    Notes
    -----
    Every sensor's noise goes on from instant to instant as its `Colour` does under the kernel. The errors of levers and
    of friction are Ornstein-Uhlenbeck processes with white ones.
    """
    rows = test.rows
    apart = np.abs(rows.time[:, None] - rows.time)
    covariance = sum(
        (noise**2 * errors @ errors.T) * colour.correlation(apart, test.seen.motion.width)
        for colour, errors in rows.noise.items()
    )
    coloured, same = np.exp(-apart / _LEVER_MEMORY), apart < 1e-9
    lever = discrepancy**2 * (_LEVER**2 * coloured + _LEVER_WHITE**2 * same)
    friction = (discrepancy * _FRICTION) ** 2 * (coloured + same)
    for hinge in test.hinges.values():
        covariance += np.outer(hinge.inward, hinge.inward) * lever
    for face, slide in test.slides.items():
        usual = test.seen.faces[face].friction * slide.friction
        covariance += np.outer(usual, usual) * friction
    covariance[np.diag_indices(len(covariance))] *= 1.0 + _RIDGE
    return covariance


def form_error(time, force):
    """Covariance of the part of rows that a cause's form leaves unexplained, (n_rows, n_rows).

    ``time`` and ``force`` (n_rows,) are those of the rows, and of the cause in them at its best.
    """
    apart = np.abs(time[:, None] - time)
    return (_FORM * np.outer(force, force)) * _FORM * (np.exp(-apart / _LEVER_MEMORY) + (apart < 1e-9))
