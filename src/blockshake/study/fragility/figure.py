"""Fragility of the cases: largest displacement and probability of a potential collapse over the intensity."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import PercentFormatter

from blockshake.pages.drawing import BLACK, BLUE, GREY, LIGHT_GREY, RED, new_figure
from blockshake.pages.wording import SHOWN_QUANTILES, SQUARED
from blockshake.statistics.intervals import share_interval
from blockshake.study.fragility.fragility import SAFE

_ROW = 0.055  # m of paper


def plot_fragility(results):
    """Figure of fragilities, a row a case.

    ``results``: from `fragility`, by case. Left: quantiles of the largest displacement of the samples that climbed a
    scale, over the limit of its block, up to twice of it. Right: share that did not pass
    with its limits, and the lognormal curve with its band.
    """
    figure = new_figure(_ROW * len(results) + 0.012)
    rows = figure.subplots(len(results), 2, squeeze=False, sharex=True)
    for (left, right), (case, result) in zip(rows, results.items(), strict=True):
        _draw_peaks(left, result)
        _draw_probability(right, result)
        left.set(title=case, ylabel="displacement / limit [1]")
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


def _draw_peaks(axes, result):
    low, median, high = (result["drift_ratio"].sel(quantile=q).to_numpy() for q in SHOWN_QUANTILES)
    scale = result["scale"].to_numpy()
    axes.vlines(scale, low, high, color=BLUE, linewidth=1.2)
    axes.plot(scale, median, color=BLUE, marker="o", markersize=3.5, linewidth=0.6)
    axes.axhline(1.0, color=RED, linestyle="--", linewidth=0.8)
    axes.set_ylim(0.0, 2.0)


def _draw_probability(axes, result):
    fine = result["fine_scale"].to_numpy()
    if np.isfinite(result["curve"]).all():
        limits = (result["curve_interval"].sel(bound=side).to_numpy() for side in ("lower", "upper"))
        axes.fill_between(fine, *limits, color=LIGHT_GREY, linewidth=0.0)
        axes.plot(fine, result["curve"], color=GREY)
    share = result["share"].to_numpy()
    low, high = (result["share_interval"].sel(bound=side).to_numpy() for side in ("lower", "upper"))
    axes.vlines(result["scale"], low, high, color=BLACK, linewidth=0.8)
    axes.plot(result["scale"], share, color=BLACK, linestyle="none", marker="s", markersize=3.5)
    axes.axhline(SAFE, color=GREY, linestyle=":", linewidth=0.8)
    axes.set_ylim(-0.03, 1.03)
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))


def measure_words(cloud):
    """Name and unit of the measure of intensity of a cloud, such as ``Sa(0.5 s)`` and ``m/s2``."""
    name = {"pga": "PGA", "pgv": "PGV", "sa": f"Sa({cloud.attrs['period']:g} s)"}[cloud.attrs["measure"]]
    return name, "m/s" if cloud.attrs["measure"] == "pgv" else f"m/s{SQUARED}"


def failed(cloud):
    """Which samples of a cloud did not pass, bool array."""
    return ((cloud["fell"] == 1) | (cloud["demand"] > cloud["largest_drift"])).to_numpy()


def plot_clouds(clouds):
    """Figure of the samples of each case by a model over the intensity of their motions, a row each, and fragilities.

    ``clouds``: from `cloud_of_case`, by title.
    """
    figure = new_figure(_ROW * len(clouds) + 0.012)
    rows = figure.subplots(len(clouds), 2, squeeze=False)
    colours = {"regression": BLUE, "counts": RED}
    for (left, right), (title, cloud) in zip(rows, clouds.items(), strict=True):
        fine = cloud["fine_intensity"]
        stands = cloud["fell"].to_numpy() == 0
        at, demand = cloud["intensity"].to_numpy(), (cloud["demand"] / cloud["largest_drift"]).to_numpy()
        left.plot(at[stands], demand[stands], color=BLACK, linestyle="none", marker="o", markersize=3.0)
        left.plot(fine, np.exp(cloud.attrs["intercept"]) * fine ** cloud.attrs["slope"], color=BLUE)
        top = 2.0 * max(1.0, *demand[stands]) if stands.any() else 2.0
        left.plot(at[~stands], np.full((~stands).sum(), top), color=RED, linestyle="none", marker="x")
        left.axhline(1.0, color=RED, linestyle="--", linewidth=0.8)
        left.set(title=title, xscale="log", yscale="log", ylabel="displacement / limit [1]")
        left.xaxis.set_major_formatter("{x:g}")
        left.xaxis.set_minor_formatter("{x:g}")
        for method, colour in colours.items():
            one = cloud.sel(fit=method)
            limits = (one["curve_interval"].sel(bound=side) for side in ("lower", "upper"))
            right.fill_between(fine, *limits, color=colour, alpha=0.2, linewidth=0.0)
            right.plot(fine, one["curve"], color=colour)
        for level in np.unique(at) if cloud.attrs["levels"] else ():
            here = failed(cloud)[at == level]
            counts = cloud.attrs["weight"] * np.array([here.sum(), len(here)])
            right.vlines(
                level,
                *share_interval(*counts),
                color=BLACK,
                linewidth=0.8,
            )
            right.plot(level, here.mean(), color=BLACK, marker="s", markersize=3.5)
        right.axhline(SAFE, color=GREY, linestyle=":", linewidth=0.8)
        right.set(title=title, ylabel="probability", ylim=(-0.03, 1.03))
        right.yaxis.set_major_formatter(PercentFormatter(1.0))
        for axes in (left, right):
            axes.set_xlabel("{} [{}]".format(*measure_words(cloud)))
    entries = {
        "samples": Line2D([], [], color=BLACK, linestyle="none", marker="o", markersize=3.0),
        "counts as potential collapse": Line2D([], [], color=RED, linestyle="--"),
        "cloud (regression)": Line2D([], [], color=BLUE),
        "counts (maximum likelihood)": Line2D([], [], color=RED),
    }
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=2)
    return figure
