"""The report on filmed flights, and its sections."""

import numpy as np

from blockshake.diagnosis.verdict.found import (
    cause_words,
    document,
    load_found,
    odds_section,
)
from blockshake.diagnosis.wording import estimate_in_si, percent_words
from blockshake.geometry.structure import load_structure
from blockshake.pages.blocks import Box, Figure, Items, Section, Table, Text
from blockshake.pages.drawing import BLUE, GREEN, GREY, ORANGE, svg_of
from blockshake.pages.wording import MISSING, count_words, number, sentence_case
from blockshake_flight.causes import CAUSES
from blockshake_flight.figure import plot_accelerations, plot_errors

_MODELS = {"nominal": GREY, "recalibrated": ORANGE, "discrepancy": GREEN, "extended": BLUE}
TITLES = {cause.name: cause.title for cause in CAUSES}
_WORDS = {
    "nominal": "as in the structure file",
    "recalibrated": "recalibrated without a cause",
    "discrepancy": "recalibrated, with a steady acceleration without a name",
    "extended": "with the causes, recalibrated",
}


def compose_flights(campaign, results, effort, track_record):
    """`Document` of the diagnosis of a campaign without base motion, from the folder of its results.

    It has no track record.
    """
    found = load_found(results)
    tests = count_words(len(found.decision.tests), "test")
    subtitle = f"{load_structure(campaign.structure).file.name} over a ground at rest, {tests}"
    sections = [section(found) for section in (answer_section, gain_section, impacts_section)]
    sections.append(odds_section(found.decision, TITLES, "free flights"))
    return document(campaign, effort, found, subtitle, sections)


def answer_section(found):
    """The answer, the size of its causes, and what the poses do not show."""
    verdict, decision = found.verdict, found.decision
    causes = [part.causes[0] for part in decision.parts]
    words = sentence_case(verdict.word)
    if causes:
        acting = "; with it ".join(cause_words(cause, TITLES[cause.name]) for cause in causes)
        words = sentence_case(f"{verdict.word}: {acting}")
    facts = tuple(map(_largest, causes[:1]))
    share = found.evidence.attrs["explained_share"]
    facts += (
        ("Share of the flights' misfit explained", f"{100.0 * share:.0f} %", "beyond the noise of the poses"),
        (
            "Error of sealed paths that the causes remove",
            _gain_words(verdict),
            "against the recalibrated model",
        ),
    )
    shown = [axis for axis in "xyz" if np.ptp(found.evidence["velocity"].sel(axis=axis).to_numpy()) > 0.0]
    return Section(
        "Answer", "answer",
        (
            Box(words, facts),
            Items(tuple(map(sentence_case, verdict.caveats))),
            Figure(
                "Acceleration beyond gravity of every free flight over its mean velocity, those that tests begin "
                "with in orange. Black: medians of flights in bins of equal numbers; blue: the same of what the causes "
                "make. Without a cause all lie on the dashed line.",
                svg_of(plot_accelerations, found.evidence, shown),
            ),
        ),
    )  # fmt: skip


def _largest(cause):
    """Fact of the parameter that is most sure not to be zero."""
    name, estimate = max(
        cause.parameters.items(),
        key=lambda one: abs(one[1].estimate) / max(one[1].upper - one[1].lower, 1e-12),
    )
    return f"{name} of {TITLES[cause.name]}", estimate_in_si(estimate), "90 % interval"


def _gain_words(verdict):
    return percent_words(verdict.gain.recalibrated) if verdict.gain else "not measured"


def impacts_section(found):
    """Quartiles of what impacts keep, by kind."""
    rows = []
    for kind in ("corner", "edge", "face"):
        own = found.evidence.isel(impact=np.flatnonzero(found.evidence["kind"].to_numpy() == kind))
        if own.sizes["impact"]:
            rows.append(
                (
                    kind,
                    str(own.sizes["impact"]),
                    *(_quartiles(own[name]) for name in ("restitution", "ratio", "kept")),
                )
            )
    if not rows:
        return None
    return Section(
        "Impacts", "impacts",
        (
            Text(sentence_case(found.decision.impacts)),
            Table(
                "Impacts between two flights, and faces that come down in rocking (without restitution): median and "
                "quartiles. Restitution: of the normal velocity of the contact; ratio: tangential over normal impulse; "
                "spin kept: along the spin before, negative where the body returns to the edge that it came from.",
                ("Contact", "Impacts", "Restitution", "Ratio of impulses", "Spin kept"), tuple(rows), "lrrrr",
            ),
        ),
    )  # fmt: skip


def _quartiles(values):
    values = values.to_numpy()[np.isfinite(values)]
    if not len(values):
        return MISSING
    lower, median, upper = np.quantile(values, (0.25, 0.5, 0.75))
    return f"{median:.2f} ({lower:.2f} to {upper:.2f})"


def gain_section(found):
    """Errors of whole paths on sealed tests, by model; None where none was measured."""
    gain = found.gain
    if gain is None:
        return None
    rows = []
    for kind, words in _WORDS.items():
        own = gain.sel(kind=kind)
        rows.append((
            words, number(own["friction"]), number(own["restitution"]),
            *(f"{number(factor * own[name].mean())} +- {number(factor * own[name].std())}"
              for name, factor in (("early", 1e3), ("place", 1e3), ("turn", np.degrees(1.0)))),
        ))  # fmt: skip
    against = {
        "the model as in the structure file": found.verdict.gain.nominal,
        "the recalibrated model": found.verdict.gain.recalibrated,
        "a steady acceleration without a name": found.verdict.gain.discrepancy,
    }
    return Section(
        "Gain on sealed tests", "gain",
        (
            Text(
                f"{gain.sizes['test']} sealed tests were simulated from the state that their first flight shows; "
                "nothing was fitted to their impacts. Gain: the share of a rival's mean error of the middle's path "
                "that the model with the causes removes."
            ),
            Table(
                "Gain with its interval of 90 %, tests drawn again.", ("Alternative", "Gain"),
                tuple((words, percent_words(one)) for words, one in against.items()), "lr",
            ),
            Table(
                "Friction and restitution of each model, and its errors: mean and standard deviation over the tests of "
                "the mean distance of the middle until 0.1 s after the first flight and over the whole path [mm], "
                "and of the mean angle between the rotations [degrees].",
                ("Model", "Friction", "Restitution", "Early [mm]", "Path [mm]", "Rotation [degrees]"),
                tuple(rows), "lrrrrr",
            ),
            Figure(
                "Share of the sealed tests whose error is below a value, by model.",
                svg_of(plot_errors, gain, _MODELS),
            ),
        ),
    )  # fmt: skip
