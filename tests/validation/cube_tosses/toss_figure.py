"""Figure of ``docs/results/tosses.md``: how the errors grow after the first impact, and how far off the cube rests."""

import matplotlib

matplotlib.use("agg")

import numpy as np
from matplotlib import pyplot as plt

_SPAN = 0.45  # s after the first impact


def draw(data, drawn, path):
    """Draw the predicted half's scores.

    Parameters
    ----------
    data : toss_study.Data
    drawn : dict of str to (scores, scores between twins)
    path : path
    """
    figure, (growth, rest) = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")
    for colour, (name, (scores, _)) in zip(("C3", "C0", "C2"), drawn.items(), strict=True):
        time, low, middle, high = _since_impact(data.to_predict, scores)
        growth.fill_between(time, low, high, color=colour, alpha=0.15, linewidth=0)
        growth.plot(time, middle, color=colour, label=name)
        rest.plot(*_cumulative(scores), color=colour, label=name)
    pairs, name = drawn["NSCD"][1], "twins of NSCD: starts apart by noise and bias"
    time, _, middle, _ = _since_impact(data.to_predict, pairs)
    growth.plot(time, middle, color="k", linestyle="--", label=name)
    rest.plot(*_cumulative(pairs), color="k", linestyle="--", label=name)
    growth.set(
        xlabel="time since the first impact [s]",
        ylabel="position error [mm]",
        ylim=(0, 35),
        xlim=(-0.05, _SPAN),
    )
    growth.set_title("median and quartiles of the predicted tosses", fontsize=10)
    rest.set(
        xlabel="position error at rest [mm]",
        ylabel="share of the predicted tosses [1]",
        xlim=(0, 100),
        ylim=(0, 1),
    )
    rest.set_title("the cube is 104.8 mm wide", fontsize=10)
    rest.legend(fontsize=8, loc="lower right")
    figure.savefig(path, dpi=110, metadata={"Software": None})
    plt.close(figure)


def _since_impact(tosses, scores):
    """Time [s] and quartiles of the position error [mm], of the tosses that are that long."""
    rows = np.arange(-7, round(_SPAN * 148.0))
    table = np.full((len(tosses), rows.size), np.nan)
    for row, (toss, one) in enumerate(zip(tosses, scores, strict=True)):
        place = toss.flight + rows
        known = (place >= 0) & (place < len(one.position))
        table[row, known] = 1e3 * one.position[place[known]]
    return rows / 148.0, *np.nanquantile(table, [0.25, 0.5, 0.75], axis=0)


def _cumulative(scores):
    values = np.sort([1e3 * one.position[-1] for one in scores])
    return values, np.arange(1, values.size + 1) / values.size
