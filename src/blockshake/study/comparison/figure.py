"""Distances of the models from each other beside chance and the floor of their numerics, one panel a case."""

from itertools import combinations

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from blockshake.pages.drawing import BLUE, LIGHT_GREY, ORANGE, RED, new_figure
from blockshake.pages.units import FINEST
from blockshake.pages.wording import model_label
from blockshake.study.comparison.tables import larger_floor

_PANELS_ABREAST = 2
_ROW = 0.0048  # m of paper, of one pair
_DISTANCE = {"marker": "o", "color": BLUE, "markersize": 4.0}
_HISTORY = {"marker": "D", "color": ORANGE, "markersize": 3.4}
_FLOOR = {"marker": "x", "color": RED, "markersize": 4.4, "markeredgewidth": 1.1}


def plot_differences(differences):
    """Figure of every pair of models in every case, distances [mm] on a logarithmic axis.

    ``differences``: from `compare_models`, by case. Dots: distance of the ensembles, with the level of chance as a grey
    bar from the left; diamonds: difference of the same samples, with limits; crosses: larger floor of both numerics.
    """
    rows = -(-len(differences) // _PANELS_ABREAST)
    columns = min(len(differences), _PANELS_ABREAST)
    longest = max(len(list(combinations(one["model"].values, 2))) for one in differences.values())
    figure = new_figure(rows * (0.016 + _ROW * longest) + 0.008)
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for axes, (case, found) in zip(panels.flat, differences.items(), strict=False):
        pairs = list(combinations(found["model"].values, 2))
        for place, (own, other) in enumerate(pairs):
            _draw_pair(axes, place, found, own, other)
        axes.set(title=case, xscale="log")
        axes.set_yticks(range(len(pairs)), [" | ".join(map(model_label, pair)) for pair in pairs])
        axes.tick_params(axis="y", labelsize=6.0, left=False)
        axes.grid(False, axis="y")
    for axes in panels.flat[len(differences) :]:
        axes.set_axis_off()
    panels[0, 0].set_ylim(longest - 0.4, -0.6)
    drawn = np.concatenate([line.get_xdata() for axes in panels.flat for line in axes.lines])
    panels[0, 0].set_xlim(left=max(FINEST, 0.3 * np.nanmin(drawn)) if np.isfinite(drawn).any() else FINEST)
    for axes in panels[-1]:
        axes.set_xlabel("difference [mm]")
    entries = {
        "distance of the ensembles": Line2D([], [], linestyle="none", **_DISTANCE),
        "chance": Patch(facecolor=LIGHT_GREY, edgecolor="none"),
        "difference of the same samples": Line2D([], [], linestyle="none", **_HISTORY),
        "larger floor of the numerics": Line2D([], [], linestyle="none", **_FLOOR),
    }
    figure.legend(entries.values(), entries.keys(), loc="outside upper center", ncols=len(entries))
    return figure


def _draw_pair(axes, place, found, own, other):
    at = found.sel(model=own, other=other)
    chance = 1e3 * float(at["distance_chance"])
    if np.isfinite(chance):
        axes.barh(place, chance - FINEST, left=FINEST, height=0.7, color=LIGHT_GREY, linewidth=0.0, zorder=1)
    limits = 1e3 * at["history_difference_interval"].to_numpy()
    axes.plot(limits, [place, place], color=ORANGE, linewidth=0.8, zorder=2)
    floors = [larger_floor(found, model) for model in (own, other)]
    floor = max(floors) if np.isfinite(floors).all() else np.nan
    for value, style in (
        (at["distance"], _DISTANCE),
        (at["history_difference"], _HISTORY),
        (floor, _FLOOR),
    ):
        shown = max(1e3 * float(value), FINEST) if np.isfinite(float(value)) else np.nan
        axes.plot(shown, place, linestyle="none", zorder=3, **style)
