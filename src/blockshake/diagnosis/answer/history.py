"""A campaign as a history: sizes by test, and whether they change from test to test, as edges that wear do."""

from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag
from scipy.special import logsumexp

from blockshake.diagnosis.answer.answer import after
from blockshake.diagnosis.answer.decision import Estimate, History
from blockshake.diagnosis.answer.places import EVERYWHERE, place_of
from blockshake.diagnosis.answer.size import FORM, NINE_TENTHS, read_sizes, units_of
from blockshake.diagnosis.answer.thresholds import by_odds
from blockshake.diagnosis.evidence.explanation import mean_evidence
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS

EDGES, MIDDLE, FRICTION = "edges", "middle", "friction"
# of undamaged joints: name and unit of the size, and the standard deviation of its prior (of friction: of the
# coefficient)
_UNDAMAGED = {EDGES: ("inset", "m", 0.05), MIDDLE: ("shift", "m", 0.02), FRICTION: ("change", "1", 0.3)}
_OF_EDGES = ("reduced-bearing", "changed-edge")  # causes whose own path is that of the edges
_STEPS = (0.1, 0.3, 1.0)  # of the prior's deviation, from test to test: of a walk, since damage stays
_SCATTER = 0.02  # of it, from test to test without damage: blocks are set up anew


def histories(evidence, given_first, first, seen):
    """Sizes by test of the first cause, and of the edges, the middle and the friction of undamaged joints.

    Parameters
    ----------
    evidence, given_first : Evidence or None
        Without any cause, and with the first cause in the joints among the nuisances.
    first : Alternative or None
        That cause.
    seen : ReconstructedTest
        Any test.

    Returns
    -------
    tuple of History
        Of what two tests at least tell; the cause's own first, where it has an amplitude and acts in all tests.
    """
    if evidence is None:
        return ()
    more = after([first]) if first and (first.cause, first.place) in evidence.keys else 0.0
    own = _own(evidence, first, seen) if more else ()
    of_edges = bool(own) and first.cause in _OF_EDGES
    others = (quantity for quantity in _UNDAMAGED if not (of_edges and quantity == EDGES))
    undamaged = [_of_undamaged_joints(given_first or evidence, quantity, more) for quantity in others]
    if given_first:  # a walk that alone explains more than the cause does takes the cause's place
        alone = {quantity: _of_undamaged_joints(evidence, quantity, 0.0, first) for quantity in _UNDAMAGED}
        undamaged = [alone[one.quantity] or one for one in undamaged if one]
    return tuple(one for one in (*own, *undamaged) if one)


def of_last_test(cause, history):
    """A `Cause` as large as in the last test of a `History` of its own: what acts in tests to come is that large."""
    name, present = history.parameter, cause.parameters[history.parameter]
    number, apart = list(cause.parameters).index(name), cause.outside and len(cause.amplitudes) > 1
    last, known = history.sizes[-1], None if cause.outside else EFFECTS[cause.name].parameters[0]
    wider = (last.upper - last.lower) / max(present.upper - present.lower, 1e-300)
    null = known.null if known else 0.0
    share = (last.estimate - null) / (present.estimate - null) if present.estimate != null else 1.0
    members = []
    for member in cause.members:
        size = last.estimate + wider * (member[name] - present.estimate)
        members.append(member | {name: float(np.clip(size, known.lower, known.upper)) if known else size})
    return cause.model_copy(
        update={
            "parameters": cause.parameters | {name: last},
            "members": tuple(members),
            "amplitudes": tuple(
                one if apart and column != number else share * one
                for column, one in enumerate(cause.amplitudes)
            ),
        }
    )


def _own(evidence, first, seen):
    """`History` of every size of a cause at its best place; none where it has no amplitude or does not act in all
    tests."""
    fit, place = evidence.best((first.cause, first.place)).best, place_of(first.cause, first.place, seen)
    size, form = fit.size[0], FORMS.get(first.cause)
    if not fit.covariance.any() or size == 0.0 or (form and form.rows is None):
        return ()
    needed = by_odds(first.cause)  # errors of its form are in the scatter of the sizes
    if form and form.more:
        return _of_sizes(evidence, first.cause, form, fit, place, needed)
    if form:
        columns = [form.rows(test, place, fit.values) for test in evidence.tests]
    else:
        columns = [rows @ fit.mean / size for rows in fit.columns]
    name, unit = next(iter(units_of(first.cause).items()))
    found = _weighed(evidence, columns, float(fit.scales[0]))

    def read(amplitudes):
        return read_sizes(first.cause, fit.values, amplitudes, 0.0)[name]

    return (_history(first.cause, name, place, unit, found, needed, read),) if found else ()


def _of_sizes(evidence, cause, form, fit, place, needed):
    """`History` of every size of a form with several, the others free in every test; and what an oscillator of the
    body has."""
    made, found = [form.rows(test, place, fit.values) for test in evidence.tests], []
    for number, (name, unit) in enumerate(form.units.items()):
        own, free = [rows[:, number] for rows in made], [np.delete(rows, number, axis=1) for rows in made]
        weighed = _weighed(evidence, own, float(fit.scales[number]), (free, np.delete(fit.scales, number)))
        found.append(weighed and _history(cause, name, place, unit, weighed, needed, np.asarray))
    if not all(found):
        return ()
    structure = evidence.tests[0].seen.structure
    mass = float(structure.mass[structure.body_names.index(place["body"])])
    stiffness, damping = found
    if min(one.lower for one in stiffness.sizes) <= 0.0:
        return tuple(found)
    periods = [_changed(one, lambda k: 2.0 * np.pi * np.sqrt(mass / k), "s") for one in stiffness.sizes]
    ratios = [
        _changed(c, lambda c, k=k.estimate: 0.5 * c / np.sqrt(k * mass), "1")
        for c, k in zip(damping.sizes, stiffness.sizes, strict=True)
    ]
    return (
        stiffness.model_copy(update={"derived": {"period": tuple(periods)}}),
        damping.model_copy(update={"derived": {"damping ratio": tuple(ratios)}}),
    )


def _changed(estimate, read, unit):
    """An `Estimate` through a monotonic function."""
    lower, upper = sorted((float(read(estimate.lower)), float(read(estimate.upper))))
    return Estimate(lower=lower, estimate=float(read(estimate.estimate)), upper=upper, unit=unit)


def _of_undamaged_joints(evidence, quantity, more, rival=None):
    """`History` of a size that undamaged joints have too, where it changes most; its gain is averaged over the places.

    With a `Alternative` it is None but where the size changes and explains more than the rival.
    """
    name, unit, scale = _UNDAMAGED[quantity]
    by_place = _columns(evidence.tests, quantity)
    found = {place: _weighed(evidence, columns, scale) for place, columns in by_place.items()}
    found = {place: one for place, one in found.items() if one}
    if not found:
        return None
    best = max(found, key=lambda place: found[place][0])
    place = {} if best == EVERYWHERE else place_of(_OF_EDGES[1], best, evidence.tests[0].seen)
    gain, total = (float(mean_evidence([one[row] for one in found.values()])) for row in (0, 1))
    path = (gain, total, *found[best][2:])
    made = _history(quantity, name, place, unit, path, by_odds(quantity) + more, np.asarray)
    if rival is None:
        return made
    return made.model_copy(update={"beats": rival.cause}) if made.changes and total > rival.gain else None


def _history(quantity, name, place, unit, found, needed, read):
    gain, _, tests, means, deviations = found
    reach = NINE_TENTHS * np.hypot(deviations, FORM * means)
    sizes = np.sort([read(means - reach), read(means), read(means + reach)], axis=0)
    return History(
        quantity=quantity,
        parameter=name,
        place=place,
        tests=tests,
        sizes=[Estimate(lower=a, estimate=b, upper=c, unit=unit) for a, b, c in sizes.T.tolist()],
        gain=gain,
        changes=bool(gain > needed),
    )


def _weighed(evidence, columns, scale, free=None):
    """Gain of a path over one value and over nothing, names of the tests, amplitudes of each test and their deviations.

    ``columns`` are by test, (n_rows,) each, per unit of the amplitude. Amplitudes of single tests have the prior of the
    cause each, and share the nuisances. None where fewer than two tests have the column. ``free`` are further columns
    by test, (n_rows, n_columns) each, with the scales of their amplitudes, of their own in each test.
    """
    acting = [number for number, column in enumerate(columns) if column.any()]
    if len(acting) < 2:
        return None
    logs, constant, path, alone = [], [], [], []
    for explained in evidence.explained:
        likelihood = _with_free(explained.likelihood, *free) if free else explained.likelihood
        single = np.zeros((len(likelihood.value), len(acting)))
        for column, number in enumerate(acting):
            rows = slice(likelihood.ends[number], likelihood.ends[number + 1])
            single[rows, column] = likelihood.whiten_one(number, columns[number])
        since = np.cumsum(single[:, ::-1], axis=1)[:, ::-1]  # from each test on
        usual = likelihood.amplitudes(since[:, :1], scale).mean[0]
        scatter = np.full(len(acting), np.hypot(_SCATTER * scale, FORM * usual))
        same = np.column_stack([since[:, 0], single])
        walks = np.column_stack([same, since[:, 1:]])
        steps = np.ones(len(acting) - 1)
        logs.append(likelihood.log_evidence)
        constant.append(likelihood.amplitudes(same, [scale, *scatter]).gain)
        gains = [
            likelihood.amplitudes(walks, [scale, *scatter, *(share * scale * steps)]).gain for share in _STEPS
        ]
        path.append(mean_evidence(gains))
        alone.append(likelihood.amplitudes(single, np.full(len(acting), scale)))
    logs, path = np.array(logs), np.array(path)
    gain = float(logsumexp(logs + path) - logsumexp(logs + np.array(constant)))
    free = alone[int(np.argmax(logs + path))]
    names = tuple(evidence.tests[number].seen.name for number in acting)
    total = float(logsumexp(logs + path) - logsumexp(logs))
    return gain, total, names, free.mean, np.sqrt(np.diag(free.covariance))


def _with_free(likelihood, columns, scales):
    """The likelihood with columns whose amplitudes are free in each test."""
    rows = block_diag(*(likelihood.whiten_one(number, one * scales) for number, one in enumerate(columns)))
    return replace(likelihood, nuisances=np.hstack([likelihood.nuisances, rows]))


def _columns(tests, quantity):
    """Rows by joint and test: of edges 1 m further in, or 1 m to one side, or of friction twice as large."""
    by_face = {
        face.name: [_of_face(test, index, face, quantity) for test in tests]
        for index, face in enumerate(tests[0].seen.faces)
    }
    together = {EVERYWHERE: [sum(own) for own in zip(*by_face.values(), strict=True)]}
    return {EDGES: together | by_face, MIDDLE: by_face, FRICTION: together}[quantity]


def _of_face(test, index, face, quantity):
    hinge, slide = test.hinges.get((index, 0)), test.slides.get(index)
    if quantity == FRICTION and slide:
        return face.friction * slide.friction
    if quantity != FRICTION and hinge:
        return hinge.inward if quantity == EDGES else hinge.along
    return np.zeros(len(test.rows.value))
