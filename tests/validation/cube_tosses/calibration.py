"""Friction and restitution from some tosses, by a grid and a finer one about its best point."""

from dataclasses import dataclass

import numpy as np
from flight import initial_state
from replay import replay
from scores import score

FRICTION = (0.10, 0.14, 0.18, 0.22, 0.26)
RESTITUTION = (0.02, 0.15, 0.30)  # C_res of 0 would be critical damping
_FINER = 0.02, 0.065  # half of the grid's steps


@dataclass(frozen=True)
class Fit:
    """Best ``friction`` and ``restitution``; ``table`` of {(friction, restitution): path errors, one a toss [m]}."""

    friction: float
    restitution: float
    table: dict

    @property
    def error(self):
        """Mean path error at the best point [m]."""
        return float(np.mean(self.table[self.friction, self.restitution]))


def path_errors(tosses, model, friction, restitution, cube, **options):
    """Mean over the readings of the corners' rms distance, for each toss [m]."""
    starts = [initial_state(toss, cube.mass_centre) for toss in tosses]
    runs = [
        replay(toss, model, friction, restitution, cube, start, **options)
        for toss, start in zip(tosses, starts, strict=True)
    ]
    return np.array([score(toss, run).corners.mean() for toss, run in zip(tosses, runs, strict=True)])


def fit(tosses, model, cube):
    """Point of the grid, refined once, with the least mean of `path_errors`.

    A grid rather than a descent: after an impact or two the paths part, and the mean of 60 of them is rough in small.
    """
    table = {}
    _fill(table, [(mu, e) for mu in FRICTION for e in RESTITUTION], tosses, model, cube)
    mu, e = _best(table)
    finer = [(mu + i * _FINER[0], e + j * _FINER[1]) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    _fill(table, [(mu, e) for mu, e in finer if e > 0.0], tosses, model, cube)
    return Fit(*_best(table), table)


def _best(table):
    return min(table, key=lambda point: table[point].mean())


def _fill(table, points, tosses, model, cube):
    for mu, e in points:
        point = round(mu, 4), round(e, 4)
        if point not in table:
            table[point] = path_errors(tosses, model, *point, cube)
