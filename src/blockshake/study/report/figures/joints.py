"""Compression, uplift and slip of the joints of a structure by every model."""

import numpy as np
from matplotlib.ticker import MaxNLocator

from blockshake.pages.drawing import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, new_figure
from blockshake.pages.wording import SHOWN_QUANTILES, model_label

_PANELS = {
    "joint_compression": ("compression [kN]", 1e-3),
    "joint_uplift": ("uplift [mm]", 1e3),
    "joint_slip": ("slip [mm]", 1e3),
}
_STYLES = ((BLUE, "o"), (RED, "s"), (GREEN, "^"), (ORANGE, "D"), (PURPLE, "v"), (BLACK, "P"))
_ROW, _REST, _PAGE = 0.0026, 0.022, 0.2  # m of paper: of one model at one joint, around all, and at most
_HEIGHT = 0.8  # of the distance of two joints, taken by its models


def plot_joints(envelopes):
    """Figure of the quantiles of every joint's largest compression, uplift and slip, joints from the foundation up.

    ``envelopes``: from `envelope`, by model. Dots: median of the samples; lines: from the 5 % to the 95 % quantile.
    """
    joints = next(iter(envelopes.values()))["joint"].values
    figure = new_figure(min(_REST + _ROW * (len(envelopes) + 1) * len(joints), _PAGE))
    panels = figure.subplots(1, len(_PANELS), sharey=True)
    places = np.arange(len(joints))
    offsets = np.linspace(0.5, -0.5, len(envelopes) + 2)[1:-1] * _HEIGHT
    for axes, (name, (label, factor)) in zip(panels, _PANELS.items(), strict=True):
        for (model, one), offset, (color, marker) in zip(envelopes.items(), offsets, _STYLES, strict=False):
            low, median, high = (factor * one[name].sel(quantile=q).to_numpy() for q in SHOWN_QUANTILES)
            axes.hlines(places + offset, low, high, color=color, linewidth=1.0)
            axes.plot(
                median, places + offset, linestyle="none", color=color, marker=marker, markersize=3.2,
                label=model_label(model),
            )  # fmt: skip
        axes.set_xlim(left=0.0)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.set_xlabel(label)
        axes.grid(False, axis="y")
        for place in places[:-1]:
            axes.axhline(place + 0.5, color="#e4e4e4", linewidth=0.4)
    panels[0].set_yticks(places, joints)
    panels[0].set_ylim(-0.6, len(joints) - 0.4)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=len(envelopes))
    return figure
