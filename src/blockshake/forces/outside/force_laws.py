"""Laws that a force from outside may follow, fitted to its history."""

from dataclasses import dataclass

import numpy as np

_GRID = 40  # values that are tried of a time or a gap
_LONGEST_PULSE = 0.5  # s
_EDGE = 8e-3  # m, at most: how far the numerics of a model place an edge from the geometric one


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
        Start and end [s], gap [m] and side.
    chi_square : float
        Sum of squares left, in variances of the history.
    information : float
        Bayesian information criterion: ``chi_square + k ln n`` (Schwarz 1978).
    """

    name: str
    amplitude: float
    error: float
    parameters: dict
    chi_square: float
    information: float


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
    if not told.any():
        return []
    error = push.error[told]
    force = _without_edges(push.force[told], push.edge[told])
    t, u, v = time[told], push.displacement[told], push.velocity[told]
    fits = [_fitted("none", np.zeros_like(force), force, error, {}, 0)]
    fits.append(_fitted("steady", np.ones_like(force), force, error, {}, 1))
    fits.append(_best("constant", _steps(t), force, error, 2))
    fits.append(_best("pulse", _pulses(t), force, error, 3))
    fits.append(_best("spring", _springs(u), force, error, 2))
    fits.append(_fitted("damper", v, force, error, {}, 1))
    fits.append(_fitted("proportional", u, force, error, {}, 1))
    return sorted((one for one in fits if one is not None), key=lambda one: one.information)


def _without_edges(force, edge):
    """A history less what an edge that lies elsewhere, the same for both sides, would seem to push."""
    # the median is not moved by the force that is looked for
    turned = edge != 0.0
    if not turned.any():
        return force
    shift = np.median(force[turned] / edge[turned])
    return force - np.clip(shift, -_EDGE, _EDGE) * edge


def _steps(t):
    for start in np.linspace(t[0], t[-1], _GRID, endpoint=False):
        yield (t >= start).astype(float), {"start": float(start)}


def _pulses(t):
    for start in np.unique(t):
        for length in np.geomspace(0.03, _LONGEST_PULSE, 6):
            yield (
                ((t >= start) & (t < start + length)).astype(float),
                {
                    "start": float(start),
                    "end": float(start + length),
                },
            )


def _springs(u):
    for side in (1.0, -1.0):
        largest = (side * u).max()
        for gap in np.linspace(0.0, max(largest, 0.0), _GRID, endpoint=False):
            yield -side * np.maximum(side * u - gap, 0.0), {"gap": float(gap), "side": side}


def _best(name, shapes, force, error, count):
    fits = [_fitted(name, shape, force, error, parameters, count) for shape, parameters in shapes]
    fits = [one for one in fits if one is not None]
    return min(fits, key=lambda one: one.chi_square) if fits else None


def _fitted(name, shape, force, error, parameters, count):
    """Amplitude by weighted least squares, or None where the shape is zero throughout."""
    weight = error**-2
    square = float(weight @ shape**2)
    if square == 0.0 and name != "none":
        return None
    amplitude = float(weight @ (shape * force)) / square if square > 0.0 else 0.0
    left = float(weight @ (force - amplitude * shape) ** 2)
    return FittedLaw(
        name, amplitude, square**-0.5 if square > 0.0 else np.nan, parameters, left,
        left + count * np.log(len(force)),
    )  # fmt: skip
