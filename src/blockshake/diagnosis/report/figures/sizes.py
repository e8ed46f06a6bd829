"""Sizes of causes with their intervals, on the ranges of the registry."""

from blockshake.diagnosis.wording import shown_unit
from blockshake.pages.drawing import BLACK, BLUE, DARK_GREY, LIGHT_GREY, SKY, new_figure

_ROOM = 0.04  # of the range, beyond either end


def plot_sizes(causes, parameters):
    """Figure of the parameters of every `Cause`, a strip each; ``parameters``: its `EffectParameter` list."""
    strips = [(cause, one) for cause, own in zip(causes, parameters, strict=True) for one in own]
    figure = new_figure(0.003 + 0.0135 * len(strips))
    panels = figure.subplots(len(strips), 1, squeeze=False)[:, 0]
    for axes, (cause, one) in zip(panels, strips, strict=True):
        factor, unit = shown_unit(one.unit)
        estimate = cause.parameters[one.name]
        low, high = min(one.lower, estimate.lower), max(one.upper, estimate.upper)
        axes.axvspan(factor * one.lower, factor * one.upper, color=LIGHT_GREY, linewidth=0.0)
        axes.axvspan(factor * estimate.lower, factor * estimate.upper, color=SKY, alpha=0.6, linewidth=0.0)
        if one.name == next(iter(cause.parameters)):
            axes.axvline(factor * one.null, color=DARK_GREY, linestyle="--", linewidth=0.8)
        members = [factor * member[one.name] for member in cause.members if one.name in member]
        axes.plot(members, [0.25] * len(members), "|", color=BLACK, markersize=6.0, markeredgewidth=0.5)
        axes.plot(factor * estimate.estimate, 0.65, "o", color=BLUE, markersize=5.0)
        axes.set_xlim(factor * (low - _ROOM * (high - low)), factor * (high + _ROOM * (high - low)))
        axes.set_ylim(0.0, 1.0)
        axes.set_yticks([])
        axes.grid(False)
        axes.set_xlabel(f"{one.name} [{unit}], {cause.title}")
    return figure
