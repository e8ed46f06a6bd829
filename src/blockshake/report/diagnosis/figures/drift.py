"""Displacement of the top block against the table: before and after the extension, beside the test."""

import numpy as np
from matplotlib.legend_handler import HandlerTuple
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from blockshake.report.document.drawing import BLACK, BLUE, ORANGE, SKY, new_figure

_MEASURED = {"color": BLACK, "linestyle": (0, (4, 2)), "linewidth": 0.9}
_COLORS = {"nominal": SKY, "recalibrated": ORANGE, "extended": BLUE}
_MOST_POINTS = 600  # in print half a point apart


def plot_extended_drift(consequences, tests, body, measured_word):
    """Figure of the recalibrated and the extended model of `campaign_gain` side by side, one row a sealed test.

    Band of 5 to 95 %, median and measured curve [mm] in each panel.
    """
    kinds = ("recalibrated", "extended")
    figure = new_figure(0.02 + 0.032 * len(tests))
    panels = figure.subplots(len(tests), len(kinds), sharey="row", squeeze=False)
    for row, test in zip(panels, tests, strict=True):
        own = consequences.sel(test=test, body=body)
        measured = own["drift_measured"].dropna("time")
        for axes, kind in zip(row, kinds, strict=True):
            draw_band(axes, own["drift_history"].sel(kind=kind, time=measured["time"]), 1e3, _COLORS[kind])
            axes.plot(measured["time"], 1e3 * measured, **_MEASURED)
            axes.set_xlim(0.0, float(measured["time"][-1]))
        row[0].set_ylabel(f"{test}\ndisplacement [mm]")
    for axes, kind in zip(panels[0], kinds, strict=True):
        axes.set_title(f"{kind} model")
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    figure.align_ylabels(panels[:, 0])
    _add_legend(figure, [_COLORS[kind] for kind in kinds], measured_word)
    return figure


def plot_nominal_drift(misfit, readings, tests, body, measured_word):
    """Figure of the nominal model of `misfit` and of `measured_readings`, one row a test; see `plot_extended_drift`."""
    figure = new_figure(0.02 + 0.034 * len(tests))
    panels = figure.subplots(len(tests), 1, squeeze=False)[:, 0]
    for axes, test in zip(panels, tests, strict=True):
        measured = readings["drift"].sel(test=test, body=body).dropna("time")
        band = misfit["drift"].sel(test=test, body=body, time=measured["time"])
        draw_band(axes, band, 1e3, _COLORS["nominal"])
        axes.plot(measured["time"], 1e3 * measured, **_MEASURED)
        axes.set_xlim(0.0, float(measured["time"][-1]))
        axes.set_ylabel(f"{test}\ndisplacement [mm]")
    panels[-1].set_xlabel("time [s]")
    figure.align_ylabels(panels)
    _add_legend(figure, [_COLORS["nominal"]], measured_word)
    return figure


def draw_band(axes, quantiles, factor, color):
    """Band of 5 to 95 % with the median, from quantiles along ``time``, times a factor."""
    stride = max(1, quantiles.sizes["time"] // _MOST_POINTS)
    thinned = factor * quantiles.isel(time=slice(None, None, stride))
    low, middle, high = (thinned.sel(quantile=one) for one in (0.05, 0.5, 0.95))
    axes.fill_between(thinned["time"], low, high, color=color, alpha=0.35, linewidth=0.0)
    axes.plot(thinned["time"], middle, color=darker(color), linewidth=0.7)


def darker(color):
    """The colour of a median in a band of a colour."""
    rgb = [int(color[place : place + 2], 16) / 255.0 for place in (1, 3, 5)]
    return tuple(0.75 * np.array(rgb))


def _add_legend(figure, colors, measured_word):
    patches = tuple(Patch(facecolor=color, edgecolor="none", alpha=0.35) for color in colors)
    lines = tuple(Line2D([], [], color=darker(color), linewidth=0.9) for color in colors)
    entries = [(patches, "5 to 95 %"), (lines, "median"), (Line2D([], [], **_MEASURED), measured_word)]
    figure.legend(
        [handle for handle, _ in entries], [label for _, label in entries],
        handler_map={tuple: HandlerTuple(ndivide=None)}, loc="outside upper center", ncols=len(entries),
    )  # fmt: skip
