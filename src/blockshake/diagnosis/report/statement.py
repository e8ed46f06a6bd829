"""The answer in words: what acts, where and how large, and what the tests do not tell from it."""

import numpy as np

from blockshake.diagnosis.answer.answer import ODDS
from blockshake.diagnosis.verdict.ladder import NOTHING, ONE_OF, UNKNOWN
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
from blockshake.pages.wording import count_words, sentence_case

_MOST_PLACES = 4
RATIO = round(np.exp(ODDS))  # of odds, within which causes are not told apart


def statement(diagnosed):
    """The answer in one sentence: what acts, where, and how large."""
    verdict, decision = diagnosed.verdict, diagnosed.decision
    word = verdict.word[0].upper() + verdict.word[1:]
    acting = [
        "; or ".join(cause_words(one, _places(diagnosed, one)) for one in part.causes)
        for part in decision.parts
    ]
    sensors = sensor_causes(diagnosed)
    if verdict.word == NOTHING:
        return f"{word}: {_looked_at(decision)} hold no force that sound blocks would not make."
    if verdict.word == UNKNOWN:
        return (
            f"{word}. No effect of the registry makes these forces; most like {'; beside it '.join(acting)}."
        )
    words = "; together with ".join([*sensors, *acting])
    if verdict.word == ONE_OF:
        return f"{word} these, which the tests do not tell apart: {words}."
    rest = (
        "" if acting else f"; beside it {_looked_at(decision)} hold no force that sound blocks would not make"
    )
    return f"{word}: {words}{rest}."


def _looked_at(decision):
    tests = count_words(len(decision.moved or decision.tests), "test")
    return f"{count_words(decision.n_rows, 'equation')} of motion in {tests}"


def _places(diagnosed, cause):
    """Bodies or joints that the tests do not tell apart, in words."""
    if len(cause.places) == 1:
        return place_words(cause.place)
    names = list(dict.fromkeys(name.partition("@")[0] for name in cause.places))
    words = [named_place(name, diagnosed.bodies) for name in names]
    if len(words) > _MOST_PLACES:
        words = [*words[: _MOST_PLACES - 1], f"{len(words) - _MOST_PLACES + 1} other places"]
    return listed(words, "or")


def sensor_causes(diagnosed):
    """Faults of sensors among the causes of the verdict, in words with their sizes."""
    physical = [one.name for one in diagnosed.decision.causes]
    where = {name: [] for name in diagnosed.verdict.causes if name not in physical}
    for one in diagnosed.parity.findings:
        if one.effect in where:
            where[one.effect] += one.where
    known = diagnosed.verdict.parameters
    return [
        ", ".join([
            f"{title_of(name)} ({', '.join(dict.fromkeys(own))})",
            *(f"{key} {estimate_words(key, one)}" for key, one in known.get(name, {}).items()),
        ])
        for name, own in where.items()
    ]  # fmt: skip


def changed(diagnosed):
    """Sentences on sizes that change from test to test."""
    return [sentence_case(history_words(path)) for path in diagnosed.decision.histories if path.changes]


def not_told(diagnosed):
    """Sentences on what the tests do not tell from the answer, one a part of the readings."""
    decision = diagnosed.decision
    if not decision.parts:
        limits = [f"{title_of(name)} {beyond(name, size)}" for name, size in decision.excluded_above.items()]
        seen = f"These would have been seen wherever they act: {listed(limits)}. " if limits else ""
        return [f"{seen}Smaller ones, and what has no limit in the table of limits, may act all the same."]
    return [_not_told_from(diagnosed, part) for part in decision.parts]


def _not_told_from(diagnosed, part):
    first, *others = part.causes
    rivals = {name: odds for name, odds in part.odds.items() if odds >= ODDS}
    if others:
        names = listed(f"{one.title} ({times_words(one.odds)})" for one in others)
        words = f"{first.title} is likelier than {names}, and {RATIO} times would tell them apart."
    elif rivals:
        nearest = min(rivals, key=rivals.get)
        words = (
            f"the tests tell {first.title} from all others that were tried ({count_words(len(rivals), 'cause')}); "
            f"it is {times_words(rivals[nearest])} likelier than {name_of(nearest)}, the nearest of them."
        )
    else:
        words = "no other cause was tried on these readings."
    if len(diagnosed.decision.parts) > 1:
        words = f"{part.readings}: {words}"
    if len(first.places) > 1:
        best, among = named_place(first.places[0], diagnosed.bodies), _places(diagnosed, first)
        words += f" Its {'height' if among in best else f'place, {among},'} is not told; likeliest is {best}."
    return words[0].upper() + words[1:]
