"""Geometric tolerances of undamaged blocks, marginalised with every cause.

Each is a column of the rows times its standard deviation, marginalised in closed form.
"""

from dataclasses import dataclass

import numpy as np

from blockshake.forces.joint_motion import TURNED

# m, mean by which edges lie further in than in the structure file : chamfers and contact nodes
INWARD = 0.005
_ALL_INWARD, _INWARD, _ALONG, _ALONG_OF_TEST = 0.006, 0.003, 0.001, 0.001  # m
_GROWTH, _GROWTH_AT = 0.0015, 0.01  # m by this rotation: edges are rounded
_CLOSING, _CLOSING_AT = 0.006, 0.001  # m, rad: elastic faces bear wider the less they have turned
_BARELY = 1.5  # power of one over the rotation by which a face just opened comes to bear on its edge
_ECCENTRIC, _MASS = 0.001, 0.025  # m; of each block's mass
_PAIR, _JOINT, _RISE, _RISE_AT = 0.12, 0.05, 0.05, 0.03  # of the coefficient; m/s
_SMALLEST_TURN, _MOST_RISE = 1e-5, 2.0
_MOST_OF_MASS = 0.3  # of a block's mass, beyond which a change is no tolerance


@dataclass(frozen=True)
class Nuisance:
    """A tolerance of undamaged blocks."""

    columns: list  # of float64 array, shape (n_rows,); by test, times the standard deviation of the amplitude
    most: float = np.inf  # magnitude of the amplitude that no structure exceeds, in standard deviations


def nuisances_of(tests):
    """`Nuisance` of all tolerances that show in any row."""
    every = [*map(Nuisance, _of_edges(tests)), *map(Nuisance, _of_friction(tests)), *_of_masses(tests)]
    return [one for one in every if any(rows.any() for rows in one.columns)]


def possible(nuisances, amplitudes):
    """Those of some `Nuisance` whose amplitudes (n_nuisances,) a structure may have."""
    return [one for one, size in zip(nuisances, amplitudes, strict=True) if abs(size) <= one.most]


def expected_rows(test):
    """Rows of edges that lie further in by the usual amount, (n_rows,)."""
    return sum((INWARD * hinge.inward for hinge in test.hinges.values()), np.zeros(len(test.rows.value)))


def _of_edges(tests):
    keys = sorted({key for test in tests for key in test.hinges})
    yield [sum((_ALL_INWARD * h.inward for h in test.hinges.values()), _zero(test)) for test in tests]
    for key in keys:
        yield _by_test(tests, key, lambda h: _INWARD * h.inward)
        yield _by_test(tests, key, lambda h: _ALONG * h.along)
        yield _by_test(tests, key, lambda h: _GROWTH * h.inward * h.turn / _GROWTH_AT)
        yield _by_test(tests, key, lambda h: _CLOSING * h.inward * _closing(h.turn))
        yield _by_test(tests, key, lambda h: h.inward * h.bed * _barely_turned(h.turn))
        for placed_anew in tests:
            moved = _by_test(tests, key, lambda h: _ALONG_OF_TEST * h.along)
            yield [
                rows if test is placed_anew else _zero(test) for test, rows in zip(tests, moved, strict=True)
            ]


def _closing(turn):
    return np.minimum(1.0, _CLOSING_AT / np.maximum(turn, _SMALLEST_TURN))


def _barely_turned(turn):
    """Share of the bed's inset that is left at a rotation.

    A continuous bed keeps one over its root; a face that touches at few rows of points, one over its square.
    """
    return np.minimum(1.0, TURNED / np.maximum(turn, _SMALLEST_TURN)) ** _BARELY


def _by_test(tests, key, rows):
    return [rows(test.hinges[key]) if key in test.hinges else _zero(test) for test in tests]


def _of_friction(tests):
    faces = tests[0].seen.faces
    slipping = sorted({face for test in tests for face in test.slides})
    for face in slipping:
        mu = faces[face].friction
        yield [_JOINT * mu * _slides(test, [face], lambda slide: slide.friction) for test in tests]
        yield [
            _RISE * mu * _slides(test, [face], lambda slide: slide.friction * _rise(slide.rate))
            for test in tests
        ]
    for mu in sorted({faces[face].friction for face in slipping}):
        alike = [face for face in slipping if faces[face].friction == mu]
        yield [_PAIR * mu * _slides(test, alike, lambda slide: slide.friction) for test in tests]


def _rise(rate):
    return np.minimum(rate / _RISE_AT, _MOST_RISE)


def _slides(test, faces, rows):
    return sum((rows(test.slides[face]) for face in faces if face in test.slides), _zero(test))


def _of_masses(tests):
    for body in tests[0].seen.free:
        yield Nuisance([_ECCENTRIC * test.eccentric[int(body)] for test in tests])
        yield Nuisance([_MASS * test.heavier[int(body)] for test in tests], _MOST_OF_MASS / _MASS)


def _zero(test):
    return np.zeros(len(test.rows.value))
