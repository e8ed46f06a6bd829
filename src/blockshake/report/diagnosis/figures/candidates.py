"""How much better than the nominal model each candidate explains the tests."""

import numpy as np

from blockshake.report.document.drawing import (
    BLACK,
    BLUE,
    DARK_GREY,
    GREEN,
    LIGHT_GREY,
    ORANGE,
    RED,
    new_figure,
)
from blockshake.report.document.wording import model_label

_LINEAR = 10.0  # below which the scale is linear
_MARGIN = 1.25  # markers lie within the frame
_TICKS = (-10000, -1000, -100, -20, -10, -5, 0, 5, 10, 20, 50, 100, 200, 500, 1000, 10000, 100000)
_COLORS = (BLUE, ORANGE, GREEN)
_MARKERS = ("s", "D", "^")


def plot_candidates(rows, labels, causes, placebo):
    """Figure of the log ratio of each effect at its best place, a `CandidateScore`, the strongest on top.

    ``causes``: effects that are not excluded, their rows shaded; ``placebo``: largest log ratio of a candidate that
    means nothing, a line as the nominal model. Both solvers taken together and each by itself.
    """
    figure = new_figure(0.022 + 0.0055 * len(rows))
    axes = figure.subplots()
    places = np.arange(len(rows))[::-1]
    for place, row in zip(places, rows, strict=True):
        if row.effect in causes:
            axes.axhspan(place - 0.5, place + 0.5, color=LIGHT_GREY, zorder=0, linewidth=0.0)
        values = [*row.by_model.values(), row.log_ratio]
        axes.plot([min(values), max(values)], [place, place], color=DARK_GREY, linewidth=0.6)
    for model, color, marker in zip(rows[0].by_model, _COLORS, _MARKERS, strict=False):
        axes.plot(
            [row.by_model[model] for row in rows], places, marker, color=color, markersize=4.5,
            label=f"{model_label(model)} alone",
        )  # fmt: skip
    axes.plot([row.log_ratio for row in rows], places, "o", color=BLACK, markersize=2.8, label="both solvers")
    axes.axvline(0.0, color=BLACK, linewidth=0.8, label="nominal model")
    axes.axvline(placebo, color=RED, linestyle="--", label="best of the placebos")
    axes.set_xscale("symlog", linthresh=_LINEAR)
    low, high = (_MARGIN * end for end in axes.get_xlim())
    axes.set_xlim(low, high)
    ticks = [tick for tick in _TICKS if low <= tick <= high]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    axes.set_yticks(places, labels)
    axes.set_ylim(-0.6, len(rows) - 0.4)
    axes.set_xlabel(f"log ratio to the nominal model [1], linear within {_LINEAR:.0f}, logarithmic beyond")
    handles, names = axes.get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper center", ncols=len(names))
    return figure
