"""First section of a diagnosis: the answer in its box, and the forces that it rests on."""

import numpy as np

from blockshake.diagnosis.answer.answer import ODDS
from blockshake.diagnosis.verdict.ladder import NOTHING, ONE_OF, UNKNOWN
from blockshake.effects.registry import title_of
from blockshake.report.diagnosis.figures.forces import plot_forces, plot_slab, shown_bodies, shown_tests
from blockshake.report.diagnosis.wording import (
    beyond,
    cause_words,
    chance_words,
    estimate_words,
    listed,
    name_of,
    named_place,
    place_words,
    times_words,
)
from blockshake.report.document.blocks import Figure, Items, Section, Text
from blockshake.report.document.box import Box
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import count_words, sentence_case

_MOST_PLACES = 4
_RATIO = round(np.exp(ODDS))  # of odds, within which causes are not told apart
_OF_SLAB = {"rotation of the slab": "turn", "vertical motion of the slab": "lift"}


def answer_section(found):
    """The answer in two sentences, what holds it back, and the forces measured and explained."""
    blocks = [Box(statement(found), _facts(found)), *(Text(words) for words in not_told(found))]
    if found.synthetic:
        blocks.append(
            Text(
                "The tests are SYNTHETIC: virtual tests, computed and seen through made-up sensors. Nothing was "
                "measured; 'measured' below means read off the virtual test.",
                strong=True,
            )
        )
    items = _items(found)
    return Section("Answer", "answer", (*blocks, *([Items(items)] if items else []), *_figures(found)))


def statement(found):
    """The answer in one sentence: what acts, where, and how large."""
    verdict, decision = found.verdict, found.decision
    word = verdict.word[0].upper() + verdict.word[1:]
    acting = [_of_part(found, part) for part in decision.parts]
    sensors = _sensor_causes(found)
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
    tests = count_words(len(decision.tests), "test")
    return f"{count_words(decision.n_rows, 'equation')} of motion in {tests}"


def _of_part(found, part):
    """Causes of one part of the readings that are not told apart."""
    return "; or ".join(cause_words(one, _places(found, one)) for one in part.causes)


def _places(found, cause):
    """Bodies or joints that the tests do not tell apart, in words."""
    if len(cause.places) == 1:
        return place_words(cause.place)
    names = list(dict.fromkeys(name.partition("@")[0] for name in cause.places))
    words = [named_place(name, found.bodies) for name in names]
    if len(words) > _MOST_PLACES:
        words = [*words[: _MOST_PLACES - 1], f"{len(words) - _MOST_PLACES + 1} other places"]
    return listed(words, "or")


def _sensor_causes(found):
    """Faults of sensors among the causes of the verdict, in words."""
    physical = [one.name for one in found.decision.causes]
    where = {name: [] for name in found.verdict.causes if name not in physical}
    for one in found.parity.findings:
        if one.effect in where:
            where[one.effect] += one.where
    known = found.verdict.parameters
    return [
        ", ".join([
            f"{title_of(name)} ({', '.join(dict.fromkeys(own))})",
            *(f"{key} {estimate_words(key, one)}" for key, one in known.get(name, {}).items()),
        ])
        for name, own in where.items()
    ]  # fmt: skip


def not_told(found):
    """Sentences on what the tests do not tell from the answer, one a part of the readings."""
    decision = found.decision
    if not decision.parts:
        limits = [f"{title_of(name)} {beyond(name, size)}" for name, size in decision.excluded_above.items()]
        seen = f"These would have been seen wherever they act: {listed(limits)}. " if limits else ""
        return [f"{seen}Smaller ones, and what has no limit in the table of limits, may act all the same."]
    return [_not_told_from(found, part) for part in decision.parts]


def _not_told_from(found, part):
    first, *others = part.causes
    words = "" if len(found.decision.parts) == 1 else f"{sentence_case(part.readings)[:-1]}: "
    if others:
        names = listed(f"{one.title} ({times_words(one.odds)})" for one in others)
        words += f"{first.title} is likelier than {names}, and {_RATIO} times would tell them apart."
    else:
        rivals = {name: odds for name, odds in part.odds.items() if odds >= ODDS}
        tried = f"all others that were tried ({count_words(len(rivals), 'cause')})" if rivals else "nothing"
        words += f"the tests tell {first.title} from {tried}"
        if rivals:
            nearest = min(rivals, key=rivals.get)
            words += f"; it is {times_words(rivals[nearest])} likelier than {name_of(nearest)}, the nearest of them"
        words += "."
    if len(first.places) > 1:
        best, among = named_place(first.places[0], found.bodies), _places(found, first)
        words += f" Its {'height' if among in best else f'place, {among},'} is not told; likeliest is {best}."
    return words[0].upper() + words[1:]


def _facts(found):
    """The three numbers of the box: chance without a cause, size, gain, each with its label and a note."""
    return (
        (
            "Chance of such readings without a cause",
            chance_words(found.verdict.misfit.p),
            "upper bound, over all that was tried",
        ),
        _size_fact(found),
        _gain_fact(found.verdict),
    )


def _size_fact(found):
    for part in found.decision.parts:
        first = part.causes[0]
        for name, estimate in first.parameters.items():
            return f"{name} of {first.title}", estimate_words(name, estimate), "90 % interval"
    limits = found.decision.excluded_above
    return (
        "Effects excluded from some size on",
        str(len(limits)),
        "wherever they act; sizes in the table of limits",
    )


def _gain_fact(verdict):
    label = "Error on sealed tests that the cause removes"
    gain = verdict.row_gain
    if gain is None:
        reasons = [one for one in verdict.caveats if "gain was measured" in one]
        return label, "not measured", (reasons or ["nothing acts that could explain any"])[0]
    words = "on forces, of the recalibrated model's error; size frozen before; 90 % interval"
    return label, percent_words(gain.recalibrated), words


def percent_words(contrast):
    """A gain with its interval in percent: ``71 % (62 to 80 %)``; from -1 to 1 where nothing is there to gain."""
    if contrast.lower <= -1.0 and contrast.upper >= 1.0:
        return "nothing to gain"
    return (
        f"{100.0 * contrast.estimate:.0f} % ({100.0 * contrast.lower:.0f} to {100.0 * contrast.upper:.0f} %)"
    )


def _items(found):
    verdict, items = found.verdict, []
    if verdict.missing:
        items.append(f"Not called established because {'; '.join(verdict.missing)}.")
    if found.parity.findings:
        faults = "; ".join(f"{title_of(one.effect)}, {', '.join(one.where)}" for one in found.parity.findings)
        items.append(f"Faults of sensors were found and taken out of the readings first: {faults}.")
    if verdict.next_test:
        items.append(f"Measurement that would decide: {verdict.next_test}.")
    return tuple(items)


def _figures(found):
    """What was measured and what the causes explain of it: forces on blocks, motion of the slab."""
    parts = found.decision.parts
    moves = [part for part in parts if part.readings in _OF_SLAB]
    joints = [part.causes[0] for part in parts if part not in moves]
    return [
        *([_forces(found, joints)] if joints or not moves else []),
        *(_slab(found, part) for part in moves),
    ]


def _forces(found, causes):
    """Measured and explained forces; without rows a sentence."""
    shown = found.departures
    if not shown.sizes["instant"]:
        return Text(
            "No joint turned, slipped or lifted in any test, so that no force can be read off the motion."
        )
    tests, bodies = shown_tests(shown), shown_bodies(shown, [one.place.get("body") for one in causes])
    left_out = [name for name in found.decision.tests if name not in tests]
    titles = " and ".join(one.title for one in causes if shown["explained"].any())
    explained = f"Blue: {titles} at the likeliest size. " if titles else ""
    words = (
        "Forces that sound blocks do not make, where a joint turns, slips or lifts: the horizontal force that "
        f"would have to act at the middle of {' or of '.join(bodies)}, if all of it acted there. Black: "
        f"{found.measured_word}. {explained}Without a cause there is none: the line at 0. Grey: two standard "
        "deviations of the sensors' noise." + (f" Not drawn: {', '.join(left_out)}." if left_out else "")
    )
    return Figure(words, svg_of(plot_forces, shown, tests, bodies, titles, found.measured_word))


def _slab(found, part):
    name, title = _OF_SLAB[part.readings], part.causes[0].title
    words = (
        f"{sentence_case(part.readings)[:-1]}, from rest. Black: {found.measured_word}. Blue: {title} at the "
        "likeliest size. A sound table makes none: the line at 0."
    )
    return Figure(words, svg_of(plot_slab, found.departures, name, title, found.measured_word))
