"""Scores of the candidates of a friction calibration."""

import numpy as np

from blockshake.report.document.drawing import BLACK, BLUE, LIGHT_GREY, RED, new_figure


def plot_friction(calibrations):
    """Figure of the excess score over the best candidate with its error, one panel a case.

    ``calibrations``: from `friction_summary`, by case.
    """
    figure = new_figure(0.065)
    panels = figure.subplots(1, len(calibrations), squeeze=False, sharey=True)[0]
    for axes, (case, found) in zip(panels, calibrations.items(), strict=True):
        table = {name: np.array(values) for name, values in found["means"].items()}
        mean, excess, error = table["mean"], 1e3 * table["excess"], 1e3 * table["error"]
        accepted = table["accepted"]
        axes.axvspan(
            mean[accepted].min(), mean[accepted].max(), color=LIGHT_GREY, label="not told from the best"
        )
        axes.errorbar(mean, excess, error, fmt="none", ecolor=BLACK, elinewidth=0.7, capsize=2.0)
        for chosen, color, label in ((accepted, BLUE, "not refused"), (~accepted, RED, "refused")):
            axes.plot(mean[chosen], excess[chosen], "o", color=color, markersize=3.5, label=label)
        axes.set(title=case, xlabel="mean coefficient of friction [1]")
    panels[0].set_ylabel("score above the best [mm]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(handles))
    return figure
