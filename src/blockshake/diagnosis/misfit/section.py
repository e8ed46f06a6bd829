"""Sixth section of a diagnosis: what the simulation of the open tests gets wrong without a cause."""

import numpy as np

from blockshake.diagnosis.misfit.figure import plot_misfit
from blockshake.diagnosis.wording import chance_words
from blockshake.pages.blocks import Figure, Section, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.units import printed
from blockshake.pages.wording import number, percent

_MOST_ROWS = 12
_MOST_PANELS = 6


def misfit_section(diagnosed):
    """Worst histories against the nominal ensemble; None where nothing was simulated."""
    misfit = diagnosed.misfit
    if misfit is None:
        return None
    ranked = _ranked(misfit)
    rows = [_row(misfit, *one) for one in ranked[:_MOST_ROWS]]
    blocks = (
        Text(
            f"Nominal simulations by all solvers against the open tests, as long as each history can be predicted: "
            f"chance of a misfit as large as the largest without anything wrong, {chance_words(float(misfit['p']))}. "
            f"Largest: {misfit.attrs['where']}. No cause was decided by it."
        ),
        Figure(
            f"The {min(len(ranked), _MOST_PANELS)} histories that the nominal simulation predicts worst: 5 to 95 % "
            f"and median of the members of all solvers, and {diagnosed.measured_word}. Shaded: beyond the time for "
            "which it can be predicted.",
            svg_of(plot_misfit, misfit, ranked[:_MOST_PANELS], diagnosed.measured_word),
        ),
        Table(
            f"Histories that are predicted worst, {len(rows)} of {len(ranked)}. Score: continuous ranked "
            "probability score, mean until the horizon; usual: that of a nominal member; chance: share of the "
            "members that score as badly.",
            (
                "Test",
                "History",
                "Unit",
                "Score",
                "Usual",
                "Score / usual",
                "Chance [%]",
                "Worst at [s]",
                "Horizon [s]",
            ),
            tuple(rows),
            "lllrrrrrr",
        ),
    )
    return Section("What the nominal simulation gets wrong", "misfit", blocks)


def _ranked(misfit):
    """Places of test and cell, the largest score over its usual one first."""
    excess = (misfit["score"] / misfit["usual"]).transpose("test", "cell").to_numpy()
    excess = np.nan_to_num(np.where(np.isfinite(excess), excess, 0.0))
    order = np.argsort(-excess, axis=None, kind="stable")[: np.count_nonzero(excess)]
    return [tuple(map(int, np.unravel_index(index, excess.shape))) for index in order]


def _row(misfit, test, cell):
    history = misfit.isel(test=test, cell=cell)
    factor, unit = printed(str(history["unit"].item()))
    score, usual = factor * float(history["score"]), factor * float(history["usual"])
    shown = (score, usual, score / usual)
    return (
        str(history["test"].item()),
        f"{history['quantity'].item()}, {history['where'].item()}",
        unit,
        *map(number, shown),
        percent(history["chance"]),
        number(history["worst_time"]),
        number(history["horizon"]),
    )
