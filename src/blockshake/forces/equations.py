"""Linear equations for the acceleration of every body at every time, gathered as information."""

import numpy as np

from blockshake.forces.kernel_noise import Colour

_WHITE = Colour(True, 0.0)
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
        self.noisy = [[] for _ in range(n_bodies)]

    def add(self, body, directions, arm, values, noise):
        """Add readings ``d . (a + alpha x arm) = value`` of one body.

        Parameters
        ----------
        body : int
        directions : float64 array, shape (n_times, n_rows, 3)
            Unit vectors d, world frame.
        arm : float64 array, shape (n_times, 3)
            Of the sensor from the mass centre, world frame [m].
        values : float64 array, shape (n_times, n_rows)
            [m/s2]; a row with a value that is not finite is left out.
        noise : dict of Colour to float64 array, shape (n_times, n_rows)
            Standard deviations of independent parts [m/s2].
        """
        rows = np.concatenate([directions, np.cross(arm[:, None], directions)], axis=-1)
        variances = sum(part**2 for part in noise.values())
        known = np.isfinite(values) & np.isfinite(variances) & np.isfinite(rows).all(axis=-1)
        weight = np.where(known, 1.0 / np.where(known, variances, 1.0), 0.0)
        rows = np.where(known[..., None], rows, 0.0)
        self.information[:, body] += np.einsum("tri,tr,trj->tij", rows, weight, rows)
        self.weighted[:, body] += np.einsum("tri,tr,tr->ti", rows, weight, np.where(known, values, 0.0))
        noise = {colour: np.where(known, part, 0.0) for colour, part in noise.items()}
        self.noisy[body].append((rows * weight[..., None], noise))

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
        What is held is left out of the search for directions that are read: with it rough readings would pass for
        none.
        """
        values, vectors, read = self._directions()
        inverse = np.where(read, 1.0 / np.where(read, values, 1.0), 0.0)
        solved = np.einsum("tbij,tbj,tbkj,tbk->tbi", vectors, inverse, vectors, self.weighted, optimize=True)
        solved[~read.any(axis=-1)] = np.nan
        information = np.einsum("tbij,tbj,tbkj->tbik", vectors, np.where(read, values, 0.0), vectors)
        body, entry = np.nonzero(self.held)
        information[:, body, entry, entry] = _HELD**-2
        return solved, information

    def _directions(self):
        """Eigenvalues and eigenvectors of the information on what is not held, and whether they are read."""
        free = ~(self.held[:, :, None] | self.held[:, None, :])
        values, vectors = np.linalg.eigh(np.where(free, self.information, 0.0))
        return values, vectors, values > _UNREAD * values[..., -1:]

    def errors(self):
        """Errors of the solved accelerations by one standard deviation of every sensor's noise.

        Returns
        -------
        list of dict of Colour to float64 array, shape (n_times, 6, n_sources)
            By body.
        """
        values, vectors, read = self._directions()
        inverse = np.where(read, 1.0 / np.where(read, values, 1.0), 0.0)
        covariance = np.einsum("tbij,tbj,tbkj->btik", vectors, inverse, vectors)
        by_body = []
        for body, (noisy, held) in enumerate(zip(self.noisy, self.held, strict=True)):
            own = _HELD * np.eye(6)[:, held]
            parts = {_WHITE: [np.broadcast_to(own, (len(values), *own.shape))]}
            for rows, noise in noisy:
                gains = np.einsum("tij,trj->tir", covariance[body], rows)
                for colour, part in noise.items():
                    parts.setdefault(colour, []).append(gains * part[:, None])
            by_body.append({colour: np.concatenate(part, axis=-1) for colour, part in parts.items()})
        return by_body
