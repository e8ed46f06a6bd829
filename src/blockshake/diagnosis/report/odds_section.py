"""Second section of a diagnosis: the odds of every cause that was tried, and how they were counted."""

import numpy as np

from blockshake.diagnosis.answer.answer import COARSENING, FREE_SHARE, ODDS, coarsened
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.diagnosis.report.statement import RATIO
from blockshake.diagnosis.wording import name_of
from blockshake.pages.blocks import Figure, Section, Text
from blockshake.pages.drawing import BLACK, BLUE, DARK_GREY, LIGHT_GREY, ORANGE, RED, new_figure, svg_of
from blockshake.pages.wording import number, sentence_case

_MOST_DECADES = 12.0  # of odds that are drawn
_LINEAR = 10.0  # nats, below which the axis of gains is linear
_MARGIN = 1.3
_APART = 0.13  # of an axis, between two labels
_TICKS = (-10, -5, 0, 5, *(first * 10**power for power in range(1, 6) for first in (1, 2, 5)))


def odds_section(diagnosed):
    """Odds and gains of all rivals, one figure a part of the readings."""
    parts = diagnosed.decision.parts
    blocks = [
        Text(
            "Every cause states the forces that it would make under the measured motion. One likelihood of all "
            "instants, joints and tests compares the causes with each other and with nothing. Gain [nats]: "
            "natural logarithm of how many times likelier the readings are with a cause than without, averaged "
            "over its sizes and places. Odds differ less than gains, because the form of a cause may leave "
            f"{100.0 * COARSENING:.0f} % of what it explains (coarsened posterior, Miller and Dunson 2019). A "
            f"force of no known form stands for all that nobody thought of, and counts with {FREE_SHARE:g} of its "
            "gain."
        )
    ]
    if not parts:
        blocks.append(
            Text(
                "No cause gains more over none than clean campaigns do by chance; there are no odds to show."
            )
        )
    for part in parts:
        first = part.causes[0]
        names = sorted(part.odds, key=part.odds.get)
        nothing = coarsened(first.gain, first.gain)
        rows = [(name_of(name), part.odds[name], part.gains[name]) for name in names]
        blocks.append(
            Figure(
                f"{sentence_case(part.readings)[:-1]}: how many times less likely each cause is than "
                f"{first.title}, the likeliest (left; arrows: beyond the axis), and its gain over nothing (right; "
                f"of the likeliest {number(first.gain)}). Shaded: within {RATIO} times, dashed, so that the tests "
                "do not tell them apart. Blue: effects of the registry; orange, in italics: forms from outside, "
                "which none of them is.",
                svg_of(plot_odds, rows, [name in FORMS for name in names], nothing),
            )
        )
    return Section("Odds of all causes", "odds", tuple(blocks))


def plot_odds(rows, outside, nothing):
    """Figure of the odds of the likeliest over every cause, and of the gains.

    Parameters
    ----------
    rows : list of (str, float, float)
        Name in words, logarithm of the odds, and gain, the likeliest first.
    outside : list of bool
        Of each, whether it is a form from outside.
    nothing : float
        Logarithm of the odds of the likeliest over none.
    """
    rows = [*rows, ("nothing", nothing, 0.0)]
    figure = new_figure(0.018 + 0.0048 * len(rows))
    odds, gains = figure.subplots(1, 2, sharey=True, width_ratios=(3, 2))
    heights = np.arange(len(rows))[::-1]
    decades = np.array([one for _, one, _ in rows]) / np.log(10.0)
    end = min(_MOST_DECADES, float(decades.max()) + 1.0)
    colors = [*(ORANGE if one else BLUE for one in outside), DARK_GREY]
    for axes in (odds, gains):
        for height, decade in zip(heights, decades, strict=True):
            if decade * np.log(10.0) < ODDS:
                axes.axhspan(height - 0.5, height + 0.5, color=LIGHT_GREY, linewidth=0.0, zorder=0)
    for height, decade, color in zip(heights, decades, colors, strict=True):
        marker = ">" if decade > end else "o"
        odds.plot([0.0, min(decade, end)], [height, height], color=color, linewidth=0.8)
        odds.plot(min(decade, end), height, marker, color=color, markersize=4.0, clip_on=False)
    odds.axvline(ODDS / np.log(10.0), color=RED, linestyle="--", linewidth=0.7)
    ticks = [tick for tick in range(int(end) + 1) if tick % max(1, int(end) // 5) == 0]
    odds.set_xticks(ticks, [_power(tick) for tick in ticks])
    odds.set_xlim(-0.02 * end, 1.03 * end)
    odds.set_xlabel("times less likely than the likeliest [1]")
    values = np.array([one for _, _, one in rows])
    gains.plot(np.maximum(values, -_LINEAR), heights, "s", color=BLACK, markersize=3.5)
    gains.axvline(0.0, color=BLACK, linewidth=0.7)
    gains.set_xscale("symlog", linthresh=_LINEAR)
    gains.set_xlim(
        -_MARGIN * _LINEAR if values.min() < 0.0 else -1.0, _MARGIN * max(float(values.max()), _LINEAR)
    )
    ticks = _apart(gains)
    gains.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    gains.set_xticks([], minor=True)
    gains.set_xlabel("gain over nothing [nats]")
    odds.set_yticks(heights, [name for name, *_ in rows])
    for label, one in zip(odds.get_yticklabels(), [*outside, False], strict=True):
        label.set_style("italic" if one else "normal")
    odds.set_ylim(-0.6, len(rows) - 0.4)
    return figure


def _apart(axes):
    """Ticks of the axis of gains whose labels do not meet, 0 among them."""
    low, high = axes.get_xlim()
    scaled = axes.xaxis.get_transform().transform
    least, chosen = _APART * float(np.ptp(scaled([low, high]))), [0]
    for tick in (one for one in reversed(_TICKS) if low <= one <= high):
        if all(abs(scaled(tick) - scaled(other)) > least for other in chosen):
            chosen.append(tick)
    return chosen


def _power(tick):
    return str(10**tick) if tick < 4 else "10" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(one)] for one in str(tick))
