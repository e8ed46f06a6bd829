"""Sizes from which causes would be seen, before any cause is looked for; and motions that the sensors do not show."""

from dataclasses import replace

import numpy as np
from scipy.special import ndtri

from blockshake.diagnosis.answer.answer import soft_gains
from blockshake.diagnosis.answer.places import EVERYWHERE, place_name, unmoved_joints
from blockshake.diagnosis.evidence.explanation import best_of, mean_evidence
from blockshake.diagnosis.evidence.slab_motion import lift_gain, lift_ratios, lift_roots, slab_turns
from blockshake.effects.joint_compliance import COMPLIANCES
from blockshake.effects.joint_compliance import EFFECT as JOINT_COMPLIANCE
from blockshake.effects.registry import EFFECTS
from blockshake.measurement.motion.body_poses import PLANAR, POSE

SEEN = 0.9  # chance with which the sensors' noise lets a cause of its limit be seen
SURELY = float(ndtri(SEEN))  # standard deviations of the gain, by which the mean one exceeds what is needed
_TRIED = (5.0, 9.0)  # standard deviations of an amplitude, at which its gain is computed
_LIFTS = np.geomspace(1e-4, 1.0, 60)  # of the end of the prior, at which a vertical motion is tried
_LOST = 0.1  # of a test, for which a motion may be unknown without a word


def limits_of(evidence, slabs, closed, thresholds, without=()):
    """Sizes from which effects would be seen in nine of ten campaigns of the same motion, by effect and place.

    Parameters
    ----------
    evidence : Evidence or None
    slabs : list of SlabMotion
    closed : dict of str to ClosedJoint
    thresholds : Thresholds
    without : sequence of str
        Effects that are left out.

    Returns
    -------
    dict of str to dict of str to float
        Limit of the effect's first parameter, in its unit; only places where the tests tell it.

    Notes
    -----
    With the standard deviation s of its amplitude, nuisances free, a cause of the size a has the mean gain ``q (a /
    s)^2 - o``: q is one half but for what the grid of variants lacks, and o is what averages over sizes, variants and
    places cost. The gain scatters with the sensors' noise by ``a / s``.
    """
    limits = {}
    for name, effect in EFFECTS.items():
        if effect.turns and name not in without:
            variants = list(zip(*(effect.turns(slab) for slab in slabs), strict=True))
            limits[name] = _by_place(name, slab_turns(slabs), {EVERYWHERE: variants}, thresholds.of(name))
        if effect.lifts and name not in without and any(len(slab.at) for slab in slabs):
            limits[name] = {
                EVERYWHERE: _lifted(name, [slab for slab in slabs if len(slab.at)], thresholds.of(name))
            }
    if evidence is not None:
        most_probable, tried = evidence.usual, {}
        for (name, place), variants in evidence.tried.variants.items():
            tried.setdefault(name, {})[place] = variants
        for name, by_place in tried.items():
            needed = thresholds.of(name)
            if name == JOINT_COMPLIANCE.name:
                limits[name] = _soft(most_probable, by_place, needed, closed)
            else:
                limits[name] = _by_place(name, most_probable, by_place, needed)
    return {
        name: {
            place: from_null(name, size)
            for place, size in by_place.items()
            if size is not None and size <= largest(name)
        }
        for name, by_place in limits.items()
    }


def largest(name):
    """Distance from an effect's null value to the end of its prior on the side of the visible size."""
    size = EFFECTS[name].parameters[0]
    return abs((size.upper if size.visible > size.null else size.lower) - size.null)


def from_null(name, distance):
    """The size of an effect at a distance from its null value, on the side of the visible one."""
    size = EFFECTS[name].parameters[0]
    return float(size.null + np.sign(size.visible - size.null) * distance)


def usual_column(name, variants, likelihood):
    """Whitened rows, (n_rows,), of the variant whose parameters other than the size are nearest to their usual values.

    Where several are, such as an oscillator of any damping, the one that the likelihood tells least of. With them one
    over the variance of the amplitude, nuisances free.
    """
    usual = {one.name: one.null for one in EFFECTS[name].parameters[1:]}

    def away(variant):
        values = variant[0].values
        return sum(abs(np.log(values[key] / null)) for key, null in usual.items() if key in values)

    nearest = min(map(away, variants))
    units = [
        likelihood.whiten([columns.rows[:, :1] for columns in variant])
        for variant in variants
        if away(variant) == nearest
    ]
    precisions = [float(likelihood.normal_equations(unit)[1][0, 0]) for unit in units]
    least = int(np.argmin(precisions))
    return units[least][:, 0], precisions[least]


def _by_place(name, likelihood, by_place, needed):
    """Distance of the limit from the null value by place; None where no row tells it."""
    found = {}
    for place, variants in by_place.items():
        unit, precision = usual_column(name, variants, likelihood)
        if not precision > 0.0:
            continue
        gains = []
        for many in _TRIED:
            expected = replace(likelihood, value=many * precision**-0.5 * unit)
            gains.append(
                mean_evidence([best_of(expected, name, one, tried).gain for one, tried in by_place.items()])
            )
        # q and o of `limits_of` through two sizes; then the root of q a^2 - SURELY a - o = 0 in units of s
        share = (gains[1] - gains[0]) / (_TRIED[1] ** 2 - _TRIED[0] ** 2)
        cost = share * _TRIED[0] ** 2 - gains[0] + needed
        if share > 0.0:
            root = np.sqrt(SURELY**2 + 4.0 * share * max(cost, 0.0))
            found[place] = float((SURELY + root) / (2.0 * share) * precision**-0.5)
    return found


def _soft(likelihood, by_place, needed, closed):
    """For a soft layer, whose rows have no amplitude: the smallest compliance that closed and turned joints show."""
    places, found = {*by_place, *closed}, {}
    for place in sorted(places):
        for number, compliance in enumerate(COMPLIANCES):
            turned, stiff, square = 0.0, 0.0, 0.0
            if place in by_place:
                true = likelihood.whiten([columns.rows for columns in by_place[place][number]])
                square = float(likelihood.normal_equations(true)[1][0, 0])
                expected = replace(likelihood, value=true[:, 0])
                turned = best_of(expected, JOINT_COMPLIANCE.name, place, by_place[place]).gains
            if place in closed:
                square += compliance**2 * closed[place].information
                stiff = closed[place].expected(compliance)
            gain = mean_evidence(soft_gains(turned, stiff)) - np.log(len(places))
            if gain - SURELY * np.sqrt(square) > needed:
                found[place] = float(compliance)
                break
    return found


def _lifted(name, slabs, needed):
    """For a vertical motion of the slab in proportion to the horizontal one: the smallest that is tried and seen."""
    best = max(lift_ratios(slabs), key=lambda fit: fit.gain)
    deviation, roots = float(np.sqrt(best.covariance[0, 0])), lift_roots(EFFECTS[name], slabs)
    for size in largest(name) * _LIFTS:
        gain = lift_gain([replace(slab, lift=size * slab.travel) for slab in slabs], roots)
        if gain - SURELY * size / deviation > needed:
            return float(size)
    return None


def excluded_above(limits, structure):
    """Sizes above which an effect would have been seen wherever it may be, by name of the effect."""
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

    One line too for a test without a quiet start, for a single test, and for bodies on several joints.
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
        lines.append(
            f"{resting[0].name} alone: a cause that acts once is not distinguished from one that lasts"
        )
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
    for index in unmoved_joints(tests):
        name = tests[0].faces[index].name
        yield f"{name}: turned, slipped and lifted in no test; of its causes a soft layer alone would show"
