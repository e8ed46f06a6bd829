"""Picture of the first page: the structures, and the block that moves farthest by every model."""

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from blockshake.dynamics.system import FALLEN
from blockshake.measurement.sensors.markers import marker_position
from blockshake.pages.drawing import BLUE, GREEN, MEASURED, ORANGE, RED, new_figure
from blockshake.pages.scene.projection import Scene
from blockshake.pages.scene.structure_picture import draw_blocks
from blockshake.pages.wording import model_label

_COLORS = (BLUE, ORANGE, GREEN, RED)
CURVES = 0.105  # m of paper, width of the curves
_HEIGHT = 0.042  # m, of the curves
_STRUCTURE = 0.016, 0.024  # m, width and height of a structure
_BETWEEN = 0.02  # of a level, between models drawn at it
_LEAST = 0.1  # mm, drawn for all that moves less
_IN_A_ROW = 4  # structures
_IN_ONE_LINE = 5  # entries of a legend, from which on they stand in two
_TYPE, _LETTER = 6.0, 2.3e-4  # points, of a name; m, width of a letter of one point


def plot_structures(structures, case, marker):
    """Figure of a list of `Structure` in space, with a marker of that of a `ReportedCase` among them."""
    across = min(len(structures), _IN_A_ROW)
    rows = -(-len(structures) // across)
    figure = new_figure(_STRUCTURE[1] * rows, structures_width(structures))
    drawn = figure.subplots(rows, across, squeeze=False)
    for axes in drawn.flat:
        axes.set_axis_off()
    for axes, structure in zip(drawn.flat, structures, strict=False):
        scene, pose = Scene(structure, "3d"), (structure.position, structure.orientation)
        draw_blocks(axes, scene, structure, *pose)
        if structure.content == case.structure.content:
            row = [one.name for one in structure.file.markers].index(marker)
            at = scene.seen(marker_position(structure, *pose)[row])
            axes.plot(
                at[0], at[1], "o", color=RED, markersize=3.5, markeredgecolor="white", markeredgewidth=0.5
            )
        size = min(_TYPE, _STRUCTURE[0] / (len(structure.file.name) * _LETTER))
        axes.text(
            0.5, 0.0, structure.file.name, transform=axes.transAxes, ha="center", va="top", fontsize=size
        )
        axes.set(aspect="equal", anchor="S")
        axes.autoscale_view()
    return figure


def structures_width(structures):
    """Width of `plot_structures` [m]."""
    return _STRUCTURE[0] * max(2, min(len(structures), _IN_A_ROW))


def is_off_scale(case, marker):
    """Whether a run of a `ReportedCase` with levels moves a marker by less than is drawn."""
    peaks = [1e3 * one.samples["peak"].sel(frame="slab", marker=marker) for one in case.responses.values()]
    return bool(case.levels) and min(float(one.min()) for one in peaks) < _LEAST


def plot_answer(case, marker):
    """Figure of a marker's displacement along x relative to the slab, of a `ReportedCase`.

    By model the median of the samples, and a band from the smallest to the largest at each time; the measured curve is
    dashed. Where the samples are scaled to levels, the largest displacement of each of them over the level.
    """
    figure = new_figure(_HEIGHT, CURVES)
    curves = figure.subplots()
    (_draw_levels if case.levels else _draw_histories)(curves, case, marker)
    handles, labels = curves.get_legend_handles_labels()
    figure.legend(
        handles,
        labels,
        loc="outside upper center",
        ncols=len(labels) if len(labels) < _IN_ONE_LINE else 3,
        fontsize=6.5,
        handlelength=1.2,
        columnspacing=0.8,
    )
    return figure


def _draw_levels(axes, case, marker):
    """Largest displacement of every run over its level, models next to each other; crosses are those that collapsed."""
    for place, ((model, one), color) in enumerate(zip(case.responses.items(), _COLORS, strict=False)):
        at = np.array([case.levels[int(sample)] for sample in one.samples["sample"].values])
        at *= 1.0 + _BETWEEN * (place - 0.5 * (len(case.responses) - 1))
        peak = np.maximum(1e3 * one.samples["peak"].sel(frame="slab", marker=marker).to_numpy(), _LEAST)
        fell = np.isin(one.samples["status"].values, FALLEN)
        axes.plot(
            at[~fell], peak[~fell], "o", color=color, markersize=3.0, alpha=0.7, label=model_label(model)
        )
        axes.plot(at[fell], peak[fell], "x", color=color, markersize=4.0)
    levels = sorted(set(case.levels.values()))
    name = case.settings["intensity"]["measure"].upper()
    axes.set(xlabel=f"{name} [{case.level_unit}]", ylabel="largest [mm]", xscale="log", yscale="log")
    axes.set_xticks(levels, [f"{one:g}" for one in levels])
    axes.set_xticks([], minor=True)
    axes.yaxis.set_major_locator(LogLocator(numticks=4))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter(NullFormatter())


def _draw_histories(curves, case, marker):
    for (model, one), color in zip(case.responses.items(), _COLORS, strict=False):
        at = one.envelope.sel(frame="slab", marker=marker, axis="x")
        bounds = (1e3 * at["marker_envelope"].sel(bound=bound) for bound in ("lower", "upper"))
        curves.fill_between(at["time"], *bounds, color=color, alpha=0.25, linewidth=0.0)
        curves.plot(
            at["time"],
            1e3 * at["marker_displacement"].sel(quantile=0.5),
            color=color,
            label=model_label(model),
        )
    if case.measured is not None and marker in case.measured["marker"].values:
        measured = case.measured["displacement"].sel(frame="slab", marker=marker)
        curves.plot(case.measured["time"], 1e3 * measured, label=case.curve_word, **MEASURED)
    curves.set(xlabel="time [s]", ylabel="from place [mm]", xlim=(0.0, case.settings["duration"]))
