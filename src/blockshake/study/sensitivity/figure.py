"""Sensitivity of a case's blocks to the random variables: dots with intervals over the level of chance."""

import numpy as np

from blockshake.pages.drawing import BLUE, DARK_GREY, LIGHT_GREY, RED, new_figure
from blockshake.pages.wording import model_label, number, parameter_label
from blockshake.study.sensitivity.findings import differs, is_known

SHOWN = {
    "first_order": ("history", "share of the envelope's thickness [1]", (-0.25, 1.05), (0.0, 0.5, 1.0)),
    "rank_correlation": ("peak", "partial rank correlation with the peak [1]", (-1.05, 1.05), (-0.5, 0.5)),
}
_COLORS = {"first_order": BLUE, "rank_correlation": RED}
_ROW = 0.0036  # m of paper, of one variable


def plot_sensitivity(sensitivities, markers, noise, measure):
    """A measure of every variable, one column a block, one row of panels a model.

    Parameters
    ----------
    sensitivities : dict of str to xarray.Dataset
        By model, from `sensitivity`.
    markers : dict of str to str
        Body to marker, from the lowest up.
    noise : float
        Standard deviation of a measured marker's position [m]: where samples differ by less, nothing is drawn.
    measure : str
        One of `SHOWN`.

    Returns
    -------
    matplotlib.figure.Figure or None
        None where no model has anything to show. Filled dots: variables of use to model and structure; hollow: the
        others, controls. Lines: 95 % intervals. Grey: level of chance.
    """
    variables = [str(name) for name in next(iter(sensitivities.values()))["parameter"].values]
    rows = [
        model for model, result in sensitivities.items() if is_shown(result, markers.values(), measure, noise)
    ]
    if not rows:
        return None
    figure = new_figure(len(rows) * (0.010 + _ROW * len(variables)) + 0.006)
    panels = figure.subplots(len(rows), len(markers), sharey=True, squeeze=False)
    quantity, label, limits, ticks = SHOWN[measure]
    for axes, body in zip(panels[0], markers, strict=True):
        axes.set_title(body)
    for line, model in zip(panels, rows, strict=True):
        result = sensitivities[model]
        for axes, marker in zip(line, markers.values(), strict=True):
            _draw_panel(axes, result.sel(quantity=quantity, marker=marker), measure, noise)
            axes.set(xlim=limits, xticks=ticks)
        line[0].set_ylabel(f"{model_label(model)}, n = {int(result['used'].sel(quantity=quantity))}")
        line[0].set_yticks(range(len(variables)), [parameter_label(name) for name in variables])
        for text, control in zip(line[0].get_yticklabels(), result["control"].values, strict=True):
            text.set(fontsize=6.5, color=DARK_GREY if control else "black")
    panels[-1, panels.shape[1] // 2].set_xlabel(label)
    panels[0, 0].set_ylim(len(variables) - 0.4, -0.6)
    figure.align_ylabels(panels[:, 0])
    return figure


def is_shown(result, markers, measure, noise):
    """Whether a measure of a model is drawn: any variable's is beyond chance at any of the markers."""
    one = result.sel(quantity=SHOWN[measure][0], marker=list(markers))
    if not (differs(one, noise) and is_known(one, measure)):
        return False
    strength = one[measure] if measure == "first_order" else abs(one[measure])
    return bool((strength > one[f"{measure}_chance"]).any())


def _draw_panel(axes, result, measure, noise):
    level = float(result[f"{measure}_chance"])
    found = result[measure].to_numpy()
    axes.grid(False, axis="y")
    axes.tick_params(left=False)
    if np.isfinite(result["spread"]) and not differs(result, noise):
        _say(axes, f"samples differ by\n{number(1e3 * result['spread'], 2)} mm")
        return
    if not is_known(result, measure):
        _say(axes, f"{int(result['used'])} samples:\ntoo few")
        return
    axes.axvspan(-level, level, color=LIGHT_GREY, linewidth=0.0)
    axes.axvline(0.0, color=DARK_GREY, linewidth=0.5)
    low, high = (result[f"{measure}_interval"].sel(bound=one).to_numpy() for one in ("lower", "upper"))
    color = _COLORS[measure]
    for row, control in enumerate(result["control"].values):
        axes.plot([low[row], high[row]], [row, row], color=color, linewidth=0.8)
        axes.plot(
            found[row], row, "o", color=color, markersize=3.4, markeredgewidth=0.8,
            markerfacecolor="white" if control else color,
        )  # fmt: skip


def _say(axes, words):
    axes.text(
        0.5, 0.5, words, ha="center", va="center", transform=axes.transAxes, fontsize=6.5, color=DARK_GREY
    )
    axes.tick_params(labelbottom=False, bottom=False)
    axes.grid(False)
