"""Histories of tests against the ensembles that predict them, as long as they can be predicted."""

import numpy as np
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from blockshake.pages.drawing import LIGHT_GREY, MEASURED, SKY, new_figure
from blockshake.pages.units import printed

_COLUMNS = 2


def plot_misfit(misfit, chosen, measured_word):
    """Figure of histories of the nominal ensemble; ``chosen`` are places of test and cell."""
    rows = -(-len(chosen) // _COLUMNS)
    figure = new_figure(0.014 + 0.038 * rows)
    figure.get_layout_engine().set(wspace=0.04)
    panels = figure.subplots(rows, _COLUMNS, squeeze=False)
    for axes in panels.flat[len(chosen) :]:
        axes.set_axis_off()
    for axes, (test, cell) in zip(panels.flat, chosen, strict=False):
        history = misfit.isel(test=test, cell=cell)
        draw_history(axes, history, SKY)
        axes.set_title(f"{history['test'].item()}, {history['where'].item()}")
        axes.set_ylabel(f"{history['quantity'].item()} [{printed(str(history['unit'].item())).name}]")
    for axes in panels.flat[max(len(chosen) - _COLUMNS, 0) : len(chosen)]:
        axes.set_xlabel("time [s]")
    add_legend(figure, [SKY], measured_word)
    return figure


def draw_history(axes, history, color):
    """Band and median of one history, its measured curve, and shade beyond its horizon."""
    history = history.dropna("time", subset=["measured"])
    factor, time, end = (
        printed(str(history["unit"].item())).factor,
        history["time"].to_numpy(),
        float(history["horizon"]),
    )
    low, middle, high = (factor * history["band"].sel(quantile=quantile) for quantile in (0.05, 0.5, 0.95))
    axes.fill_between(time, low, high, color=color, alpha=0.35, linewidth=0.0)
    axes.plot(time, middle, color=darker(color), linewidth=0.7)
    axes.plot(time, factor * history["measured"], **MEASURED)
    if end < time[-1]:
        axes.axvspan(max(end, time[0]), time[-1], color=LIGHT_GREY, alpha=0.45, linewidth=0.0, zorder=0)
    axes.set_xlim(time[0], time[-1])


def darker(color):
    """The colour of a median in a band of a colour."""
    rgb = [int(color[start : start + 2], 16) / 255.0 for start in (1, 3, 5)]
    return tuple(0.75 * np.array(rgb))


def add_legend(figure, colors, measured_word):
    """Legend of bands in these colours, of their medians and of the measured curve."""
    patches = tuple(Patch(facecolor=color, edgecolor="none", alpha=0.35) for color in colors)
    lines = tuple(Line2D([], [], color=darker(color), linewidth=0.9) for color in colors)
    entries = [(patches, "5 to 95 %"), (lines, "median"), (Line2D([], [], **MEASURED), measured_word)]
    figure.legend(
        [handle for handle, _ in entries], [label for _, label in entries],
        handler_map={tuple: HandlerTuple(ndivide=None)}, loc="outside upper center", ncols=len(entries),
    )  # fmt: skip
