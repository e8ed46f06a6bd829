"""Histories of what the joints transmit and take, and of the least unexplained force, in all tests."""

import numpy as np

from blockshake.diagnosis.laws.law_table import kind_of
from blockshake.diagnosis.laws.measured_forces import forces_of
from blockshake.report.document.drawing import (
    BLACK,
    BLUE,
    DARK_GREY,
    GREEN,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    new_figure,
)

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, SKY)
_LEAST_BEYOND, _MOST_BEYOND = 1.6, 4.0  # half widths, at the ends of an axis of levers
_MARGIN = 1.08
KILO = 1e-3
_APART = 0.02  # of a test's length, between the joints' draws beyond its end
_SPREADS = 2.0  # standard deviations of the draws, to either side
DASHED = {"color": DARK_GREY, "linewidth": 0.6, "linestyle": (0, (4, 2))}


def coloured(names):
    """Pairs of a name and its colour, the same in every figure."""
    return list(zip([str(name) for name in names], np.resize(COLOURS, len(names)).tolist(), strict=True))


def beyond_the_face(one):
    """Levers of a joint in a test that lie beyond an edge by more than three standard deviations, NaN elsewhere."""
    half = float(one["half_width"])
    return one["lever"].where(np.abs(one["lever"]) > half + 3.0 * one["lever_error"])


def plot_levers(forces, joint):
    """Figure of the lever of one joint in every test of `measured_forces`, with the edges of its face."""
    figure, panels = _rows(forces, 0.012)
    for axes, test in zip(panels, forces["test"].values, strict=True):
        one = forces_of(forces, test).sel(joint=joint)
        half, beyond = float(one["half_width"]), beyond_the_face(one)
        axes.plot(one["time"], 1e3 * one["lever"], color=BLACK, linewidth=0.6)
        axes.plot(one["time"], 1e3 * beyond, color=RED, linewidth=0.9)
        for edge in (-half, half):
            axes.axhline(1e3 * edge, **DASHED)
        farthest = _MARGIN * float(np.abs(beyond).max()) if beyond.notnull().any() else 0.0
        end = 1e3 * np.clip(farthest, _LEAST_BEYOND * half, _MOST_BEYOND * half)
        axes.set_ylim(-end, end)
        axes.set_ylabel(f"{test}\nlever [mm]")
    return _finished(figure, panels)


def plot_work(forces, shown):
    """Figure of the energy that every joint takes out of the motion in every test of `measured_forces`.

    Dashed: all joints together. Beyond the end of a test: mean of the nominal draws and two standard deviations, of
    ``shown`` (sequence of LawFinding).
    """
    figure, panels = _rows(forces, 0.016, 0.03)
    of_draws = {one.joint: one for one in shown if kind_of(one.name) == "work.taken"}
    end, length = float(forces["time"].max()), float(np.ptp(forces["time"].to_numpy()))
    for axes, test in zip(panels, forces["test"].values, strict=True):
        for place, (joint, colour) in enumerate(coloured(forces["joint"].values), start=1):
            one = forces_of(forces, test)["work"].sel(joint=joint)
            axes.plot(one["time"], KILO * one, color=colour, linewidth=0.8, label=joint)
            draws = of_draws.get(joint)
            if draws and test in draws.expected:
                axes.errorbar(
                    end + _APART * place * length, KILO * draws.expected[test],
                    yerr=_SPREADS * KILO * draws.spreads[test], color=colour, fmt="o", markersize=3, capsize=2,
                )  # fmt: skip
        if forces.sizes["joint"] > 1:
            together = KILO * forces_of(forces, test)["work"].sum("joint", skipna=False)
            axes.plot(together["time"], together, label="all together", **DASHED)
        axes.set_ylabel(f"{test}\nenergy [kJ]")
    return _finished(figure, panels, columns=forces.sizes["joint"] + 1)


def plot_unexplained(forces, usual):
    """Figure of the least unexplained force of every block in every test of `measured_forces`.

    ``usual``: by test, the largest sum over the blocks that nominal draws leave [N]; dashed where it is known.
    """
    figure, panels = _rows(forces, 0.016)
    for axes, test in zip(panels, forces["test"].values, strict=True):
        for body, colour in coloured(forces["body"].values)[::-1]:
            one = forces_of(forces, test)["unexplained"].sel(body=body)
            axes.plot(one["time"], KILO * one, color=colour, linewidth=0.7, label=body)
        together = forces_of(forces, test)["unexplained"].sum("body", min_count=1)
        axes.plot(together["time"], KILO * together, color=BLACK, linewidth=0.5, label="sum")
        for level in (-1.0, 1.0) if test in usual else ():
            axes.axhline(KILO * level * usual[test], **DASHED)
        axes.set_ylabel(f"{test}\nforce [kN]")
    return _finished(figure, panels, columns=forces.sizes["body"] + 1)


def _rows(forces, above, each=0.026):
    """Empty figure with a row a test, heights [m] of what is above them and of each."""
    count = forces.sizes["test"]
    figure = new_figure(above + each * count)
    return figure, figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]


def _finished(figure, panels, columns=0):
    """The figure with its axis of time, and a legend of so many columns."""
    panels[-1].set_xlabel("time [s]")
    figure.align_ylabels(panels)
    if columns:
        handles = panels[0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside upper center", ncols=columns)
    return figure
