"""Drift of the top on sealed tests, without and with the cause."""

import numpy as np

from blockshake.diagnosis.misfit.figure import add_legend, draw_history
from blockshake.pages.drawing import BLUE, ORANGE, new_figure

_COLORS = {"recalibrated": ORANGE, "extended": BLUE}
_TITLES = {"recalibrated": "without the cause, recalibrated", "extended": "with the cause"}


def plot_drift(gain, tests, kinds, measured_word):
    """Figure of the drift of the top by two models side by side, one row a sealed test."""
    figure = new_figure(0.02 + 0.034 * len(tests))
    panels = figure.subplots(len(tests), len(kinds), sharey="row", squeeze=False)
    top = gain.isel(cell=np.flatnonzero(gain["quantity"].to_numpy() == "drift")[-1])
    for row, test in zip(panels, tests, strict=True):
        own = top.sel(test=test)
        for axes, kind in zip(row, kinds, strict=True):
            draw_history(axes, own.assign(band=own["band"].sel(kind=kind)), _COLORS[kind])
        row[0].set_ylabel(f"{test}\ndrift [mm]")
    for axes, kind in zip(panels[0], kinds, strict=True):
        axes.set_title(_TITLES[kind])
    for axes in panels[-1]:
        axes.set_xlabel("time [s]")
    figure.align_ylabels(panels[:, 0])
    add_legend(figure, [_COLORS[kind] for kind in kinds], measured_word)
    return figure
