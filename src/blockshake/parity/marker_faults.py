"""Faults of the markers of one body: wrong place, gain or drift, found one after the other."""

from dataclasses import dataclass

import numpy as np

from blockshake.parity.finding import Finding, chance_within
from blockshake.parity.marker_equations import (
    DRIFT,
    GAIN,
    PLACE,
    MarkerEquations,
    MarkerFaults,
    columns,
    marker_equations,
)
from blockshake.parity.posterior import VAGUE, data_alone, posterior

# What a sound marker may have; its standard deviation is half of it.
GAIN_TOLERANCE = 2e-3
PLACE_TOLERANCE = 2e-3  # m, along any direction; markers are mounted within 1 mm along each axis
_CONSTANT_SPREAD = 5e-3  # m, of the first reading's own error: as good as unknown
_SOUND_MARKERS_NEEDED = (
    2  # markers of a body that must be left without a fault, or nothing says which is at fault
)
_MOST_FAULTS = 8  # faults on one body
_LINEARISATIONS = 4
_GAIN_OVER_RIVALS = 9.0  # less in the sum of weighted squares than the best: not told apart
_EFFECTS = {DRIFT: "sensor-drift", GAIN: "sensor-gain", PLACE: "marker-offset"}


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

    def equations(self, faults):
        """Equations about these faults."""
        return marker_equations(self.points, self.position, self.rotation, self.readings, faults)

    def without_faults(self):
        """Faults of sound markers."""
        return MarkerFaults.none(len(self.tests), len(self.markers))

    @property
    def hypotheses(self):
        """All (kind, marker, test) that are looked at."""
        count = range(len(self.markers))
        single = [(kind, marker, 0) for kind in (GAIN, PLACE) for marker in count]
        return single + [(DRIFT, marker, test) for marker in count for test in range(len(self.tests))]


@dataclass(frozen=True)
class MarkerCheck:
    """Outcome for one body: faults, findings, and the equations after the faults were taken out."""

    faults: MarkerFaults
    findings: tuple
    equations: MarkerEquations


def prior_spread(body, drift_tolerance):
    """Standard deviation of each parameter of sound markers, in the order of `columns`."""
    n_tests, n_markers = len(body.tests), len(body.markers)
    return np.concatenate(
        [
            np.full(3 * n_markers * n_tests, _CONSTANT_SPREAD),
            np.full(3 * n_markers * n_tests, drift_tolerance / 2.0),
            np.full(n_markers, GAIN_TOLERANCE / 2.0),
            np.full(3 * n_markers, PLACE_TOLERANCE / 2.0),
        ]
    )


def check_body(body, marker_noise, level, looked_at):
    """Name the faults of a body's markers, the clearest first, until what is left is within the tolerances.

    Parameters
    ----------
    body : BodyMarkers
    marker_noise : float
        Stated standard deviation [m]: the drift over a record that is tolerated.
    level : float
        Of all hypotheses together.
    looked_at : int
        Number of hypotheses in the campaign.

    Returns
    -------
    MarkerCheck
    """
    faults, named, findings = body.without_faults(), [], []
    spread = prior_spread(body, marker_noise)
    while True:
        for _ in range(_LINEARISATIONS if named else 1):
            equations = body.equations(faults)
            if not named:
                break
            mean = posterior(equations, _freed(body, spread, named))[0]
            change = np.zeros(len(mean))
            for hypothesis in named:
                place = _places(body, hypothesis)
                change[place] = mean[place]
            faults = faults.plus(change[3 * len(body.markers) * len(body.tests) :])
        if not np.isfinite(equations.variance):
            return MarkerCheck(faults, (), equations)
        findings = [
            _updated(body, faults, equations, spread, named, hypothesis, finding)
            for hypothesis, finding in zip(named, findings, strict=True)
        ]
        judged = _judge(body, equations, _freed(body, spread, named), marker_noise, named)
        suspects = {marker for _, marker, _ in named}
        full = len(suspects) >= len(body.markers) - _SOUND_MARKERS_NEEDED
        clear = [
            item
            for item in judged
            if item[1] * looked_at < level and not (full and item[2][1] not in suspects)
        ]
        if not clear or len(named) == _MOST_FAULTS:
            return MarkerCheck(faults, tuple(findings), equations)
        best = max(clear, key=lambda item: item[0])
        rivals = [
            (_EFFECTS[h[0]], (body.markers[h[1]],), h[0])
            for gained, _, h in judged
            if h[:2] != best[2][:2] and best[0] - gained < _GAIN_OVER_RIVALS
        ]
        named.append(best[2])
        findings.append((best[1] * looked_at, tuple(rivals)))


def _places(body, hypothesis):
    kind, marker, test = hypothesis
    return columns(kind, len(body.tests), len(body.markers), marker, test)


def _freed(body, spread, named):
    spread = spread.copy()
    for hypothesis in named:
        spread[_places(body, hypothesis)] *= VAGUE
    return spread


def _judge(body, equations, spread, drift_tolerance, named):
    """(gain in the sum of squares less twice the parameters, chance within the tolerance, hypothesis) of each."""
    mean, covariance = posterior(equations, spread)
    tolerance = {GAIN: GAIN_TOLERANCE, PLACE: PLACE_TOLERANCE, DRIFT: drift_tolerance}
    judged = []
    for hypothesis in body.hypotheses:
        if hypothesis in named:
            continue
        place = _places(body, hypothesis)
        estimate, own = data_alone(mean[place], covariance[np.ix_(place, place)], spread[place])
        tied = own + np.diag(spread[place] ** 2)
        gained = estimate @ np.linalg.solve(tied, estimate) - 2.0 * len(place)
        judged.append((gained, chance_within(estimate, own, tolerance[hypothesis[0]]), hypothesis))
    return judged


def _updated(body, faults, equations, spread, named, hypothesis, finding):
    """The finding with the estimate and covariance that hold with all that is named."""
    p, rivals = finding if isinstance(finding, tuple) else (finding.p, finding.rivals)
    kind, marker, test = hypothesis
    covariance = posterior(equations, _freed(body, spread, named))[1]
    place = _places(body, hypothesis)
    covariance = covariance[np.ix_(place, place)]
    if kind == DRIFT:
        time = body.readings[test][0]
        length = time[-1] - time[0]
        estimate, covariance = faults.drift[test, marker] / length, covariance / length**2
    else:
        estimate = np.atleast_1d(faults.gain[marker] if kind == GAIN else faults.place[marker])
    tests = (body.tests[test],) if kind == DRIFT else body.tests
    return Finding(_EFFECTS[kind], (body.markers[marker],), kind, estimate, covariance, p, tests, rivals)
