"""Calibration of the scores: every draw of the library is judged in turn as a measurement of known truth."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from blockshake.diagnosis.inference.constancy import constancy
from blockshake.diagnosis.libraries.candidates import effect_of
from blockshake.files import load_made_json, write_json

NONE = "none"
MOST_JUDGED = 500  # draws of a model: each is judged by all others, and ranked among those judged
_CASES_NEEDED = 10  # cases with which a chance below 10 % can be told
_SHOWN_CASES_NEEDED = 5  # cases that must say so: fewer are seen by chance
_SHOWN_SHARE = 0.9  # share of the cases of a size and larger ones that must be detected


@dataclass(frozen=True)
class ScoredReadings:
    """Scores of one set of readings, effect by effect.

    Attributes
    ----------
    truth : str
        Name of the effect that is in them, `NONE`, or ``""`` where nobody knows.
    size : float
        Of it, in units of the visible one.
    strongest : float
        Largest log ratio of any candidate [1].
    nominal : float
        Squared distance per feature of the readings from the nominal model [1].
    shortfall : dict of str to float
        By effect: by how much its best place falls short of the strongest candidate [1].
    distance : dict of str to float
        By effect: squared distance per feature at its best place, size and solver [1].
    constancy : dict of str to float
        By effect: chance of sizes that differ as much from test to test, at its best place [1]; see `constancy`.
    missed : float
        True size less the posterior's mean; NaN where there is no true size.
    """

    truth: str
    size: float
    strongest: float
    nominal: float
    shortfall: dict
    distance: dict
    constancy: dict
    missed: float


def write_cases(path, cases):
    """Write cases as JSON; JSON has no NaN, so that null stands for it."""
    write_json(path, rows_of(cases))


def load_cases(path):
    """Cases of a file that `write_cases` wrote.

    Raises
    ------
    InputError
        The file is missing or holds something else.
    """
    return load_made_json(path, cases_of)


def rows_of(cases):
    """Cases as JSON-like mappings; None stands for NaN."""
    return [vars(case) | {"missed": None if np.isnan(case.missed) else case.missed} for case in cases]


def cases_of(rows):
    """Cases of mappings from `rows_of`."""
    return [
        ScoredReadings(**row | {"missed": np.nan if row["missed"] is None else row["missed"]}) for row in rows
    ]


def best_place(scores, effect):
    """Key of the candidate that stands for an effect: its place with the largest ratio."""
    return max((key for key in scores.log_ratio if effect_of(key) == effect), key=scores.log_ratio.get)


def as_case(scores, key="", size=0.0):
    """Scores of one set of readings; ``key`` is the candidate that is true, `NONE`, or empty."""
    strongest = max(scores.log_ratio.values())
    effects = dict.fromkeys(effect_of(key) for key in scores.log_ratio)
    places = {effect: best_place(scores, effect) for effect in effects}
    return ScoredReadings(
        truth=effect_of(key),
        size=size,
        strongest=strongest,
        nominal=scores.distance["nominal"],
        shortfall={effect: strongest - scores.log_ratio[place] for effect, place in places.items()},
        distance={effect: scores.distance[place] for effect, place in places.items()},
        constancy={effect: constancy(scores.by_test[place]) for effect, place in places.items()},
        missed=size - float(scores.sizes[key] @ scores.weights[key]) if key in scores.sizes else np.nan,
    )


def library_cases(library, progress=None, keep=None):
    """Every draw of a `ScoreLibrary` in turn as a measurement, itself left out of the library that judges it.

    Of more than `MOST_JUDGED` draws of a model the first are judged, by all of them.
    A list of `ScoredReadings`. ``progress`` is called with a line of text after each draw. ``keep`` is called with
    model, draw and a function without arguments that gives the draw's cases, and gives these or the same from before.
    """
    cases = []
    for model in library.models:
        draws = min(len(library.tamed[0][model]["nominal"]), MOST_JUDGED)
        for draw in range(draws):
            judge = partial(_cases_of_draw, library, model, draw)
            cases += keep(model, draw, judge) if keep else judge()
            if progress is not None:
                progress(f"{model}: draw {draw + 1} of {draws} judged by the others")
    return cases


def _cases_of_draw(library, model, draw):
    by_test = [test[model] for test in library.tamed]
    scores = library.score([runs["nominal"][draw] for runs in by_test], model, draw)
    cases = [as_case(scores, NONE)]
    for key in library.candidates:
        if draw < len(library.sizes[model][key]):
            scores = library.score([runs[key][draw] for runs in by_test], model, draw)
            cases.append(as_case(scores, key, float(library.sizes[model][key][draw])))
    library.forget(model, draw)
    return cases


def chance_of_none(case, cases):
    """Chance of readings as odd as these without an effect.

    They are odd if a candidate explains them better than the nominal model, or if they are far from it whatever
    explains them, as an effect is that nobody has thought of. The smaller of both conformal p values is ranked among
    those of the readings without an effect, so that two looks cost what they cost and no more.
    """
    nominal = _nominal(cases)
    return _rank(-_oddness(case, nominal), [-_oddness(one, nominal) for one in nominal])


def detected(cases, level):
    """Those of the cases that are called an effect at a level."""
    nominal = _nominal(cases)
    reference = [-_oddness(one, nominal) for one in nominal]
    effects = [case for case in cases if case.truth != NONE]
    return [case for case in effects if _rank(-_oddness(case, nominal), reference) <= level]


def _nominal(cases):
    return [case for case in cases if case.truth == NONE]


def _oddness(case, nominal):
    """The smaller conformal p value of the strongest candidate and of the distance, among the others' readings."""
    others = [one for one in nominal if one is not case]
    return min(
        _rank(getattr(case, name), [getattr(one, name) for one in others])
        for name in ("strongest", "nominal")
    )


def chance_of(effect, case, cases):
    """Conformal p value of an effect: how often it falls as far short of the strongest where it is the truth.

    Parameters
    ----------
    effect : str
    case : ScoredReadings
    cases : list of ScoredReadings
        Detected ones.
    """
    alike = _alike(effect, cases)
    return _rank(case.shortfall[effect], [other.shortfall[other.truth] for other in alike])


def chance_of_distance(effect, distance, cases):
    """Share of the readings with an effect that are at this squared distance per feature from its fit, or farther."""
    return _rank(distance, [other.distance[other.truth] for other in _alike(effect, cases)])


def chance_of_constancy(effect, case, cases):
    """Chance of sizes as different from test to test where an effect is the truth, at least that of `constancy`."""
    alike = _alike(effect, cases)
    rank = _rank(-case.constancy[effect], [-other.constancy[other.truth] for other in alike])
    return max(rank, case.constancy[effect])


def shown_above(effect, cases, seen):
    """Size from which on nine in ten cases, at least five, are detected; in units of the visible one, NaN if none is.

    Parameters
    ----------
    effect : str
    cases : list of ScoredReadings
    seen : list of ScoredReadings
        Those of them that are detected.
    """
    own = [case for case in cases if case.truth == effect]
    found = {id(case) for case in seen}
    order = sorted(own, key=lambda case: abs(case.size), reverse=True)
    hits, smallest = 0, np.nan
    for count, case in enumerate(order, start=1):
        is_seen = id(case) in found
        hits += is_seen
        if is_seen and count >= _SHOWN_CASES_NEEDED and hits >= _SHOWN_SHARE * count:
            smallest = abs(case.size)
    return smallest


def size_error(effect, cases):
    """Root mean square of what the posterior's mean misses of the true size, in units of the visible one."""
    missed = np.array([case.missed for case in _alike(effect, cases)])
    return float(np.sqrt((missed**2).mean())) if len(missed) else np.inf


def _alike(effect, cases):
    """Cases in which an effect is the truth; where they are too few to exclude anything, those of all effects."""
    own = [case for case in cases if case.truth == effect]
    return own if len(own) >= _CASES_NEEDED else cases


def _rank(value, reference):
    return (1.0 + sum(other >= value for other in reference)) / (1.0 + len(reference))
