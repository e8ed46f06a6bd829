"""The answer in words: what acts, where and how large, and what the tests do not tell from it."""

import numpy as np

from blockshake.diagnosis.answer.thresholds import ODDS
from blockshake.diagnosis.verdict.grade import NOT_JUDGED, NOTHING, ONE_OF, UNKNOWN
from blockshake.diagnosis.wording import (
    beyond,
    cause_words,
    estimate_words,
    history_words,
    listed,
    name_of,
    named_place,
    place_words,
    times_words,
)
from blockshake.effects.registry import title_of
from blockshake.pages.wording import sentence_case
from blockshake.pages.words import Words

_MOST_PLACES = 4
_KINDS = {NOTHING: "nothing", NOT_JUDGED: "not judged", UNKNOWN: "unknown", ONE_OF: "one of"}
_STATED = Words(__name__)
RATIO = round(np.exp(ODDS))  # of odds, within which causes are not distinguished


def statement(diagnosed):
    """The answer in one sentence: what acts, where, and how large."""
    verdict, decision = diagnosed.verdict, diagnosed.decision
    acting = [[cause_words(one, _places(diagnosed, one)) for one in part.causes] for part in decision.parts]
    return _STATED.statement(
        word=verdict.word,
        kind=_KINDS.get(verdict.word, "named"),
        acting=acting,
        sensors=sensor_causes(diagnosed),
        tests=len(decision.moved or decision.tests),
    )


def until_then(diagnosed):
    """A factor on drifts of the nominal model to use until the cause is known better, or that none is known.

    The largest over the sealed tests of the upper limit of the drift with the cause over that without it, from the
    same samples, up to the next tenth; never below 1. None of a model that is not proposed.
    """
    gain, verdict = diagnosed.gain, diagnosed.verdict
    factors = {}
    simulated = gain is not None and "value" in gain and "test" in gain.dims
    if simulated and verdict.extension:
        for test in gain["test"].values:
            at = gain.sel(test=test, response="median_drift")
            without = float(at["value"].sel(side="without"))
            if without > 0.0 and np.isfinite(at["value_interval"]).all():
                upper = without + at["value_interval"].sel(side="change").to_numpy()[-1]
                factors[str(test)] = np.ceil(round(10.0 * max(1.0, float(upper) / without), 6)) / 10.0
    worst = max(factors, key=factors.get, default=None)
    unknown = [one for one in diagnosed.decision.parts if verdict.word == UNKNOWN and one.causes[0].places]
    return _STATED.until_then(
        judged=verdict.word != NOT_JUDGED,
        nothing=verdict.word == NOTHING,
        sensors=not diagnosed.decision.parts and bool(sensor_faults(diagnosed)),
        factor=factors.get(worst),
        test=worst,
        limits=sum(name not in verdict.causes for name in verdict.excluded_above),
        quick=diagnosed.effort == "quick",
        idle=simulated and not verdict.extension,
        inspect=" and ".join(_places(diagnosed, one.causes[0]) for one in unknown),
    )


def _places(diagnosed, cause):
    """Bodies or joints that the tests do not tell apart, in words."""
    if len(cause.places) == 1:
        return place_words(cause.place)
    names = list(dict.fromkeys(name.partition("@")[0] for name in cause.places))
    words = [named_place(name, diagnosed.bodies) for name in names]
    if len(words) > _MOST_PLACES:
        words = [*words[: _MOST_PLACES - 1], f"{len(words) - _MOST_PLACES + 1} other places"]
    return listed(words, "or")


def sensor_faults(diagnosed):
    """Sensors of each fault among the causes of the verdict, by its name."""
    physical = [one.name for one in diagnosed.decision.causes]
    where = {name: [] for name in diagnosed.verdict.causes if name not in physical}
    for one in diagnosed.parity.findings:
        if one.effect in where:
            where[one.effect] += one.where
    return where


def sensor_causes(diagnosed):
    """Faults of sensors among the causes of the verdict, in words with their sizes."""
    known = diagnosed.verdict.parameters
    return [
        ", ".join([
            f"{title_of(name)} ({', '.join(dict.fromkeys(own))})",
            *(f"{key} {estimate_words(key, one)}" for key, one in known.get(name, {}).items()),
        ])
        for name, own in sensor_faults(diagnosed).items()
    ]  # fmt: skip


def changed(diagnosed):
    """Sentences on sizes that change from test to test."""
    return [sentence_case(history_words(path)) for path in diagnosed.decision.histories if path.changes]


def not_distinguished(diagnosed):
    """Sentences on what the tests do not tell from the answer, one a part of the readings."""
    decision = diagnosed.decision
    if not decision.parts:
        limits = [f"{title_of(name)} {beyond(name, size)}" for name, size in decision.excluded_above.items()]
        return [_STATED.smaller(limits)]
    return [_not_distinguished_from(diagnosed, part) for part in decision.parts]


def _not_distinguished_from(diagnosed, part):
    first, *others = part.causes
    tried = {name: odds for name, odds in part.odds.items() if odds >= ODDS}
    nearest = min(tried, key=tried.get, default=None)
    words = _STATED.not_distinguished(
        part=part.readings if len(diagnosed.decision.parts) > 1 else "",
        first=first.title,
        others=[f"{one.title} ({times_words(one.odds)})" for one in others],
        ratio=RATIO,
        tried=len(tried),
        nearest=nearest and {"name": name_of(nearest), "times": times_words(tried[nearest])},
        places=_places(diagnosed, first) if len(first.places) > 1 else "",
        best=named_place(first.places[0], diagnosed.bodies) if first.places else "",
    )
    return words[0].upper() + words[1:]
