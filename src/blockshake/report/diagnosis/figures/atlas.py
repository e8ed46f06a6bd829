"""Residual atlas as a heat map: joint and quantity by phase and side, test by test."""

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Normalize

from blockshake.report.document.drawing import LIGHT_GREY, new_figure

_SHOWN = 2.0  # limits at which the colours end
_COLUMNS = 2
_COLORS = 31  # so few are drawn as areas


def plot_atlas(misfit, tests, joints):
    """Figure of the standardised residuals of `misfit`, one panel a test; ``joints`` from the lowest up.

    Red: the joint moved farther than simulated, blue: less far; grey: not known; a number where a residual is beyond
    its test's limit.
    """
    columns = min(_COLUMNS, len(tests))
    rows = -(-len(tests) // columns)
    quantities = [str(name) for name in misfit["quantity"].values]
    labels = [f"{joint} {name}" for joint in reversed(joints) for name in quantities]
    height = 0.0036 * len(labels) + 0.019
    figure = new_figure(0.006 + height * rows)
    panels = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    colors = colormaps["RdBu_r"].resampled(_COLORS)
    span = _SHOWN * float(misfit["limit"].max())
    for axes in panels.flat[len(tests) :]:
        axes.set_axis_off()
    for axes, test in zip(panels.flat, tests, strict=False):
        own = misfit.sel(test=test, joint=list(reversed(joints)))
        image = own["residual"].transpose("joint", "quantity", "phase", "side").to_numpy()
        image = image.reshape(len(labels), -1)
        axes.set_facecolor(LIGHT_GREY)
        drawn = axes.pcolormesh(image, cmap=colors, norm=Normalize(-span, span))
        axes.set_ylim(len(labels), 0)
        axes.grid(False)
        for row, column in zip(*np.nonzero(np.abs(image) > float(own["limit"])), strict=True):
            color = "white" if abs(image[row, column]) > 0.6 * span else "black"
            axes.text(
                column + 0.5,
                row + 0.5,
                f"{image[row, column]:.0f}",
                ha="center",
                va="center",
                color=color,
                fontsize=6.0,
            )
        for edge in range(2, image.shape[1], 2):
            axes.axvline(edge, color="black", linewidth=0.5)
        for edge in range(len(quantities), len(labels), len(quantities)):
            axes.axhline(edge, color="black", linewidth=0.5)
        axes.set_title(f"{test}, limit {float(own['limit']):.1f}")
    heads = [f"{phase}\n{side}" for phase in misfit["phase"].values for side in misfit["side"].values]
    panels[0, 0].set_xticks(0.5 + np.arange(len(heads)), heads)
    panels[0, 0].set_yticks(0.5 + np.arange(len(labels)), labels)
    for axes in panels.flat[: len(tests)]:
        axes.tick_params(labelbottom=True)
    figure.colorbar(
        drawn,
        ax=panels,
        label="residual [standard deviations]",
        shrink=0.8,
        extend="both",
        pad=0.01,
        aspect=30,
    )
    return figure
