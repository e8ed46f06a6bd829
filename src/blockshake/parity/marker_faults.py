"""Faults of the markers of one body: wrong place, gain or drift, found one after the other."""

from dataclasses import dataclass, replace

import numpy as np

from blockshake.parity.finding import Finding
from blockshake.parity.linear_faults import Fault, clearest, freed, judge, posterior
from blockshake.parity.marker_equations import (
    DRIFT,
    GAIN,
    PLACE,
    MarkerEquations,
    MarkerFaults,
    marker_equations,
)

# What a sound marker may have beside a drift; its standard deviation is half of it. Places are in m, along any
# direction: markers are mounted within 1 mm along each axis.
_TOLERANCE = {GAIN: 2e-3, PLACE: 2e-3}
_CONSTANT_SPREAD = 5e-3  # m, of the first reading's own error: as good as unknown
_SOUND_MARKERS = 2  # of a body, that must be left without a fault, or nothing says which is at fault
_MOST_FAULTS = 8  # faults on one body
_LINEARISATIONS = 4


@dataclass(frozen=True)
class BodyMarkers:
    """Markers of one body in the tests that are read together.

    Attributes
    ----------
    name : str
    markers : tuple of str
    points : float64 array, shape (n_markers, 3)
        Body frame [m].
    position, rotation : float64 arrays, shapes (3,), (3, 3)
        Pose at rest.
    tests : tuple of str
    readings : list of (time, displacement)
        Of each test, as in `marker_equations`.
    """

    name: str
    markers: tuple
    points: np.ndarray
    position: np.ndarray
    rotation: np.ndarray
    tests: tuple
    readings: list

    @property
    def hypotheses(self):
        """All faults that are looked at."""
        markers = range(len(self.markers))
        single = [Fault(quantity, marker) for quantity in (GAIN, PLACE) for marker in markers]
        return single + [Fault(DRIFT, marker, test) for marker in markers for test in range(len(self.tests))]

    @property
    def sound(self):
        """`MarkerFaults` of sound markers."""
        return MarkerFaults.none(len(self.tests), len(self.markers))

    def columns(self, fault):
        """Unknowns of a fault, after the constants of all tests."""
        constants = 3 * len(self.markers) * len(self.tests)
        return constants + self.sound.columns(fault.quantity, fault.sensor, fault.test)

    def spread(self, drift_tolerance):
        """Standard deviation of each unknown of sound markers, as in `MarkerEquations`."""
        n_tests, n_markers = len(self.tests), len(self.markers)
        return np.repeat(
            [_CONSTANT_SPREAD, drift_tolerance / 2.0, _TOLERANCE[GAIN] / 2.0, _TOLERANCE[PLACE] / 2.0],
            [3 * n_markers * n_tests, 3 * n_markers * n_tests, n_markers, 3 * n_markers],
        )


@dataclass(frozen=True)
class MarkerCheck:
    """Outcome for one body: faults, findings, and the equations after the faults were taken out."""

    faults: MarkerFaults
    findings: tuple
    equations: MarkerEquations


def check_body(body, marker_noise, level):
    """Name the faults of a body's markers, the clearest first, until what is left is within the tolerances.

    Parameters
    ----------
    body : BodyMarkers
    marker_noise : float
        Stated standard deviation [m]: the drift over a record that is tolerated.
    level : Level

    Returns
    -------
    MarkerCheck
    """
    tolerance = _TOLERANCE | {DRIFT: marker_noise}
    faults, named = body.sound, {}
    while True:
        spread = freed(body.spread(marker_noise), map(body.columns, named))
        faults, equations = _linearised(body, faults, spread, named)
        if not np.isfinite(equations.variance):
            return MarkerCheck(faults, (), equations)
        open_to = {
            fault: (body.columns(fault), tolerance[fault.quantity], 1)
            for fault in body.hypotheses
            if fault not in named
        }
        suspects = {fault.sensor for fault in named}
        full = len(suspects) >= len(body.markers) - _SOUND_MARKERS
        best = clearest(
            judge(equations, spread, open_to, level), level, body.markers,
            lambda fault, full=full, suspects=suspects: not full or fault.sensor in suspects,
        )  # fmt: skip
        if best is None or len(named) == _MOST_FAULTS:
            covariance = posterior(equations, spread)[1]
            findings = [_finding(body, faults, covariance, fault, *said) for fault, said in named.items()]
            return MarkerCheck(faults, tuple(findings), equations)
        named[best[0]] = best[1:]


def _linearised(body, faults, spread, named):
    """Faults with the named ones at their best, and the equations about them."""
    equations = marker_equations(body.points, body.position, body.rotation, body.readings, faults)
    for _ in range(_LINEARISATIONS if named else 0):
        mean, values = posterior(equations, spread)[0], faults.values.copy()
        for fault in named:
            columns = body.columns(fault)
            values[columns - len(mean)] += mean[columns]
        faults = replace(faults, values=values)
        equations = marker_equations(body.points, body.position, body.rotation, body.readings, faults)
    return faults, equations


def _finding(body, faults, covariance, fault, p, rivals):
    """The finding with the estimate and covariance that hold with all that is named."""
    quantity, marker, test = fault
    covariance = covariance[np.ix_(body.columns(fault), body.columns(fault))]
    if quantity == DRIFT:
        length = np.ptp(body.readings[test][0])
        estimate, covariance = faults.drift[test, marker] / length, covariance / length**2
    else:
        estimate = np.atleast_1d(faults.gain[marker] if quantity == GAIN else faults.place[marker])
    tests = (body.tests[test],) if quantity == DRIFT else body.tests
    return Finding.of(quantity, (body.markers[marker],), p, tests, estimate, covariance, rivals)
