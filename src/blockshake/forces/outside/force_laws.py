"""Laws that a force from outside may follow, fitted to its history."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

_GRID = 40  # gaps that are tried
_STEP = 0.05  # s, between the starts that are tried
_WITHIN_90 = 2.71  # chi-square of one degree of freedom that nine of ten values stay below
_LONGEST_PULSE = 0.5  # s
_FEWEST = 5  # instants on a side that tell its edge
_EDGE = 5e-3  # m: how far edges are known, where readings tell no better
_SECOND = 25.0  # by how much a second spring must lower the sum of squares to be seen


@dataclass(frozen=True)
class FittedLaw:
    """One law fitted to one history.

    Attributes
    ----------
    name : str
        ``steady`` throughout, ``constant`` from an instant on, ``pulse``, ``spring``, ``damper`` or ``proportional``.
    amplitude, error : float
        Of the law and its standard deviation: a force [N]; of a spring [N/m], of a damper [N s/m].
    parameters : dict of str to float
        Start and end [s], gap [m] and side. ``other_gap`` [m] and ``other_amplitude`` [N/m] of a second spring that is
        seen on the other side. ``earliest`` and ``latest``, of a constant force, are the ends of the starts that 90 %
        of such histories agree with, and the start is in their middle.
    chi_square : float
        Sum of squares left, in variances of the history; where the force is not told, of what is beyond its ends.
    information : float
        Bayesian information criterion: ``chi_square + k ln n`` (Schwarz 1978).
    """

    name: str
    amplitude: float
    error: float
    parameters: dict
    chi_square: float
    information: float


class _Readings(NamedTuple):
    """History at the known instants: the force where it is told, its ends elsewhere, and its standard deviation."""

    told: np.ndarray
    force: np.ndarray
    error: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


def fit_laws(time, push):
    """Every law fitted to a history, and none: the best first.

    Parameters
    ----------
    time : float64 array, shape (n_times,)
        [s]
    push : PushHistory

    Returns
    -------
    list of FittedLaw
        Empty where nothing is told.
    """
    told = push.told
    bounded = ~told & np.isfinite(push.lower + push.error + push.displacement + push.velocity)
    if not told.any():
        return []
    shift = _edge_shift(push.force[told], push.edge[told])
    known = told | bounded
    readings = _Readings(
        told[known], push.force[known] + shift * push.edge[known], push.error[known],
        push.lower[known] - shift * push.by_lever[known], push.upper[known] + shift * push.by_lever[known],
    )  # fmt: skip
    t, u, v = time[known], push.displacement[known], push.velocity[known]
    fits = [_fitted("none", np.zeros_like(t), readings, {}, 0)]
    fits.append(_fitted("steady", np.ones_like(t), readings, {}, 1))
    fits.append(_stepped(t, readings))
    fits.append(_best("pulse", _pulses(t, t[readings.told]), readings, 3))
    fits.append(_with_other_side(_best("spring", _springs(u, (1.0, -1.0)), readings, 2), u, readings))
    fits.append(_fitted("damper", v, readings, {}, 1))
    fits.append(_fitted("proportional", u, readings, {}, 1))
    return sorted((one for one in fits if one is not None), key=lambda one: one.information)


def _edge_shift(force, edge):
    """How far further out the edges lie than the structure has them, the same to both sides [m].

    An edge further out takes up the force ``shift * edge``, which the history lacks. A force that is looked for shows
    with one sign on one side and the other on the other: the mean of the two sides is free of it. A block that turned
    to one side alone tells its edge no better than it is known.
    """
    sides = [force[side * edge > 0.0] / edge[side * edge > 0.0] for side in (1.0, -1.0)]
    middle = [-float(np.median(own)) for own in sides if len(own) >= _FEWEST]
    if len(middle) == 2:
        return 0.5 * (middle[0] + middle[1])
    return float(np.clip(middle[0], -_EDGE, _EDGE)) if middle else 0.0


def _stepped(t, readings):
    """Force that is constant from an instant on; between two instants that tell, every start is as good."""
    starts = np.arange(t[0], t[-1], _STEP)
    fits = [
        _fitted("constant", (t >= one).astype(float), readings, {"start": float(one)}, 2) for one in starts
    ]
    fits = [one for one in fits if one is not None]
    if not fits:
        return None
    least = min(one.chi_square for one in fits)
    near = [one for one in fits if one.chi_square <= least + _WITHIN_90]
    earliest, latest = near[0].parameters["start"], near[-1].parameters["start"]
    middle = min(near, key=lambda one: abs(one.parameters["start"] - 0.5 * (earliest + latest)))
    return replace(middle, parameters={**middle.parameters, "earliest": earliest, "latest": latest})


def _pulses(t, starts):
    for start in np.unique(starts):
        for length in np.geomspace(0.03, _LONGEST_PULSE, 6):
            yield (
                ((t >= start) & (t < start + length)).astype(float),
                {
                    "start": float(start),
                    "end": float(start + length),
                },
            )


def _springs(u, sides):
    for side in sides:
        largest = (side * u).max()
        for gap in np.linspace(0.0, max(largest, 0.0), _GRID, endpoint=False):
            yield -side * np.maximum(side * u - gap, 0.0), {"gap": float(gap), "side": side}


def _with_other_side(spring, u, readings):
    """A spring beyond a gap with a second one on the other side, if what the first one leaves shows it."""
    if spring is None:
        return None
    side, gap = spring.parameters["side"], spring.parameters["gap"]
    own = -side * spring.amplitude * np.maximum(side * u - gap, 0.0)
    rest = readings._replace(
        force=readings.force - own, lower=readings.lower - own, upper=readings.upper - own
    )
    other = _best("spring", _springs(u, (-side,)), rest, 2)
    if other is None or other.amplitude <= 0.0 or spring.chi_square - other.chi_square < _SECOND:
        return spring
    second = {"other_gap": other.parameters["gap"], "other_amplitude": other.amplitude}
    return replace(
        spring,
        parameters={**spring.parameters, **second},
        chi_square=other.chi_square,
        information=other.information + spring.information - spring.chi_square,
    )


def _best(name, shapes, readings, count):
    fits = [_fitted(name, shape, readings, parameters, count) for shape, parameters in shapes]
    fits = [one for one in fits if one is not None]
    return min(fits, key=lambda one: one.chi_square) if fits else None


def _fitted(name, shape, readings, parameters, count):
    """Amplitude by weighted least squares where the force is told, or None where the shape is zero there."""
    told, weight = readings.told, readings.error**-2
    own = np.where(told, shape, 0.0)
    square = float(weight @ own**2)
    if square == 0.0 and name != "none":
        return None
    amplitude = float(weight @ (own * readings.force)) / square if square > 0.0 else 0.0
    force = amplitude * shape
    beyond = np.maximum(np.maximum(readings.lower - force, force - readings.upper), 0.0)
    left = float(weight @ np.where(told, readings.force - force, beyond) ** 2)
    return FittedLaw(
        name, amplitude, square**-0.5 if square > 0.0 else np.nan, parameters, left,
        left + count * np.log(np.count_nonzero(told)),
    )  # fmt: skip
