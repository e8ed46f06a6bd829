"""Joints of a case: figure and table of their compression, uplift and slip."""

import numpy as np
from matplotlib.ticker import MaxNLocator

from blockshake.pages.blocks import Figure, Table
from blockshake.pages.drawing import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, new_figure, svg_of
from blockshake.pages.wording import MISSING, SHOWN_QUANTILES, model_label, number, quantile_percent
from blockshake.simulation.run_histories import RARELY

_SHOWN = 0.95
_FIGURES = {  # label and factor from SI
    "joint_compression": ("compression [kN]", 1e-3),
    "joint_uplift": ("uplift [mm]", 1e3),
    "joint_slip": ("slip [mm]", 1e3),
}
_STYLES = ((BLUE, "o"), (RED, "s"), (GREEN, "^"), (ORANGE, "D"), (PURPLE, "v"), (BLACK, "P"))
_ROW, _REST, _PAGE = 0.0026, 0.022, 0.2  # m of paper: of one model at one joint, around all, and at most
_HEIGHT = 0.8  # of the distance of two joints, taken by its models
_MEANING = (
    f"Compression: normal force that is exceeded for {100.0 * RARELY:g} % of the time, so that it leaves impacts out; "
    "uplift and slip: the largest at the middle of the face"
)


def joint_blocks(case):
    """Figure and table of a case's joints; nothing where no sample of any model has a result."""
    envelopes = {
        model: one.envelope for model, one in case.responses.items() if int(one.envelope.attrs["counted"])
    }
    if not envelopes:
        return []
    return [
        Figure(
            f"{case.name}: joints from the foundation up. {_MEANING}. Dots: median over the samples; lines: from the "
            "5 % to the 95 % quantile.",
            svg_of(plot_joints, envelopes),
        ),
        _table(case, envelopes),
    ]


def _table(case, envelopes):
    rows = [
        (str(joint), *(_cell(one.sel(joint=joint, quantile=_SHOWN)) for one in envelopes.values()))
        for joint in reversed(next(iter(envelopes.values()))["joint"].values)
    ]
    labels = (f"{model_label(model)} (n = {int(one.attrs['counted'])})" for model, one in envelopes.items())
    return Table(
        f"{case.name}: compression [kN] / uplift [mm] / slip [mm] of the joints from the top down, "
        f"{quantile_percent(_SHOWN)} quantile over the samples that did not fail. {_MEANING}.",
        ("Joint", *labels), tuple(rows), "l" + "r" * len(envelopes),
    )  # fmt: skip


def _cell(at):
    shown = [factor * float(at[name]) for name, (_, factor) in _FIGURES.items()]
    return " / ".join(map(number, shown)) if np.isfinite(shown).all() else MISSING


def plot_joints(envelopes):
    """Figure of the quantiles of every joint's largest compression, uplift and slip, joints from the foundation up.

    ``envelopes``: from `envelope`, by model. Dots: median of the samples; lines: from the 5 % to the 95 % quantile.
    """
    joints = next(iter(envelopes.values()))["joint"].values
    figure = new_figure(min(_REST + _ROW * (len(envelopes) + 1) * len(joints), _PAGE))
    panels = figure.subplots(1, len(_FIGURES), sharey=True)
    places = np.arange(len(joints))
    offsets = np.linspace(0.5, -0.5, len(envelopes) + 2)[1:-1] * _HEIGHT
    for axes, (name, (label, factor)) in zip(panels, _FIGURES.items(), strict=True):
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
