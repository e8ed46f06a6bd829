"""A force from outside over all tests of a campaign: the blocks it may act on, its law and its size."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.diagnosis.laws.mean_of_tests import mean_of_tests
from blockshake.forces.outside.force_laws import fit_laws
from blockshake.forces.outside.push_history import push_history
from blockshake.geometry.rotations import rotation_matrices


class _Law(NamedTuple):
    """Unit of a law's amplitude, and the evidence that it needs, summed over the tests that show a force.

    The evidence is about twice the largest of 40 nominal draws and 60 campaigns without an effect.
    """

    unit: str
    evidence: float


_LAWS = {  # by rising number of parameters
    "steady": _Law("N", 250.0),
    "damper": _Law("N s/m", 22.0),
    "proportional": _Law("N/m", 60.0),
    "constant": _Law("N", 250.0),
    "spring": _Law("N/m", 180.0),
    "pulse": _Law("N", 150.0),
}
_SHOWN = 25.0  # by how much a law's information must beat that of no force, for a test to show it
_ADEQUATE = (
    60.0  # evidence of the best law over a simpler one: an eccentric block's for a push 42, a push's 107
)
_AGREES = 3.0  # factor of the least unexplained distance that blocks agree within
_NOISE = 0.05  # squared distance of an instant that is explained


class _Explained(NamedTuple):
    """A force at one place: squared distance that it leaves, what its best law leaves with it, and all laws by test."""

    left: float
    fits: dict


def outside_force(forces):
    """Force from outside that explains most of what dry joints cannot.

    Parameters
    ----------
    forces : dict of str to JointForces
        By open test.

    Returns
    -------
    OutsideForce or None
        None where no law has the evidence that it needs.
    """
    structure = next(iter(forces.values())).structure
    explained = {place: _explained(forces, place) for place in _places(structure)}
    instants = sum(len(one.motion.time) for one in forces.values())
    floor = min(one.left for one in explained.values()) + _NOISE * instants
    agreeing = {
        place: law_of_tests(one.fits) for place, one in explained.items() if one.left <= _AGREES * floor
    }
    shown = {place: one for place, one in agreeing.items() if one}
    if not shown:
        return None
    # of places that agree the lowest information is no measure: their errors differ; the middle one stands for all
    order = sorted(shown, key=lambda place: structure.position[place[0], 2] + place[1])
    best = order[len(order) // 2]
    law, scores, tests = shown[best]
    amplitudes = np.array([one.amplitude for one in tests.values()])
    errors = np.array([one.error for one in tests.values()])
    mean, half = mean_of_tests(amplitudes, errors)
    names = structure.body_names
    return OutsideForce(
        bodies=tuple(dict.fromkeys(names[body] for body, _ in [best, *order])),
        height=best[1],
        law=law,
        scores=scores,
        amplitude=mean,
        lower=mean - half,
        upper=mean + half,
        unit=_LAWS[law].unit,
        tests={test: {**one.parameters, "amplitude": one.amplitude} for test, one in tests.items()},
    )


class LawOfTests(NamedTuple):
    """Law that a force follows in all tests that show one: its name, the scores of all laws, and its fit by test."""

    law: str
    scores: dict
    tests: dict


def law_of_tests(fits):
    """Simplest adequate law over the tests that show a force.

    Parameters
    ----------
    fits : dict of str to list of FittedLaw
        By test, from `fit_laws`.

    Returns
    -------
    LawOfTests or None
        None where no test shows a force, or where the law has not the evidence that it needs.

    Notes
    -----
    A law is adequate if there is little evidence for the best one beside it.
    """
    shown = {}
    for test, own in fits.items():
        by_name = {one.name: one for one in own}
        if own and own[0].name != "none" and by_name["none"].information - own[0].information > _SHOWN:
            shown[test] = by_name
    if not shown:
        return None
    names = [name for name in _LAWS if all(name in own for own in shown.values())]
    total = {name: sum(own[name].information for own in shown.values()) for name in names}
    best = min(total, key=total.get)
    law = next(name for name in names if _evidence(shown, best, name) <= _ADEQUATE)
    if _evidence(shown, law, "none") < _LAWS[law].evidence:
        return None
    scores = {name: value - total[law] for name, value in sorted(total.items(), key=lambda item: item[1])}
    return LawOfTests(law, scores, {test: own[law] for test, own in shown.items()})


def _evidence(shown, law, other):
    """Evidence of one law over another, summed over tests."""
    return sum(own[law].evidence(own[other]) for own in shown.values())


def _explained(forces, place):
    """`_Explained` of a force at a place: what no force there explains, and what its best law leaves."""
    left, fits = 0.0, {}
    for test, one in forces.items():
        push = push_history(one, *place)
        fits[test] = fit_laws(one.motion.time, push)
        left += float(np.nansum(push.distance**2)) + (fits[test][0].chi_square if fits[test] else 0.0)
    return _Explained(left, fits)


def _places(structure):
    """Bodies and heights above their mass centres at which a force may act: the centre and the top of each block."""
    for body in map(int, np.flatnonzero(~structure.driven)):
        solid = structure.solids[structure.file.bodies[body].shape]
        turned = solid.vertices @ rotation_matrices(structure.orientation[body]).T
        yield body, 0.0
        yield body, float(turned[:, 2].max() + structure.centroid[body, 2] - structure.position[body, 2])
