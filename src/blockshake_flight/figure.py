"""Figures of filmed flights: acceleration beyond gravity over velocity, and what impacts keep."""

import numpy as np

from blockshake.pages.drawing import BLACK, BLUE, GREY, MEASURED, ORANGE, new_figure

_BINS = 12


def plot_accelerations(evidence, axes_shown):
    """Acceleration beyond gravity of every flight over its velocity, measured and explained, one panel an axis."""
    figure = new_figure(0.06)
    panels = figure.subplots(1, len(axes_shown), squeeze=False)[0]
    for panel, axis in zip(panels, axes_shown, strict=True):
        own = evidence.sel(axis=axis)
        velocity, measured, explained = (
            own[name].to_numpy() for name in ("velocity", "acceleration", "explained")
        )
        limit = 4.0 * np.quantile(np.abs(measured), 0.75)
        first = np.zeros(len(velocity), dtype=bool)
        first[np.unique(own["test"], return_index=True)[1]] = True
        for some, color, label in ((~first, GREY, "later flights"), (first, ORANGE, "tests' first flights")):
            panel.plot(velocity[some], measured[some], ".", color=color, markersize=2.5, label=label)
        # of equal numbers of flights
        bins = np.array_split(np.argsort(velocity), min(_BINS, max(len(velocity) // 8, 1)))
        middle = [np.median(velocity[one]) for one in bins]
        for values, color, label in (
            (measured, BLACK, f"median of {len(bins[-1])} flights, measured"),
            (explained, BLUE, "the same, explained"),
        ):
            usual = [np.median(values[one]) for one in bins]
            panel.plot(middle, usual, "o-", color=color, markersize=3.0, label=label)
        panel.axhline(0.0, **MEASURED)
        panel.set_ylim(-limit, limit)
        panel.set_xlabel(f"mean velocity along {axis} [m/s]")
    panels[0].set_ylabel("acceleration beyond gravity [m/s2]")
    panels[-1].legend(loc="best")
    return figure


def plot_errors(scores, colors):
    """Mean distance of the middle on sealed tests by model, early and over the whole path: cumulative shares."""
    figure = new_figure(0.06)
    panels = figure.subplots(1, 2, squeeze=False)[0]
    for panel, name, title in zip(
        panels, ("early", "place"), ("until 0.1 s after the first flight", "whole path"), strict=True
    ):
        for kind, color in colors.items():
            values = np.sort(1e3 * scores[name].sel(kind=kind).to_numpy())
            panel.plot(values, (1.0 + np.arange(len(values))) / len(values), color=color, label=kind)
        panel.set_title(title)
        panel.set_xlabel("mean distance of the middle [mm]")
        panel.set_xlim(0.0, None)
    panels[0].set_ylabel("share of the sealed tests")
    panels[1].legend(loc="lower right")
    return figure
