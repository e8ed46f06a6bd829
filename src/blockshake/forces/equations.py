"""Linear equations for the acceleration of every body at every time, gathered as information."""

import numpy as np

_UNREAD = 1e-9  # of the largest eigenvalue, in units of a metre's arm: a direction that no sensor reads
_HELD = 1e-3  # m/s2, rad/s2: standard deviation of what is taken as none


class AccelerationEquations:
    """Information on the acceleration and angular acceleration of bodies, summed over sensors.

    Parameters
    ----------
    n_times, n_bodies : int
    """

    def __init__(self, n_times, n_bodies):
        self.information = np.zeros((n_times, n_bodies, 6, 6))
        self.weighted = np.zeros((n_times, n_bodies, 6))
        self.held = np.zeros((n_bodies, 6), dtype=bool)

    def add(self, body, directions, arm, values, variances):
        """Add readings ``d . (a + alpha x arm) = value`` of one body.

        Parameters
        ----------
        body : int
        directions : float64 array, shape (n_times, n_rows, 3)
            Unit vectors d, world frame.
        arm : float64 array, shape (n_times, 3)
            Of the sensor from the mass centre, world frame [m].
        values, variances : float64 arrays, shape (n_times, n_rows)
            [m/s2, m2/s4]; a row with a value that is not finite is left out.
        """
        rows = np.concatenate([directions, np.cross(arm[:, None], directions)], axis=-1)
        known = np.isfinite(values) & np.isfinite(variances) & np.isfinite(rows).all(axis=-1)
        weight = np.where(known, 1.0 / np.where(known, variances, 1.0), 0.0)
        rows = np.where(known[..., None], rows, 0.0)
        self.information[:, body] += np.einsum("tri,tr,trj->tij", rows, weight, rows)
        self.weighted[:, body] += np.einsum("tri,tr,tr->ti", rows, weight, np.where(known, values, 0.0))

    def hold(self, bodies, entries):
        """Take entries of the six accelerations of bodies as none."""
        self.held[np.ix_(bodies, entries)] = True

    def solve(self):
        """Least squares.

        Returns
        -------
        accelerations : float64 array, shape (n_times, n_bodies, 6)
            Of the mass centre [m/s2] and of the rotation [rad/s2]; NaN where nothing is read.
        information : float64 array, shape (n_times, n_bodies, 6, 6)
            Their inverse covariance, without the directions that no sensor reads.

        Notes
        -----
        What is held is left out of the search for directions that are read: beside it rough readings would pass for
        none.
        """
        free = ~(self.held[:, :, None] | self.held[:, None, :])
        values, vectors = np.linalg.eigh(np.where(free, self.information, 0.0))
        read = values > _UNREAD * values[..., -1:]
        inverse = np.where(read, 1.0 / np.where(read, values, 1.0), 0.0)
        solved = np.einsum("tbij,tbj,tbkj,tbk->tbi", vectors, inverse, vectors, self.weighted, optimize=True)
        solved[~read.any(axis=-1)] = np.nan
        information = np.einsum("tbij,tbj,tbkj->tbik", vectors, np.where(read, values, 0.0), vectors)
        body, entry = np.nonzero(self.held)
        information[:, body, entry, entry] = _HELD**-2
        return solved, information
