"""Scores of the values of calibrated parameters by all open tests, one panel a parameter."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from blockshake.pages.drawing import BLACK, BLUE, LIGHT_GREY, ORANGE, RED, new_figure
from blockshake.pages.wording import model_label, parameter_label
from blockshake.study.calibration.calibration import ALL, models_of

_PANELS_ABREAST = 3
_ROW = 0.052  # m of paper
_COLORS = (BLUE, ORANGE)
_THICK, _THIN = 1.8, 0.8


def plot_calibration(found):
    """Figure of the scores of `calibrate` above the lowest of each line; in grey the range that all tests leave."""
    parameters, models = found["parameters"], models_of(found)
    columns = min(len(parameters), _PANELS_ABREAST)
    rows = -(-len(parameters) // columns)
    figure = new_figure(rows * _ROW + 0.008)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    lines = {ALL: BLACK} | dict(zip(models, _COLORS, strict=False))
    for axes, (name, one) in zip(panels, parameters.items(), strict=False):
        _draw(axes, one, lines)
        axes.set(title=parameter_label(name), xlabel="value [1]", ylabel="score above the lowest [1]")
        axes.title.set_fontsize(6.5)
    for axes in panels[len(parameters) :]:
        axes.set_axis_off()
    entries = {model_label(model): Line2D([], [], color=lines[model]) for model in models}
    entries["all tests"] = Line2D([], [], color=BLACK, linewidth=_THICK)
    entries["range, where told"] = Patch(facecolor=LIGHT_GREY, edgecolor="none")
    entries["the study's value"] = Line2D([], [], color=RED, linestyle=":")
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=len(entries))
    return figure


def _draw(axes, one, lines):
    values = np.array(one["values"])
    axes.set(xscale=one["scale"], xlim=(values[0], values[-1]))
    whole = one["answers"][ALL]
    if whole["told"]:
        ends = (whole["lower"] or one["lowest"], whole["upper"] or one["highest"])
        axes.axvspan(*ends, color=LIGHT_GREY, linewidth=0.0)
    for group, color in lines.items():
        if group in one["answers"]:
            score = np.array(one["answers"][group]["score"])
            width = _THICK if group == ALL else _THIN
            axes.plot(values, score - score.min(), color=color, linewidth=width)
    axes.axvline(np.clip(one["assumed"], *values[[0, -1]]), color=RED, linestyle=":", linewidth=1.0)
    axes.set_ylim(bottom=0.0)
