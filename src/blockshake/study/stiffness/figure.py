"""Waves in a tower, as in the paper's Fig. 9."""

import numpy as np

from blockshake.pages.drawing import BLACK, BLUE, GREEN, GREY, ORANGE, RED, new_figure
from blockshake.pages.units import MICROMETRES

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
