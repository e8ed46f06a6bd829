"""A campaign as a history: sizes by test, and whether they change from test to test, as edges that wear do.

Beside one value for all tests stands a random walk from test to test, since damage stays.
"""

import numpy as np
from scipy.special import logsumexp

from blockshake.diagnosis.answer.answer import needed_beside, needed_of
from blockshake.diagnosis.answer.decision import Estimate, History
from blockshake.diagnosis.answer.places import EVERYWHERE, place_of
from blockshake.diagnosis.answer.size import FORM
from blockshake.diagnosis.evidence.explanation import mean_evidence
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS

EDGES, FRICTION = "edges", "friction"
_OF_EDGES = ("reduced-bearing", "changed-edge")  # causes whose own path is that of the edges
_INSET, _SHARE = 0.05, 0.3  # m; of the coefficient: standard deviations of the priors
_STEPS = (0.1, 0.3, 1.0)  # of the prior's deviation, from test to test
_SCATTER = 0.02  # of it, from test to test without damage: blocks are set up anew
_SIGMAS = 1.645  # of a Gaussian, within which nine tenths lie


def histories(evidence, beside, first, seen):
    """Sizes by test of the first cause, of the edges and of the friction.

    Parameters
    ----------
    evidence, beside : Evidence or None
        Without any cause, and with the first cause in the joints among the nuisances.
    first : Rival or None
        That cause.
    seen : SeenTest
        Any test.

    Returns
    -------
    tuple of History
        Of what two tests at least tell; the cause's own first, where it has an amplitude and acts in all tests.
    """
    if evidence is None:
        return ()
    more = needed_beside(False, first.gain) if first and (first.cause, first.place) in evidence.keys else 0.0
    own = _own(evidence, first, seen, more) if more else None
    found = [own]
    rest = beside or evidence
    if own is None or first.cause not in _OF_EDGES:
        found.append(_of_sound_joints(rest, EDGES, "inset", "m", _INSET, _insets(rest.tests), more))
    found.append(_of_sound_joints(rest, FRICTION, "change", "1", _SHARE, _frictions(rest.tests), more))
    return tuple(one for one in found if one)


def of_last_test(cause, history):
    """A `Cause` as large as in the last test of its own `History`: what acts in tests to come is that large."""
    name, present = next(iter(cause.parameters.items()))
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
            "amplitudes": tuple(share * one for one in cause.amplitudes),
        }
    )


def _own(evidence, first, seen, more):
    """`History` of a cause at its best place; None where it has no amplitude or does not act in all tests."""
    key = first.cause, first.place
    fit = evidence.best(key).best
    size = float(fit.contrast @ fit.mean)
    if not fit.covariance.any() or size == 0.0:
        return None
    place = place_of(first.cause, first.place, seen)
    if first.cause in FORMS:
        form = FORMS[first.cause]
        if form.rows is None:
            return None
        columns = [form.rows(test, place, fit.values) for test in evidence.tests]
        name, unit, read = form.size, form.unit, np.asarray
    else:
        parameter = EFFECTS[first.cause].parameters[0]
        name, unit = parameter.name, parameter.unit
        columns = [rows @ fit.mean / size for rows in fit.columns]

        def read(amplitudes):
            return EFFECTS[first.cause].reads(fit.values, np.asarray(amplitudes), 0.0)[name]

    found = _weighed(evidence, columns, float(fit.scales[0]))
    return found and _history(first.cause, name, place, unit, found, needed_of(first.cause) + more, read)


def _of_sound_joints(evidence, quantity, name, unit, scale, by_place, more):
    """`History` of a size that sound joints have too, where it changes most; its gain is averaged over the places."""
    found = {place: _weighed(evidence, columns, scale) for place, columns in by_place.items()}
    found = {place: one for place, one in found.items() if one}
    if not found:
        return None
    best = max(found, key=lambda place: found[place][0])
    place = {} if best == EVERYWHERE else place_of(_OF_EDGES[1], best, evidence.tests[0].seen)
    gain = float(mean_evidence([one[0] for one in found.values()]))
    return _history(
        quantity, name, place, unit, (gain, *found[best][1:]), needed_of(quantity) + more, np.asarray
    )


def _history(quantity, name, place, unit, found, needed, read):
    gain, tests, means, deviations = found
    reach = _SIGMAS * np.hypot(deviations, FORM * means)
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


def _weighed(evidence, columns, scale):
    """Gain of a path over one value, names of the tests, and the amplitudes of each test alone with their deviations.

    ``columns`` are by test, (n_rows,) each, per unit of the amplitude. Amplitudes of single tests have the prior of the
    cause each, and share the nuisances. None where fewer than two tests have the column.
    """
    acting = [number for number, column in enumerate(columns) if column.any()]
    if len(acting) < 2:
        return None
    logs, constant, path, alone = [], [], [], []
    for explained in evidence.explained:
        likelihood = explained.likelihood
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
    return gain, names, free.mean, np.sqrt(np.diag(free.covariance))


def _insets(tests):
    """Rows of edges 1 m further in by joint, and of all joints together."""
    faces = sorted({face for test in tests for face, tangent in test.hinges if tangent == 0})
    columns = {tests[0].seen.faces[face].name: [_inset(test, [face]) for test in tests] for face in faces}
    return {EVERYWHERE: [_inset(test, faces) for test in tests], **(columns if len(columns) > 1 else {})}


def _inset(test, faces):
    none = np.zeros(len(test.rows.value))
    return sum((test.hinges[face, 0].inward for face in faces if (face, 0) in test.hinges), none)


def _frictions(tests):
    """Rows of a coefficient of friction twice as large, of all joints together."""
    faces = tests[0].seen.faces
    return {
        EVERYWHERE: [
            sum(
                (faces[face].friction * slide.friction for face, slide in test.slides.items()),
                np.zeros(len(test.rows.value)),
            )
            for test in tests
        ]
    }
