"""Figures of outcomes: which motions the body survived, and how often it fell against what was predicted."""

import numpy as np
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from blockshake.pages.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, new_figure

COLORS = {"nominal": GREY, "recalibrated": ORANGE, "extended": BLUE, "curve": GREEN}
_BINS = 6
_G = 9.80665  # m/s2


def plot_survival(scores):
    """Every test by its motion's peaks: fell or stood, and by colour the chance of a fall that the model gives."""
    figure = new_figure(0.08)
    panel = figure.subplots()
    pga, ratio = scores["pga"].to_numpy() / _G, (scores["pgv"] / scores["pga"]).to_numpy()
    fell, chance = scores["fell"].to_numpy() == 1, scores["chance"].sel(model="extended").to_numpy()
    for marker, own, label in (("o", fell, "fell"), ("v", ~fell, "stood")):
        points = panel.scatter(
            pga[own],
            ratio[own],
            c=chance[own],
            marker=marker,
            s=14,
            vmin=0.0,
            vmax=1.0,
            cmap="coolwarm",
            edgecolors=BLACK,
            linewidths=0.3,
            label=label,
        )
    panel.set_xscale("log")
    panel.set_yscale("log")
    _plain_ticks(panel.xaxis)
    _plain_ticks(panel.yaxis)
    panel.set_xlabel("peak acceleration [g]")
    panel.set_ylabel("peak velocity over peak acceleration [s]")
    panel.legend(loc="upper right")
    figure.colorbar(points, ax=panel, label="predicted chance of a fall")
    return figure


def plot_fragility(scores):
    """Share of the tests in which the body fell, over each of the motion's peaks, measured and by every model."""
    figure = new_figure(0.07)
    pga = scores["pga"].to_numpy() / _G
    panels = figure.subplots(1, 2, sharey=True)
    for panel, values, label in zip(
        panels,
        (pga, (scores["pgv"] / scores["pga"]).to_numpy()),
        ("peak acceleration [g]", "peak velocity over peak acceleration [s]"),
        strict=True,
    ):
        bins = np.array_split(np.argsort(values), min(_BINS, max(len(values) // 8, 1)))
        middle = [np.median(values[one]) for one in bins]
        fell = scores["fell"].to_numpy()
        panel.plot(
            middle, [fell[one].mean() for one in bins], "o--", color=BLACK, markersize=4.0, label="measured"
        )
        for model, color in COLORS.items():
            chance = scores["chance"].sel(model=model).to_numpy()
            panel.plot(middle, [chance[one].mean() for one in bins], color=color, label=model)
        panel.set_xscale("log")
        _plain_ticks(panel.xaxis)
        panel.set_xlabel(label)
    panels[0].set_ylabel("share of tests with a fall")
    panels[0].legend(loc="upper left")
    return figure


def _plain_ticks(axis):
    """Ticks at 1, 2 and 5 of every decade of a logarithmic axis, without powers."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.set_minor_locator(NullLocator())
