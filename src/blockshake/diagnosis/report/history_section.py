"""Section of a diagnosis on damage between tests: sizes by test, and whether one size is enough."""

import numpy as np

from blockshake.diagnosis.wording import history_words, shown_unit
from blockshake.pages.blocks import Figure, Items, Section, Text
from blockshake.pages.drawing import BLUE, GREY, new_figure, svg_of
from blockshake.pages.wording import sentence_case
from blockshake.pages.words import Words

_BETWEEN_TESTS = Words(__name__)


def history_section(diagnosed):
    """Sizes of what acts, of the edges and of the friction by test; None where fewer than two tests tell any."""
    paths = diagnosed.decision.histories
    if not paths:
        return None
    blocks = (
        Text(_BETWEEN_TESTS.method()),
        Items(tuple(sentence_case(history_words(path)) for path in paths)),
        Figure(_BETWEEN_TESTS.figure(), svg_of(plot_histories, paths)),
    )
    return Section("From test to test", "history", blocks)


def plot_histories(paths):
    """Figure of every `History`, a strip each."""
    figure = new_figure(0.004 + 0.026 * len(paths))
    for axes, path in zip(figure.subplots(len(paths), 1, squeeze=False)[:, 0], paths, strict=True):
        factor, unit = shown_unit(path.sizes[0].unit)
        lower, middle, upper = (
            factor * np.array([(one.lower, one.estimate, one.upper) for one in path.sizes]).T
        )
        axes.errorbar(
            range(len(path.tests)), middle, (middle - lower, upper - middle),
            color=BLUE if path.changes else GREY, marker="o", markersize=4.0, capsize=2.0,
        )  # fmt: skip
        axes.set_xticks(range(len(path.tests)), path.tests)
        axes.margins(x=0.2)
        axes.set_ylabel(f"{path.parameter} [{unit}]")
        axes.set_title(
            sentence_case(history_words(path).partition(", by test:")[0].partition(": one ")[0])[:-1]
        )
    return figure
