"""Waves in a tower and the stiffness found from them: the paper's Figs. 9 and 10."""

import numpy as np

from blockshake.pages.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, RED, new_figure
from blockshake.pages.units import MICROMETRES, printed
from blockshake.pages.wording import parameter_label
from blockshake.study.sampling.distributions import parameter_unit
from blockshake.study.sampling.figure import bin_count

_LINES = (BLUE, GREEN, ORANGE, RED, BLACK, GREY)
_STEP = {"normal": "vertical step: normal stiffness", "shear": "horizontal step: shear stiffness"}


def plot_waves(waves):
    """Figure of the displacement of a tower's blocks after a step of velocity, with the arrivals, from `wave_tests`."""
    figure = new_figure(0.075)
    panels = figure.subplots(1, waves.sizes["direction"], squeeze=False)[0]
    for axes, direction in zip(panels, waves["direction"].values, strict=True):
        test = waves.sel(direction=direction).dropna("time", how="all", subset=["displacement"])
        for block, color in zip(waves["block"].values, _LINES, strict=False):
            one = test.sel(block=block)
            history, arrival = MICROMETRES.factor * one["displacement"], float(one["arrival"])
            axes.plot(1e3 * one["time"], history, color=color, label=str(block))
            axes.plot(
                1e3 * arrival, np.interp(arrival, one["time"], history), "o", color=color, markersize=3.5
            )
        axes.set(title=_STEP[str(direction)], xlabel="time [ms]", xlim=(0.0, 1e3 * float(test["time"][-1])))
    panels[0].set_ylabel(f"displacement [{MICROMETRES.name}]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(handles))
    return figure


def plot_stiffness(stiffness):
    """Figure of histograms of the calibrated stiffness over the samples [N/m3]: the paper's Fig. 10.

    Columns ``ls_dem.normal_stiffness`` and ``ls_dem.shear_stiffness``.
    """
    figure = new_figure(0.055)
    panels = figure.subplots(1, 2, sharey=True)
    for axes, (name, color) in zip(
        panels, (("ls_dem.normal_stiffness", BLUE), ("ls_dem.shear_stiffness", RED)), strict=True
    ):
        factor, unit = printed(parameter_unit(name))
        axes.hist(
            factor * stiffness[name], bins=bin_count(len(stiffness)), color=color, alpha=0.6,
            edgecolor="black", linewidth=0.5,
        )  # fmt: skip
        axes.set(xlabel=f"{parameter_label(name)} [{unit}]")
        axes.grid(False, axis="x")
        axes.yaxis.get_major_locator().set_params(integer=True)
    panels[0].set_ylabel("samples")
    return figure
