"""Sizes from which causes would be seen, before any cause is looked for; and motions that the sensors do not show."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.special import ndtr

from blockshake.diagnosis.answer.answer import needed_of, needed_of_slab, soft_gains
from blockshake.diagnosis.answer.places import EVERYWHERE, place_name
from blockshake.diagnosis.evidence.explanation import best_of, mean_evidence
from blockshake.diagnosis.evidence.slab_motion import explain_lift, slab_turns
from blockshake.effects.joint_compliance import COMPLIANCES
from blockshake.effects.joint_compliance import EFFECT as JOINT_COMPLIANCE
from blockshake.effects.registry import EFFECTS
from blockshake.measurement.motion.body_poses import PLANAR, POSE

SEEN = 0.9  # chance with which the readings' noise lets a cause of its limit be seen
_LOST = 0.1  # of a test, for which a motion may be unknown without a word
_TRIED = (5.0, 9.0)  # standard deviations of an amplitude, at which its gain is computed
_FINEST, _STEPS = 1e4, 80  # sizes that are looked at: from this part of the visible one on
_APART = 6  # of them, of which the gain of a vertical motion is computed at one


class Visible(NamedTuple):
    """How surely an effect of a size at a place would be seen.

    ``distance`` (n_sizes,): of the first parameter from its null value; ``sigmas`` (n_sizes,): by which the mean gain
    exceeds what is needed, in standard deviations of the gain; ``values``: of the variant.
    """

    distance: np.ndarray
    sigmas: np.ndarray
    values: dict


def limits_of(visible):
    """Sizes from which effects would be seen in nine of ten campaigns of the same motion.

    Parameters
    ----------
    visible : dict of str to dict of str to Visible
        From `visible_sizes`.

    Returns
    -------
    dict of str to dict of str to float
        By effect and place, of the effect's first parameter, in its unit; only places where the tests tell it.
    """
    limits = {}
    for name, by_place in visible.items():
        found = {place: limit_of(name, [one]) for place, one in by_place.items()}
        limits[name] = {place: limit for place, limit in found.items() if limit is not None}
    return limits


def limit_of(name, visible):
    """The size at which the chance of being seen, averaged over some `Visible`, is `SEEN`; None within no prior."""
    chance = np.mean([ndtr(one.sigmas) for one in visible], axis=0)
    beyond = np.flatnonzero(chance < SEEN)
    first = int(beyond[-1]) + 1 if len(beyond) else 0
    if first == len(chance):
        return None
    distance = visible[0].distance[first]
    if first:
        share = (SEEN - chance[first - 1]) / (chance[first] - chance[first - 1])
        distance = visible[0].distance[first - 1] ** (1.0 - share) * distance**share
    size = EFFECTS[name].parameters[0]
    return float(size.null + np.sign(size.visible - size.null) * distance)


def visible_sizes(evidence, slabs, closed, without=()):
    """`Visible` by effect and place, of effects that make forces or move the slab.

    Parameters
    ----------
    evidence : Evidence or None
        Its likelihood that speaks loudest is taken.
    slabs : list of SlabMotion
    closed : dict of str to ClosedJoint
    without : sequence of str
        Effects that are left out.

    Notes
    -----
    With the standard deviation s of its amplitude, nuisances free, a cause of the size a has the mean gain ``q (a /
    s)^2 - o``: q is one half but for what the grid of variants lacks, and o is what averages over sizes, variants and
    places cost. The gain scatters with the readings' noise by ``a / s``.
    """
    visible = {}
    for name, effect in EFFECTS.items():
        if name in without or not (effect.turns or effect.lifts):
            continue
        if effect.turns:
            variants = list(zip(*(effect.turns(slab) for slab in slabs), strict=True))
            by_place = _by_place(name, slab_turns(slabs), {EVERYWHERE: variants}, needed_of_slab(name))
        else:
            by_place = {EVERYWHERE: _lifted(name, slabs)}
        visible[name] = by_place
    if evidence is None:
        return visible
    loudest = max(evidence.explained, key=lambda one: one.likelihood.log_evidence).likelihood
    tried = {}
    for (name, place), variants in evidence.tried.variants.items():
        tried.setdefault(name, {})[place] = variants
    for name, by_place in tried.items():
        needed = needed_of(name, evidence.tests[0].seen.tree)
        if name == JOINT_COMPLIANCE.name:
            visible[name] = _soft(loudest, by_place, needed, closed)
        else:
            visible[name] = _by_place(name, loudest, by_place, needed)
    return visible


def distances(name):
    size = EFFECTS[name].parameters[0]
    end = size.upper if size.visible > size.null else size.lower
    return np.geomspace(abs(size.visible - size.null) / _FINEST, abs(end - size.null), _STEPS)


def usual_column(name, variants, likelihood):
    """Whitened rows, (n_rows,), of the variant whose parameters beside the size are nearest to their usual values.

    Of several, such as an oscillator of any damping, the one of which the likelihood tells least. With them one over
    the variance of the amplitude, nuisances free, and the values of the variant.
    """
    usual = {one.name: one.null for one in EFFECTS[name].parameters[1:]}

    def away(variant):
        values = variant[0].values
        return sum(abs(np.log(values[key] / null)) for key, null in usual.items() if key in values)

    nearest = min(map(away, variants))
    chosen = [variant for variant in variants if away(variant) == nearest]
    units = [likelihood.whiten([columns.rows[:, :1] for columns in variant]) for variant in chosen]
    precisions = [float(likelihood.normal_equations(unit)[1][0, 0]) for unit in units]
    least = int(np.argmin(precisions))
    return units[least][:, 0], precisions[least], chosen[least][0].values


def _by_place(name, likelihood, by_place, needed):
    found = {}
    for place, variants in by_place.items():
        unit, precision, values = usual_column(name, variants, likelihood)
        if not precision > 0.0:
            continue
        deviation = precision**-0.5
        gains = [
            _mean_gain(name, replace(likelihood, value=many * deviation * unit), by_place) for many in _TRIED
        ]
        share = (gains[1] - gains[0]) / (_TRIED[1] ** 2 - _TRIED[0] ** 2)
        cost = share * _TRIED[0] ** 2 - gains[0]
        sigmas = distances(name) / deviation
        found[place] = Visible(distances(name), share * sigmas - (cost + needed) / sigmas, values)
    return found


def _mean_gain(name, expected, by_place):
    return float(
        mean_evidence([best_of(expected, name, place, variants).gain for place, variants in by_place.items()])
    )


def _soft(likelihood, by_place, needed, closed):
    """Of a soft layer, whose rows have no amplitude: closed and turned joints together, compliance by compliance."""
    places = sorted({*by_place, *closed})
    found = {}
    for place in places:
        sigmas = []
        for number, compliance in enumerate(COMPLIANCES):
            turned, square = {}, 0.0
            if place in by_place:
                true = likelihood.whiten([columns.rows for columns in by_place[place][number]])
                square = float(likelihood.normal_equations(true)[1][0, 0])
                expected = replace(likelihood, value=true[:, 0])
                turned = {
                    one: best_of(expected, JOINT_COMPLIANCE.name, one, variants).gains
                    for one, variants in by_place.items()
                }
            stiff = {
                one: joint._replace(target=compliance * joint.information * (one == place)).gains
                for one, joint in closed.items()
            }
            if place in closed:
                square += compliance**2 * closed[place].information
            gains = [mean_evidence(soft_gains(turned.get(one, 0.0), stiff.get(one, 0.0))) for one in places]
            sigmas.append((float(mean_evidence(gains)) - needed) / max(np.sqrt(square), 1e-9))
        grid = distances(JOINT_COMPLIANCE.name)
        found[place] = Visible(grid, np.interp(np.log(grid), np.log(COMPLIANCES), sigmas), {})
    return found


def _lifted(name, slabs):
    """Of a vertical motion of the slab in proportion to the horizontal one, of sizes far apart."""
    effect, grid = EFFECTS[name], distances(name)
    fit = explain_lift(effect, slabs).best
    tried = grid[::_APART]
    sigmas = []
    for size in tried:
        moved = [replace(slab, lift=size * slab.travel) for slab in slabs]
        gain = explain_lift(effect, moved).gain - needed_of_slab(name)
        sigmas.append(gain * float(np.sqrt(fit.covariance[0, 0])) / size)
    return Visible(grid, np.interp(np.log(grid), np.log(tried), sigmas), fit.values)


def excluded_above(limits, structure):
    """Sizes above which an effect would have been seen wherever it may be, by name; of effects that have one alone."""
    sizes = {}
    for name, by_place in limits.items():
        effect = EFFECTS[name]
        needed = {place_name(place) for place in effect.places(structure)}
        stated = {place.partition("@")[0] for place in by_place}
        if stated and (needed <= stated or needed == {EVERYWHERE}):
            size = effect.parameters[0]
            sizes[name] = max(by_place.values(), key=lambda value: abs(value - size.null))
    return sizes


def cannot_see(seen_tests):
    """Lines on motions and joints of seen tests that the sensors do not show.

    There is none where every motion of every body is read in every test, and every joint has moved in some test.
    """
    resting = [seen for seen in seen_tests if seen.still.any()]
    lines = [
        f"{seen.name}: no quiet start, from which its readings would count; nothing of it is judged"
        for seen in seen_tests
        if not seen.still.any()
    ]
    if not resting:
        return lines
    lines += [line for body in range(len(resting[0].structure.mass)) for line in _of_body(resting, body)]
    if len(resting) == 1:
        lines.append(f"{resting[0].name} alone: a cause that acts once is not told from one that lasts")
    if not resting[0].tree:
        lines.append("bodies that stand on several joints: the force of each joint is known in part")
    return [*lines, *_of_joints(resting)]


def _of_body(tests, body):
    name, driven = tests[0].structure.body_names[body], tests[0].structure.driven[body]
    known = {seen.motion.known[body] for seen in tests}
    if not known <= {POSE, PLANAR}:
        lost = "a pitch of the table and a soft base are" if driven else "forces of the joints at it are"
        yield f"{name}: its rotation is not read; {lost} not judged"
        return
    if PLANAR in known and not driven:
        yield f"{name}: turns out of the plane of shaking are not read, and taken as none"
    lost = max(float(np.mean(~np.isfinite(seen.required.wrench[:, body]).all(axis=1))) for seen in tests)
    if lost > _LOST:
        yield f"{name}: its motion is unknown for up to {100.0 * lost:.0f} % of a test"


def _of_joints(tests):
    for index, face in enumerate(tests[0].faces):
        read = [seen for seen in tests if np.isfinite(seen.forces.force[:, index]).any()]
        moved = any(
            seen.states.edge[:, index].any()
            or seen.states.slip[:, index].any()
            or seen.states.lifted[:, index].any()
            for seen in read
        )
        if read and not moved:
            yield f"{face.name}: turned, slipped and lifted in no test; of its causes a soft layer alone would show"
