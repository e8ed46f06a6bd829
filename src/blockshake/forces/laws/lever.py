"""Lever while a joint is turned: the edge that it bears on."""

import numpy as np

from blockshake.forces.laws.statistic import UNTOLD, Statistic, of_blocks, runs_of, slopes

_LEAST_TURN = 2e-3  # rad: below it a spread of rotations tells no slope
_FEWEST = 5  # instants
_SWINGS_A_SIDE = 2  # of a step, at least
_SMALL = 0.1  # share of an edge's instants that are its smallest rotations
_SMALLEST = 10  # of them at least, where the edge has so many


def bears_on_an_edge(forces, place):
    """Instants at which a joint is turned and bears on an edge, away from impacts: bool array."""
    side = forces.joints.side[:, forces.faces.index(forces.transmitted.faces[place])]
    told = np.isfinite(forces.transmitted.lever[:, place]) & (forces.transmitted.normal[:, place] > 0.0)
    return forces.joints.steady & (side != 0) & told


def lever_law(forces, place):
    """Statistics of one joint's lever, by name.

    Parameters
    ----------
    forces : JointForces
    place : int
        Of the joint in ``forces.transmitted``.

    Returns
    -------
    dict of str to Statistic
        ``lever.short``: half the face's width less the mean lever of both edges, at the smallest tenth of each edge's
        rotations [m]; ``lever.bias``: half the difference of both levers, positive where the resultant lies towards +x
        [m]; ``lever.step``: largest change of both levers from an instant on, towards +x [m]; ``lever.slope``: change
        of the lever with the size of the rotation [m/rad]; ``lever.stray``: root mean square of what is left, in units
        of the lever's standard deviation [1].

    Notes
    -----
    A rigid block bears on its edge alone: the lever is half the width, to either side (Housner 1963). An edge that wear
    has rounded bears further in, and least far out at small rotations: the further the block turns, the nearer to the
    edge it rolls. The shortfall is therefore that of small rotations.
    """
    lever, error = forces.transmitted.lever[:, place], forces.transmitted.lever_error[:, place]
    face = forces.transmitted.faces[place]
    joint = forces.faces.index(face)
    side = forces.joints.side[:, joint]
    turned = bears_on_an_edge(forces, place)
    names = ("lever.short", "lever.bias", "lever.step", "lever.slope", "lever.stray")
    if turned.sum() < _FEWEST:
        return dict.fromkeys(names, UNTOLD)
    run = runs_of(turned)[turned]
    own, towards, turn = lever[turned], side[turned], np.abs(forces.joints.rotation[turned, joint])
    edges = [towards == sign for sign in (1, -1)]
    short, _ = _both([_edge(own, run, edge & _smallest(turn, edge)) for edge in edges], face.half_width)
    _, bias = _both([_edge(own, run, edge) for edge in edges], face.half_width)
    slope = slopes(own * towards, turn[:, None], run)[0] if np.ptp(turn) > _LEAST_TURN else UNTOLD
    middle = sum(np.where(towards == sign, _median(own[towards == sign]), 0.0) for sign in (1, -1))
    stray = float(np.sqrt(np.mean(((own - middle) / error[turned]) ** 2)))
    found = (
        short,
        bias,
        _step(own, towards, run),
        slope,
        Statistic(stray, stray / float(np.sqrt(2 * len(own)))),
    )
    return dict(zip(names, found, strict=True))


def _edge(lever, run, chosen):
    """Lever of some of the instants."""
    return of_blocks(lever[chosen], run[chosen])


def _smallest(turn, edge):
    """Instants whose rotation is among the smallest of an edge's."""
    of_edge = np.sort(turn[edge])
    count = max(round(_SMALL * len(of_edge)), _SMALLEST)
    return turn <= (of_edge[min(count, len(of_edge)) - 1] if len(of_edge) else 0.0)


def _median(values):
    return float(np.median(values)) if len(values) else 0.0


def _step(lever, side, run):
    """Largest change of both edges' levers between one swing and the next, by least squares over all swings."""
    numbers = np.unique(run)
    if len(numbers) < 2 * _SWINGS_A_SIDE:
        return UNTOLD
    means = np.array([np.median(lever[run == number]) for number in numbers])
    sides = np.array([side[run == number][0] for number in numbers], dtype=float)
    weight = np.sqrt([float((run == number).sum()) for number in numbers])
    found = []
    for first in range(_SWINGS_A_SIDE, len(numbers) - _SWINGS_A_SIDE + 1):
        later = np.arange(len(numbers)) >= first
        design = np.column_stack([sides, np.ones(len(numbers)), later]) * weight[:, None]
        answer, *_ = np.linalg.lstsq(design, means * weight, rcond=None)
        left = design @ answer - means * weight
        found.append((float(left @ left), float(answer[2])))
    left, step = min(found)
    spread = np.sqrt(left / max(len(numbers) - 3, 1) * 4.0 / (weight**2).sum())
    return Statistic(step, float(spread))


def _both(edges, half_width):
    """By how much the levers fall short, and half their difference, from those of the two edges."""
    plus, minus = edges
    if np.isnan(plus.value) or np.isnan(minus.value):
        one = plus if not np.isnan(plus.value) else Statistic(-minus.value, minus.error)
        return Statistic(half_width - one.value, one.error), UNTOLD
    error = 0.5 * float(np.hypot(plus.error, minus.error))
    return (
        Statistic(half_width - 0.5 * (plus.value - minus.value), error),
        Statistic(0.5 * (plus.value + minus.value), error),
    )
