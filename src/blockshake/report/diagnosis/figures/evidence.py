"""The features that decided, and the size that each test finds by itself."""

import numpy as np

from blockshake.report.document.drawing import BLACK, BLUE, LIGHT_GREY, ORANGE, SKY, new_figure

_BAND = 2.0  # standard deviations


def plot_features(rows, labels, extended_word):
    """Figure of the residuals of features with the nominal model and with the candidate.

    ``rows`` of `deciding_features`; ``extended_word``: what the model with the candidate is called.
    """
    count = rows.sizes["row"]
    figure = new_figure(0.021 + 0.0058 * count)
    axes = figure.subplots()
    places = np.arange(count)[::-1]
    axes.axvspan(-_BAND, _BAND, color=LIGHT_GREY, linewidth=0.0, label="within 2 standard deviations")
    axes.axvline(0.0, color=BLACK, linewidth=0.6)
    for place, nominal, extended in zip(places, rows["nominal"], rows["extended"], strict=True):
        axes.annotate(
            "", (float(extended), place), (float(nominal), place),
            arrowprops={"arrowstyle": "-|>", "linewidth": 0.7, "shrinkA": 3.0, "shrinkB": 3.0, "mutation_scale": 6.0},
        )  # fmt: skip
    axes.plot(rows["nominal"], places, "o", color=ORANGE, markersize=4.5, label="nominal model")
    axes.plot(rows["extended"], places, "s", color=BLUE, markersize=4.5, label=extended_word)
    axes.set_yticks(places, labels)
    axes.set_ylim(-0.6, count - 0.4)
    axes.set_xlabel("measured less predicted [standard deviations of the prediction]")
    handles, names = axes.get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper center", ncols=len(names))
    return figure


def plot_constancy(panels):
    """Figure of the size of a candidate by each test, and by all of them.

    Parameters
    ----------
    panels : list of dict
        One a candidate: ``title``, ``axis`` (label of the size), ``tests``, ``estimate``, ``lower`` and ``upper`` by
        test, ``all``, the three of all tests together, or None, and ``ends`` of the prior.
    """
    count = max(len(panel["tests"]) for panel in panels)
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    figure = new_figure((0.022 + 0.008 * count) * rows)
    shown = figure.subplots(rows, columns, squeeze=False).flat
    for axes in shown[len(panels) :]:
        axes.set_axis_off()
    for axes, panel in zip(shown, panels, strict=False):
        places = np.arange(len(panel["tests"]))[::-1]
        estimate, lower, upper = (np.array(panel[name]) for name in ("estimate", "lower", "upper"))
        if panel["all"]:
            middle, low, high = panel["all"]
            axes.axvspan(low, high, color=SKY, alpha=0.35, linewidth=0.0)
            axes.axvline(middle, color=BLUE, linewidth=1.0)
        axes.errorbar(
            estimate, places, xerr=[estimate - lower, upper - estimate], fmt="o", color=BLACK, markersize=4.0,
            elinewidth=0.9, capsize=2.5,
        )  # fmt: skip
        axes.set_yticks(places, panel["tests"])
        axes.set_ylim(-0.8, len(places) - 0.2)
        axes.set_xlim(*_widened(panel["ends"]))
        axes.set(title=panel["title"], xlabel=panel["axis"])
    return figure


def _widened(ends):
    low, high = sorted(ends)
    return low - 0.04 * (high - low), high + 0.04 * (high - low)
