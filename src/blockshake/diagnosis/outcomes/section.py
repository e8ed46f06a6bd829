"""The report on outcomes, and its sections."""

from itertools import pairwise

import numpy as np

from blockshake.diagnosis.outcomes.decide import CAUSES
from blockshake.diagnosis.outcomes.figure import plot_fragility, plot_survival
from blockshake.diagnosis.verdict.found import cause_words, document, load_found, odds_section
from blockshake.diagnosis.wording import percent_words
from blockshake.effects.registry import title_of
from blockshake.geometry.structure import load_structure
from blockshake.pages.blocks import Box, Figure, Items, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import MISSING, count_words, number, sentence_case
from blockshake.statistics.intervals import share_interval

MODELS_IN_WORDS = {
    "nominal": "undamaged models, before any outcome was known",
    "recalibrated": "undamaged models, weighted by the open outcomes",
    "extended": "models with the causes, weighted by the open outcomes",
    "curve": "logistic curve over peak acceleration and velocity, fitted to the open outcomes",
}
_CLASSES = (0.0, 0.1, 0.3, 0.7, 0.9, 1.0)  # of the predicted chance, for the reliability


def compose_outcomes(campaign, results, effort, track_record):
    """`Document` of the diagnosis of a campaign of outcomes, from the folder of its results; it has no track record."""
    found = load_found(results)
    tests = count_words(len(campaign.tests), "test")
    subtitle = f"{load_structure(campaign.structure).file.name}, {tests} that it survived or not"
    sections = [section(found) for section in (answer_section, scores_section, gain_section)]
    titles = {cause: title_of(cause) for cause in CAUSES}
    sections.append(odds_section(found.decision, titles, "outcomes"))
    return document(campaign, effort, found, subtitle, sections)


def answer_section(found):
    """The answer, the size of its causes, and what the outcomes do not show."""
    causes = [part.causes[0] for part in found.decision.parts]
    words = found.verdict.word
    if causes:
        words += ": " + "; with it ".join(cause_words(cause, title_of(cause.name)) for cause in causes)
    scores = found.evidence if found.gain is None else found.gain
    which = "open tests, which were fitted to" if found.gain is None else "sealed tests"
    chance, fell = scores["chance"].sel(model="extended").to_numpy(), scores["fell"].to_numpy() == 1
    facts = (
        ("Tests predicted as they ended", f"{100.0 * ((chance > 0.5) == fell).mean():.0f} %", which),
        (
            "Balanced accuracy",
            f"{balanced_accuracy(chance, fell):.2f}",
            "mean of the shares of falls and of stands",
        ),
        ("Brier score", f"{np.mean((chance - fell) ** 2):.3f}", "0 is perfect, 0.25 knows nothing"),
    )
    return Section(
        "Answer",
        "answer",
        (
            Box(sentence_case(words), facts),
            Items(tuple(map(sentence_case, found.verdict.caveats))),
            Figure(
                f"Every one of the {which.split(',')[0]} by the peaks of its motion; the colour is the predicted "
                "chance of a fall.",
                svg_of(plot_survival, scores),
            ),
        ),
    )


def balanced_accuracy(chance, fell):
    """Mean of the shares of falls and of stands that were predicted; NaN without either."""
    right = (chance > 0.5) == fell
    return 0.5 * (right[fell].mean() + right[~fell].mean()) if fell.any() and not fell.all() else np.nan


def scores_section(found):
    """Predicted and measured outcomes by model: confusion, scores, reliability, fragility."""
    blocks = []
    for scores, which in ((found.gain, "sealed"), (found.evidence, "open")):
        if scores is None:
            continue
        fell = scores["fell"].to_numpy() == 1
        rows = [
            _score_row(words, scores["chance"].sel(model=model).to_numpy(), fell)
            for model, words in MODELS_IN_WORDS.items()
        ]
        rows += [
            _score_row(
                f"the structure file's model, {solver}",
                scores["simulated"].sel(solver=solver).to_numpy(),
                fell,
            )
            for solver in scores["solver"].to_numpy()
        ]
        blocks.append(
            Table(
                f"The {len(fell)} {which} tests, in {fell.sum()} of which the body fell: falls predicted and seen, "
                "predicted and not seen, seen and not predicted; balanced accuracy; Brier score.",
                ("Model", "Right falls", "False falls", "Missed falls", "Balanced accuracy", "Brier score"),
                tuple(rows),
                "lrrrrr",
            )
        )
    scores = found.evidence if found.gain is None else found.gain
    which = "open" if found.gain is None else "sealed"
    blocks.append(
        Table(
            f"Reliability on the {which} tests: share of falls among tests of like predicted chance, by the models "
            "with the causes, with its interval of 95 %.",
            ("Predicted chance", "Tests", "Falls", "Share"),
            tuple(reliability(scores)),
            "lrrr",
        )
    )
    blocks.append(
        Figure(
            f"Share of the {which} tests with a fall, in bins of equal numbers of tests.",
            svg_of(plot_fragility, scores),
        )
    )
    return Section("Predicted and measured", "scores", tuple(blocks))


def _score_row(words, chance, fell):
    called = chance > 0.5
    return (
        words,
        str((called & fell).sum()),
        str((called & ~fell).sum()),
        str((~called & fell).sum()),
        number(balanced_accuracy(chance, fell)),
        f"{np.mean((chance - fell) ** 2):.3f}",
    )


def reliability(scores):
    """Rows of texts by class of predicted chance: tests, falls, and their share with its interval of 95 %."""
    chance, fell = scores["chance"].sel(model="extended").to_numpy(), scores["fell"].to_numpy() == 1
    for low, high in pairwise(_CLASSES):
        own = (chance >= low) & ((chance < high) | (high == 1.0))
        count, falls = int(own.sum()), int(fell[own].sum())
        share = MISSING
        if count:
            lower, upper = share_interval(falls, count)
            share = f"{falls / count:.2f} ({lower:.2f} to {upper:.2f})"
        yield f"{low:g} to {high:g}", str(count), str(falls), share


def gain_section(found):
    """Gain on the sealed tests; None where none was measured."""
    gain = found.verdict.gain
    if gain is None:
        return None
    against = {
        "undamaged models, before any outcome was known": gain.nominal,
        "undamaged models, weighted by the open outcomes": gain.recalibrated,
        "a logistic curve, fitted to the open outcomes": gain.discrepancy,
    }
    return Section(
        "Gain on sealed tests",
        "gain",
        (
            Text(
                "Gain: the share of a rival's Brier score on the sealed tests that the models with the causes remove. "
                "Nothing was fitted to a sealed outcome."
            ),
            Table(
                "Gain with its interval of 90 %, tests drawn again.",
                ("Alternative", "Gain"),
                tuple((words, percent_words(one)) for words, one in against.items()),
                "lr",
            ),
        ),
    )
