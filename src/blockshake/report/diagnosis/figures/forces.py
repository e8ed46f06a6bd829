"""Levers of the joints and the least unexplained force of the blocks, in all tests."""

import numpy as np

from blockshake.report.document.drawing import BLACK, BLUE, DARK_GREY, GREEN, ORANGE, PURPLE, RED, new_figure

_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, BLACK)
_BEYOND = 1.6  # half widths, at the ends of the axis
_KILO = 1e-3


def plot_levers(forces, joint):
    """Figure of the lever of one joint in every test of `measured_forces`, with the edges of its face."""
    tests = [str(name) for name in forces["test"].values]
    figure = new_figure(0.012 + 0.026 * len(tests))
    panels = figure.subplots(len(tests), 1, sharex=True, squeeze=False)[:, 0]
    half = float(forces["half_width"].sel(joint=joint).max())
    for axes, test in zip(panels, tests, strict=True):
        one = forces.sel(test=test, joint=joint)
        axes.plot(one["time"], 1e3 * one["lever"], color=BLACK, linewidth=0.6)
        beyond = one["lever"].where(np.abs(one["lever"]) > half + 3.0 * one["lever_error"])
        axes.plot(one["time"], 1e3 * beyond, color=RED, linewidth=0.9)
        for edge in (-half, half):
            axes.axhline(1e3 * edge, color=DARK_GREY, linewidth=0.6, linestyle=(0, (4, 2)))
        axes.set_ylim(-1e3 * _BEYOND * half, 1e3 * _BEYOND * half)
        axes.set_ylabel(f"{test}\nlever [mm]")
    panels[-1].set_xlabel("time [s]")
    figure.align_ylabels(panels)
    return figure


def plot_unexplained(forces):
    """Figure of the least unexplained force of every block in every test of `measured_forces`."""
    tests = [str(name) for name in forces["test"].values]
    figure = new_figure(0.016 + 0.026 * len(tests))
    panels = figure.subplots(len(tests), 1, sharex=True, squeeze=False)[:, 0]
    for axes, test in zip(panels, tests, strict=True):
        for body, colour in zip(
            forces["body"].values, np.resize(_COLOURS, forces.sizes["body"]), strict=True
        ):
            one = forces["unexplained"].sel(test=test, body=body)
            axes.plot(one["time"], _KILO * one, color=str(colour), linewidth=0.7, label=str(body))
        axes.set_ylabel(f"{test}\nforce [kN]")
    panels[-1].set_xlabel("time [s]")
    figure.align_ylabels(panels)
    figure.legend(
        *panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=forces.sizes["body"]
    )
    return figure
