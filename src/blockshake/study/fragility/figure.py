"""Fragility of the cases: largest displacement and probability of a potential collapse over the intensity."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import PercentFormatter

from blockshake.pages.drawing import BLACK, BLUE, GREY, LIGHT_GREY, RED, new_figure
from blockshake.pages.wording import SHOWN_QUANTILES
from blockshake.study.fragility.fragility import SAFE

_ROW = 0.055  # m of paper


def plot_fragility(found):
    """Figure of fragilities, a row a case.

    ``found``: from `fragility`, by case. Left: quantiles of the largest displacement of the samples that climbed a
    scale, and the displacement that counts as a potential collapse, up to twice of it. Right: share that did not pass
    with its limits, and the lognormal curve with its band.
    """
    figure = new_figure(_ROW * len(found) + 0.012)
    rows = figure.subplots(len(found), 2, squeeze=False, sharex=True)
    for (left, right), (case, one) in zip(rows, found.items(), strict=True):
        _draw_peaks(left, one)
        _draw_probability(right, one)
        left.set(title=case, ylabel="displacement [mm]")
        right.set(title=case, ylabel="probability")
    for axes in rows[-1]:
        axes.set_xlabel("factor of the motion [1]")
    entries = {
        "samples, median and 5 to 95 %": Line2D([], [], color=BLUE, marker="o", markersize=3.5),
        "counts as potential collapse": Line2D([], [], color=RED, linestyle="--"),
        "share of the samples, 95 % limits": Line2D([], [], color=BLACK, marker="s", markersize=3.5),
        "lognormal, 95 % limits": Patch(facecolor=LIGHT_GREY, edgecolor=GREY),
    }
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=2)
    return figure


def _draw_peaks(axes, one):
    low, median, high = (1e3 * one["peak"].sel(quantile=q).to_numpy() for q in SHOWN_QUANTILES)
    scale = one["scale"].to_numpy()
    axes.vlines(scale, low, high, color=BLUE, linewidth=1.2)
    axes.plot(scale, median, color=BLUE, marker="o", markersize=3.5, linewidth=0.6)
    axes.axhline(1e3 * one.attrs["largest_drift"], color=RED, linestyle="--", linewidth=0.8)
    axes.set_ylim(0.0, 2e3 * one.attrs["largest_drift"])


def _draw_probability(axes, one):
    fine = one["fine_scale"].to_numpy()
    if np.isfinite(one["curve"]).all():
        limits = (one["curve_interval"].sel(bound=side).to_numpy() for side in ("lower", "upper"))
        axes.fill_between(fine, *limits, color=LIGHT_GREY, linewidth=0.0)
        axes.plot(fine, one["curve"], color=GREY)
    share = one["share"].to_numpy()
    low, high = (one["share_interval"].sel(bound=side).to_numpy() for side in ("lower", "upper"))
    axes.vlines(one["scale"], low, high, color=BLACK, linewidth=0.8)
    axes.plot(one["scale"], share, color=BLACK, linestyle="none", marker="s", markersize=3.5)
    axes.axhline(SAFE, color=GREY, linestyle=":", linewidth=0.8)
    axes.set_ylim(-0.03, 1.03)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
