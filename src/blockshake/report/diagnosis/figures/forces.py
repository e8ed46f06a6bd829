"""Levers and laws of the joints and the least unexplained force of the blocks, in all tests."""

import numpy as np

from blockshake.diagnosis.laws.law_table import kind_of
from blockshake.report.document.drawing import BLACK, BLUE, DARK_GREY, GREEN, ORANGE, PURPLE, RED, new_figure

_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, BLACK)
_BEYOND = 1.6  # half widths, at the ends of the axis
_KILO = 1e-3
_SLIP_RATES = 0.01, 1.0  # m/s, ends of the axis
_APART = 0.02  # of a test's length, between the joints' draws beyond its end


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


def plot_laws(forces):
    """Figure of the readings that the laws of the joints rest on, in every test of `measured_forces`.

    Lever against rotation while a joint is turned, with the edges of the lowest face; shear over normal force against
    the slip rate while a joint slips, with the coefficient of friction; rotation against moment while it is closed.
    """
    tests = [str(name) for name in forces["test"].values]
    figure = new_figure(0.02 + 0.042 * len(tests))
    panels = figure.subplots(len(tests), 3, sharex="col", squeeze=False)
    joints = [str(name) for name in forces["joint"].values]
    for (turned, slips, closed), test in zip(panels, tests, strict=True):
        for joint, colour in zip(joints, np.resize(_COLOURS, len(joints)), strict=True):
            one = forces.sel(test=test, joint=joint)
            look = {
                "color": str(colour),
                "label": joint,
                "linestyle": "none",
                "marker": ".",
                "markersize": 1.5,
            }
            told = {
                name: one["told"].sel(law=name).to_numpy() == 1 for name in ("lever", "friction", "closed")
            }
            at = {name: one.isel(time=mask) for name, mask in told.items()}
            turned.plot(1e3 * at["lever"]["rotation"], 1e3 * at["lever"]["lever"], **look)
            ratio = np.abs(at["friction"]["shear"] / at["friction"]["normal"])
            slips.plot(np.abs(at["friction"]["slip_rate"]), ratio, **look)
            moment = at["closed"]["lever"] * at["closed"]["normal"]
            closed.plot(_KILO * moment, 1e3 * at["closed"]["rotation"], **look)
        half, coefficient = (
            float(forces[name].isel(joint=0).max()) for name in ("half_width", "coefficient")
        )
        for axes, level in ((turned, 1e3 * half), (turned, -1e3 * half), (slips, coefficient)):
            axes.axhline(level, color=DARK_GREY, linewidth=0.6, linestyle=(0, (4, 2)))
        turned.set_ylim(-1e3 * _BEYOND * half, 1e3 * _BEYOND * half)
        slips.set_xscale("log")
        slips.set_xlim(_SLIP_RATES)
        if not forces["told"].sel(test=test, law="friction").any():
            slips.text(0.5, 0.5, "no joint slips", transform=slips.transAxes, ha="center", color=DARK_GREY)
        slips.set_ylim(0.0, 1.5 * coefficient)
        turned.set_ylabel(f"{test}\nlever [mm]")
        slips.set_ylabel("shear / normal [1]")
        closed.set_ylabel("rotation [mrad]")
    for axes, words in zip(panels[-1], ("rotation [mrad]", "slip rate [m/s]", "moment [kN m]"), strict=True):
        axes.set_xlabel(words)
    figure.align_ylabels(panels)
    figure.legend(
        *panels[0, 0].get_legend_handles_labels(),
        loc="outside upper center",
        ncols=len(joints),
        markerscale=4,
    )
    return figure


def plot_work(forces, shown):
    """Figure of the energy that every joint takes out of the motion in every test of `measured_forces`.

    Beyond the end of a test: mean of the nominal draws and two standard deviations, of ``shown`` (sequence of
    LawFinding).
    """
    tests = [str(name) for name in forces["test"].values]
    figure = new_figure(0.016 + 0.03 * len(tests))
    panels = figure.subplots(len(tests), 1, sharex=True, squeeze=False)[:, 0]
    joints = [str(name) for name in forces["joint"].values]
    of_draws = {one.joint: one for one in shown if kind_of(one.name) == "work.taken"}
    length = float(forces["time"].max() - forces["time"].min())
    for axes, test in zip(panels, tests, strict=True):
        for place, (joint, colour) in enumerate(
            zip(joints, np.resize(_COLOURS, len(joints)), strict=True), start=1
        ):
            one = forces["work"].sel(test=test, joint=joint)
            axes.plot(one["time"], _KILO * one, color=str(colour), linewidth=0.8, label=joint)
            if joint in of_draws and test in of_draws[joint].expected:
                draws = of_draws[joint]
                axes.errorbar(
                    float(forces["time"].max()) + _APART * place * length, _KILO * draws.expected[test],
                    yerr=2.0 * _KILO * draws.spreads[test], color=str(colour), fmt="o", markersize=3, capsize=2,
                )  # fmt: skip
        axes.set_ylabel(f"{test}\nenergy [kJ]")
    panels[-1].set_xlabel("time [s]")
    figure.align_ylabels(panels)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=len(joints))
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
