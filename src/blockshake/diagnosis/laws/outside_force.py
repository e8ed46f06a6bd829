"""A force from outside over all tests of a campaign: the blocks it may act on, its law and its size."""

import numpy as np

from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.diagnosis.laws.mean_of_tests import mean_of_tests
from blockshake.forces.outside.force_laws import fit_laws
from blockshake.forces.outside.push_history import push_history
from blockshake.geometry.rotations import rotation_matrices

_UNITS = {
    "steady": "N",
    "constant": "N",
    "pulse": "N",
    "spring": "N/m",
    "damper": "N s/m",
    "proportional": "N/m",
}
_SHOWN = 25.0  # by how much a law's information must beat that of no force, for a test to show it
_AGREES = 3.0  # factor of the least unexplained distance that blocks agree within
_NOISE = 1.0  # squared distance of an instant that is explained


def outside_force(forces):
    """Force from outside that explains most of what dry joints cannot.

    Parameters
    ----------
    forces : dict of str to JointForces
        By open test.

    Returns
    -------
    OutsideForce or None
        None where no test shows one.
    """
    structure = next(iter(forces.values())).structure
    left, fits = {}, {}
    for place in _places(structure):
        pushes = {test: push_history(one, *place) for test, one in forces.items()}
        left[place] = sum(float(np.nansum(one.distance**2)) for one in pushes.values())
        fits[place] = {test: fit_laws(forces[test].motion.time, one) for test, one in pushes.items()}
    instants = sum(len(one.motion.time) for one in forces.values())
    floor = min(left.values()) + _NOISE * 0.05 * instants
    agreeing = [place for place in left if left[place] <= _AGREES * floor]
    scored = {place: _score(fits[place]) for place in agreeing}
    shown = {place: one for place, one in scored.items() if one}
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
        unit=_UNITS[law],
        tests={test: {**one.parameters, "amplitude": one.amplitude} for test, one in tests.items()},
    )


def _places(structure):
    """Bodies and heights above their mass centres at which a force may act: the centre and the top of each block."""
    for body in map(int, np.flatnonzero(~structure.driven)):
        solid = structure.solids[structure.file.bodies[body].shape]
        turned = solid.vertices @ rotation_matrices(structure.orientation[body]).T
        yield body, 0.0
        yield body, float(turned[:, 2].max() + structure.centroid[body, 2] - structure.position[body, 2])


def _score(fits):
    """Best law over the tests that show a force, the scores of all laws, and its fits; None if no test shows one."""
    shown = {}
    for test, own in fits.items():
        by_name = {one.name: one for one in own}
        if own and own[0].name != "none" and by_name["none"].information - own[0].information > _SHOWN:
            shown[test] = by_name
    if not shown:
        return None
    names = [name for name in _UNITS if all(name in own for own in shown.values())]
    total = {name: sum(own[name].information for own in shown.values()) for name in names}
    law = min(total, key=total.get)
    scores = {name: value - total[law] for name, value in sorted(total.items(), key=lambda item: item[1])}
    return law, scores, {test: own[law] for test, own in shown.items()}
