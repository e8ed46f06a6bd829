"""First section of a diagnosis: the answer in its box, and the forces that it rests on."""

import numpy as np

from blockshake.diagnosis.report.figures.forces import plot_forces, plot_slab, shown_bodies, shown_tests
from blockshake.diagnosis.report.statement import not_told, sensor_causes, statement
from blockshake.diagnosis.wording import chance_words, estimate_words, percent_words
from blockshake.effects.registry import title_of
from blockshake.pages.blocks import Box, Figure, Items, Section, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import sentence_case

_OF_SLAB = {"rotation of the slab": "turn", "vertical motion of the slab": "lift"}
_ABOUT = 0.5  # s, of a blow, that are drawn before and after it


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


def _items(found):
    verdict, items = found.verdict, []
    if verdict.missing:
        items.append(f"Not called established because {'; '.join(verdict.missing)}.")
    if found.parity.findings and not sensor_causes(found):
        faults = "; ".join(f"{title_of(one.effect)}, {', '.join(one.where)}" for one in found.parity.findings)
        items.append(f"Faults of sensors were found and taken out of the readings first: {faults}.")
    if verdict.next_test:
        items.append(f"Measurement that would decide: {verdict.next_test}.")
    return tuple(items)


def _figures(found):
    """Figures of measured and explained forces on blocks and motion of the slab."""
    parts = found.decision.parts
    moves = [part for part in parts if part.readings in _OF_SLAB]
    joints = [part.causes[0] for part in parts if part not in moves]
    return [
        *([_forces(found, joints)] if joints or not moves else []),
        *(_slab(found, part) for part in moves),
    ]


def _forces(found, causes):
    """Measured and explained forces; without any a sentence."""
    shown, when = found.departures, [one.when for one in causes]
    bodies = shown_bodies(shown, [one.place.get("body") for one in causes])
    if not bodies:
        return Text(
            "No joint turned, slipped or lifted in any test, so that no force can be read off the motion."
        )
    blows = {test: one["time"] for own in when for test, one in own.get("blows", {}).items()}
    shown = shown.isel(instant=_near(shown, blows))
    tests = shown_tests(shown)
    left_out = [name for name in found.decision.tests if name not in tests]
    titles = " and ".join(one.title for one in causes if shown["explained"].any())
    words = (
        "Forces that sound blocks do not make, where a joint turns, slips or lifts: the horizontal force that "
        f"would have to act at the middle of {' or of '.join(bodies)}, if all of it acted there. Black: "
        f"{found.measured_word}. {f'Blue: {titles} at the likeliest size. ' if titles else ''}Without a cause "
        "there is none: the line at 0. Grey: two standard deviations of the sensors' noise."
        + (f" Drawn is what lies within {_ABOUT:g} s of a blow." if blows else "")
        + (f" Not drawn: {', '.join(left_out)}." if left_out else "")
    )
    return Figure(words, svg_of(plot_forces, shown, tests, bodies, titles, found.measured_word))


def _near(shown, blows):
    """Whether instants are near the blow of their test; all of them without a blow."""
    at = np.array([blows.get(test, np.inf) for test in shown["test"].values.tolist()])
    return np.flatnonzero(np.abs(shown["time"].to_numpy() - at) <= _ABOUT) if blows else slice(None)


def _slab(found, part):
    name, title = _OF_SLAB[part.readings], part.causes[0].title
    share = ", as far as it follows the horizontal motion" if name == "lift" else ""
    words = (
        f"{sentence_case(part.readings)[:-1]}, from rest. Black: {found.measured_word}. Blue: {title} at the "
        f"likeliest size{share}. A sound table makes none: the line at 0."
    )
    return Figure(words, svg_of(plot_slab, found.departures, name, title, found.measured_word))
