"""Slip, rotation and opening of the joints in one test, beside the nominal ensemble."""

import textwrap

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from blockshake.diagnosis.features.measured_readings import reading_of
from blockshake.report.diagnosis.figures.drift import darker, draw_band
from blockshake.report.document.drawing import BLACK, LIGHT_GREY, RED, SKY, new_figure

_COLUMNS = {"slip": "slip [mm]", "rotation": "rotation [mrad]", "opening": "opening [mm]"}
_MILLI = 1e3


def plot_joints(misfit, readings, test, joints, horizon, measured_word):
    """Curves of a test, one row a joint from above, one column a coordinate.

    Parameters
    ----------
    misfit, readings : xarray.Dataset
        From `misfit` and `measured_readings`.
    test : str
    joints : list of str
        From the lowest up.
    horizon : float or None
        Time from which on the test cannot be predicted [s].
    measured_word : str

    Returns
    -------
    matplotlib.figure.Figure
        Band of 5 to 95 % with median, the measured curve, in red where it is outside the band, and grey after the
        horizon.
    """
    figure = new_figure(0.018 + (0.024 if len(joints) < 4 else 0.021) * len(joints))
    panels = figure.subplots(len(joints), len(_COLUMNS), sharex=True, squeeze=False)
    own = reading_of(readings, test)
    end = float(own["time"][-1])
    for row, joint in zip(panels, reversed(joints), strict=True):
        for axes, name in zip(row, _COLUMNS, strict=True):
            measured = _MILLI * own[name].sel(joint=joint)
            quantiles = misfit[name].sel(test=test, joint=joint).sel(time=measured["time"])
            if np.isfinite(measured).any():
                _draw(axes, measured, quantiles)
            else:
                axes.text(0.5, 0.5, "not known", transform=axes.transAxes, ha="center", va="center")
            if horizon is not None and horizon < end:
                axes.axvspan(horizon, end, color=LIGHT_GREY, zorder=0, linewidth=0.0)
        row[0].set_ylabel(textwrap.fill(joint, 10))
    for axes, label in zip(panels[0], _COLUMNS.values(), strict=True):
        axes.set_title(label)
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    panels[0, 0].set_xlim(0.0, end)
    figure.align_ylabels(panels[:, 0])
    _add_legend(figure, measured_word, horizon is not None and horizon < end)
    return figure


def _draw(axes, measured, quantiles):
    draw_band(axes, quantiles, _MILLI, SKY)
    lower, upper = (_MILLI * quantiles.sel(quantile=one) for one in (0.05, 0.95))
    axes.plot(measured["time"], measured, color=BLACK, linewidth=0.6)
    axes.set_ylim(*_limits(measured.to_numpy(), lower.to_numpy(), upper.to_numpy()))
    outside = (measured < lower) | (measured > upper)
    axes.plot(measured["time"], measured.where(outside), color=RED, linewidth=0.9)


def _limits(measured, lower, upper):
    """Ends of the axis: the band and all but the hundredth part of the readings that is farthest out."""
    low = min(np.nanquantile(measured, 0.005), np.nanmin(lower))
    high = max(np.nanquantile(measured, 0.995), np.nanmax(upper))
    return low - 0.12 * (high - low), high + 0.12 * (high - low)


def _add_legend(figure, measured_word, shaded):
    entries = {
        "nominal, 5 to 95 %": Patch(facecolor=SKY, edgecolor="none", alpha=0.35),
        "median": Line2D([], [], color=darker(SKY), linewidth=0.9),
        measured_word: Line2D([], [], color=BLACK, linewidth=0.8),
        "outside the band": Line2D([], [], color=RED, linewidth=0.9),
    }
    if shaded:
        entries["not predictable any more"] = Patch(facecolor=LIGHT_GREY, edgecolor="none")
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=len(entries))
