"""Section on an extended study: changes by the cause, against what was measured, and its skill on measured tests."""

import numpy as np

from blockshake.pages.blocks import Figure, Items, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.rows import bodies_by_height, face_markers
from blockshake.pages.wording import (
    MISSING,
    limited,
    millimetres,
    model_label,
    number,
    percent,
    quantile_percent,
)
from blockshake.statistics.intervals import samples_needed
from blockshake.study.ensembles.displacement_figure import plot_displacements
from blockshake.study.extension.changes import HIGH, QUANTITIES, SIDES
from blockshake.study.fragility.fragility import SAFE

_WORDS = {
    "median_drift": ("median of the drift [mm]", millimetres),
    "drift": (f"{quantile_percent(HIGH)} quantile of the drift [mm]", millimetres),
    "uplift": (f"{quantile_percent(HIGH)} quantile of the uplift [mm]", millimetres),
    "collapse": ("probability of collapse [%]", percent),
    "safe_scale": (f"safe factor of the motion, {quantile_percent(SAFE)} fail [1]", number),
}


def extension(content):
    """Changes by a cause, which are those of pairs of cases; None where no case has one more than another."""
    if content.only or not content.changes:
        return None
    pairs = content.study["extension"]["cases"]
    blocks = [
        Text(
            "Every sample was simulated twice, with the same values of all other variables: by the structure without "
            "and by that with the cause which measured tests support. Drift: largest displacement along x of any "
            "block's markers from the slab. Uplift: largest of any joint, at the middle of the face. Peaks of samples "
            "that fell are lower limits."
        ),
        Items(tuple(words for name in pairs for words in sentences(content, name))),
        _table(content, pairs),
        *(_figure(content.cases[name], content.cases[nominal]) for name, nominal in pairs.items()),
        *_transfer(content),
    ]
    return Section("Effect of the cause", "extension", tuple(blocks))


def _table(content, pairs):
    caption = (
        "Change: with the cause less without it. Limits of 95 % in brackets, by drawing the pairs of samples "
        "again; those of shares are Clopper and Pearson's, those of safe factors likelihood's. Limits of a "
        f"{quantile_percent(HIGH)} quantile hold less often than stated where fewer than {samples_needed(HIGH)} "
        "pairs bear them."
    )
    header = ("Case", "Model", "Quantity", "Without the cause", "With the cause", "Change")
    rows = tuple(row for name in pairs for row in _rows(content.changes[name], name))
    return Table(caption, header, rows, "lllrrr")


def _known(result):
    """Words of all quantities of one model that are known, how they are shown, and the entries of both."""
    for quantity in QUANTITIES:
        at = result.sel(quantity=quantity)
        if np.isfinite(at["value"]).all():
            yield *_WORDS[quantity], at


def _rows(result, name):
    for model in result["model"].values:
        for row in change_rows(result.sel(model=model)):
            yield name, model_label(model), *row


def change_rows(result):
    """Rows of the known quantities: words, without and with the cause, change, and measured if there is ``largest``."""
    for words, show, at in _known(result):
        measured = [show(at["largest"])] if "largest" in at else []
        yield words, *(limited(at.sel(side=side), "value", show) for side in SIDES), *measured


def sentences(content, name):
    """Sentences for whoever must decide, a model each."""
    result, cause = content.changes[name], content.cases[name].structure.file.extension
    for model in result["model"].values:
        yield change_sentence(f"{name}, {model_label(model)}", cause, result.sel(model=model))


def change_sentence(of, cause, result):
    """Which quantities of a model a cause changes beyond their limits, and which not."""
    changed, silent = [], []
    for words, show, at in _known(result):
        change = at.sel(side="change")
        low, high = change["value_interval"].values
        if low > 0.0 or high < 0.0:
            both = " to ".join(show(value) for value in at["value"].values[:2])
            changed.append(f"{words} from {both}, by {limited(change, 'value', show)}")
        else:
            silent.append(words.partition(" [")[0])
    return (
        f"{of}, {int(result['paired'])} pairs of samples: {cause} changes "
        f"{'; '.join(changed) or 'nothing beyond its limits'}."
        + (f" Not distinguished from no change: {', '.join(silent)}." if silent else "")
    )


def _figure(case, nominal):
    markers = face_markers(case.structure)
    bodies = bodies_by_height(case.structure, markers)[::-1]
    envelopes = {
        f"{model_label(model)}, {word} the cause": one.responses[model].envelope
        for model in case.responses
        for word, one in (("without", nominal), ("with", case))
    }
    shown = envelopes, case.measured, [markers[body] for body in bodies], bodies, "slab", case.synthetic
    measured = "" if case.measured is None else f"; dashed: {case.curve_word}"
    return Figure(
        f"{nominal.name}: displacement relative to the slab, without and with the cause{measured}. Of blocks of one "
        "height the first is drawn.",
        svg_of(plot_displacements, *shown),
    )


def _transfer(content):
    """Gain of the cause on measured tests, those that it was named by and those that it was not; none without tests."""
    rows = []
    for name, result in content.changes.items():
        case, named = content.cases[name], name in content.study["extension"]["named_by"]
        for model in result["model"].values if case.measured is not None else ():
            at = result.sel(model=model)
            known = np.isfinite(at["gain"])
            gain = limited(at, "gain", lambda share: number(share, 2)) if known else MISSING
            test = f"{case.settings['measured']['test']}, {case.curve_word}"
            scores = map(millimetres, at["score"].values)
            rows.append((name, test, "yes" if named else "no", model_label(model), *scores, gain))
    caption = (
        "Whether naming the cause predicts measured tests. Score: continuous ranked probability score of the samples "
        "against the measured curves, relative to the slab, mean over blocks and times; smaller is better. Gain: share "
        "of the error without the cause that the cause removes, 1 where nothing is left, none where the samples "
        "without the cause fit within chance or are too few. A test that the cause was named by tests no prediction."
    )
    header = ("Case", "Test", "Named by it", "Model", "Score without [mm]", "Score with [mm]", "Gain [1]")
    return [Table(caption, header, tuple(rows), "llllrrr")] if rows else []
