"""Histograms of the samples with the densities they come from: the paper's Fig. 8."""

import numpy as np

from blockshake.pages.drawing import LIGHT_GREY, RED, new_figure
from blockshake.pages.units import printed
from blockshake.pages.wording import parameter_label
from blockshake.study.sampling.distributions import parameter_unit

_COLUMNS = 3
_ROW_HEIGHT = 0.044  # m of paper


def plot_samples(design, distributions):
    """Figure of the density of each sampled variable beside its target.

    ``design``: one row a sample, columns the dotted names, SI; ``distributions``: targets by dotted name.
    """
    rows = -(-len(distributions) // _COLUMNS)
    figure = new_figure(_ROW_HEIGHT * rows + 0.008)
    panels = figure.subplots(rows, _COLUMNS, squeeze=False)
    for axes, (name, target) in zip(panels.flat, distributions.items(), strict=False):
        factor, unit = printed(parameter_unit(name))
        _, edges, _ = axes.hist(
            factor * design[name], bins=bin_count(len(design)), density=True, color=LIGHT_GREY,
            edgecolor="#808080", linewidth=0.5, label="samples",
        )  # fmt: skip
        reach = 0.15 * (edges[-1] - edges[0])
        values = np.linspace(edges[0] - reach, edges[-1] + reach, 200)
        axes.plot(values, target.density(values / factor) / factor, color=RED, label="target density")
        axes.set(title=parameter_label(name), xlabel=f"value [{unit}]")
        axes.tick_params(labelleft=False, left=False)
        axes.grid(False)
    for axes in panels.flat[len(distributions) :]:
        axes.set_axis_off()
    for axes in panels[:, 0]:
        axes.set_ylabel("density")
    figure.get_layout_engine().set(hspace=0.06)
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=2)
    return figure


def bin_count(size):
    """Bins of a histogram of this many samples: their square root, up, and one."""
    return int(np.ceil(np.sqrt(size))) + 1
