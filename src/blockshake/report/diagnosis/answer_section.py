"""First section of a diagnosis: the answer in its box, and the forces that it rests on."""

from blockshake.diagnosis.answer.answer import ODDS
from blockshake.diagnosis.verdict.ladder import NOTHING, ONE_OF, UNKNOWN
from blockshake.effects.registry import title_of
from blockshake.report.diagnosis.figures.forces import plot_forces, shown_bodies, shown_tests
from blockshake.report.diagnosis.wording import (
    beyond,
    cause_words,
    chance_words,
    estimate_words,
    listed,
    name_of,
    named_place,
    odds_words,
    place_words,
)
from blockshake.report.document.blocks import Figure, Items, Section, Text
from blockshake.report.document.box import Box
from blockshake.report.document.drawing import svg_of
from blockshake.report.document.wording import count_words, sentence_case

_MOST_PLACES = 4


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
    return Section("Answer", "answer", (*blocks, *([Items(items)] if items else []), _forces(found)))


def statement(found):
    """The answer in one sentence: what acts, where, and how large."""
    verdict, decision = found.verdict, found.decision
    word = verdict.word[0].upper() + verdict.word[1:]
    acting = [_of_part(found, part) for part in decision.parts]
    sensors = _sensor_causes(found)
    if verdict.word == NOTHING:
        return f"{word}: {_looked_at(decision)} hold no force that sound blocks would not make."
    if verdict.word == UNKNOWN:
        return f"{word}. No effect of the registry makes these forces; most like {'; beside it '.join(acting)}."
    words = "; together with ".join([*sensors, *acting])
    if verdict.word == ONE_OF:
        return f"{word} these, which the tests do not tell apart: {words}."
    rest = "" if acting else f"; beside it {_looked_at(decision)} hold no force that sound blocks would not make"
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
    physical = {one.name for one in found.decision.causes}
    return [
        f"{title_of(name)} ({', '.join(found.verdict.location.get(name, {'': 'all markers'}).values())})"
        for name in found.verdict.causes
        if name not in physical
    ]


def not_told(found):
    """Sentences on what the tests do not tell from the answer, one a part of the readings."""
    decision = found.decision
    if not decision.parts:
        limits = [f"{title_of(name)} {beyond(name, size)}" for name, size in decision.excluded_above.items()]
        seen = f"Wherever it acts, this would have been seen from these sizes on: {listed(limits)}. " if limits else ""
        return [f"{seen}A smaller cause may act all the same; limits by place are in the table of limits."]
    return [_not_told_from(found, part) for part in decision.parts]


def _not_told_from(found, part):
    first, *others = part.causes
    start = "" if len(found.decision.parts) == 1 else f"{sentence_case(part.readings)[:-1]}: "
    if others:
        names = (f"{one.title} (odds {odds_words(one.odds)})" for one in others)
        words = f"{first.title.capitalize()} is likeliest; the tests do not tell it from {listed(names)}."
    else:
        rivals = {name: odds for name, odds in part.odds.items() if odds >= ODDS}
        words = f"The tests tell {first.title} from all {len(rivals)} other causes that were tried"
        if rivals:
            nearest = min(rivals, key=rivals.get)
            words += f"; the nearest of them is {name_of(nearest)} (odds {odds_words(rivals[nearest])})"
        words += "."
    if len(first.places) > 1:
        best = named_place(first.places[0], found.bodies)
        words += f" Where it acts the tests do not tell: {best} is likeliest, by less than 1 to 20."
    return start + words


def _facts(found):
    """The three numbers of the box: chance without a cause, size, gain, each with its label and a note."""
    return (
        (
            "Chance of such readings without a cause",
            chance_words(found.verdict.misfit.p),
            "at most, over all that was tried",
        ),
        _size_fact(found),
        _gain_fact(found.verdict),
    )


def _size_fact(found):
    for part in found.decision.parts:
        first = part.causes[0]
        for name, estimate in first.parameters.items():
            return f"{name} of {first.title}", estimate_words(estimate), "90 % interval"
    limits = found.decision.excluded_above
    return "Effects excluded from some size on", str(len(limits)), "wherever they act; sizes in the table of limits"


def _gain_fact(verdict):
    label = "Share of the forces of sealed tests explained"
    gain = verdict.row_gain
    if gain is None:
        why = next((one for one in verdict.caveats if "gain was measured" in one), "nothing acts that could explain any")
        return label, "not measured", why
    own = gain.nominal
    return label, percent_words(own), "at the sizes frozen before; 90 % interval"


def percent_words(contrast):
    """A gain with its interval in percent: ``71 % (62 to 80 %)``."""
    return f"{100.0 * contrast.estimate:.0f} % ({100.0 * contrast.lower:.0f} to {100.0 * contrast.upper:.0f} %)"


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


def _forces(found):
    """Measured and explained forces; without rows a sentence."""
    shown, decision = found.departures, found.decision
    if not shown.sizes["instant"]:
        return Text("No joint turned, slipped or lifted in any test, so that no force can be read off the motion.")
    causes = [one.title for one in decision.extending]
    tests, bodies = shown_tests(shown), shown_bodies(shown, [one.place.get("body") for one in decision.extending])
    left_out = [name for name in decision.tests if name not in tests]
    explained = f"Blue: the same made by {' and '.join(causes)} at the likeliest size. " if causes else ""
    words = (
        "Forces that sound blocks do not make: the horizontal force at the centre of a block that alone would bring "
        f"about what was {found.measured_word}, where a joint turns, slips or lifts; each row of panels asks another "
        f"block to carry all of it. Black: {found.measured_word}; grey: two standard deviations of the sensors to "
        f"either side. {explained}The model without a cause makes none: the line at 0."
        + (f" Not drawn: {', '.join(left_out)}." if left_out else "")
    )
    return Figure(words, svg_of(plot_forces, shown, tests, bodies, causes, found.measured_word))
