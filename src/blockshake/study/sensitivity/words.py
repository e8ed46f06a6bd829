"""Sensitivities in words: spread of a block, variables that stand out from chance."""

import numpy as np

from blockshake.pages.wording import millimetres, number, parameter_label, percent
from blockshake.study.sensitivity.findings import differs, influences, is_known, windows_beyond_chance


def sentence(result, body, marker, noise):
    """Spread of a block, and the variables that explain it beyond chance, in sentences.

    ``result`` from `sensitivity`; ``noise`` of a measured marker [m].
    """
    history = result.sel(quantity="history", marker=marker)
    if not np.isfinite(history["spread"]):
        return f"too few completed samples for a sensitivity of {body}: {int(history['used'])}."
    spread = "(standard deviation over samples and time)"
    if not differs(history, noise):
        return (
            f"the samples of {body} differ by {number(1e3 * history['spread'], 2)} mm {spread}, less than the noise of "
            "a marker: the envelope is a line and there is nothing to explain."
        )
    words = (
        f"the samples of {body} differ by {millimetres(history['spread'])} mm {spread}. "
        f"{_explained(history)} {_seconds(result.sel(marker=marker), noise)}"
    )
    peak = result.sel(quantity="peak", marker=marker)
    if not is_known(peak, "rank_correlation"):
        return (
            f"{words} {int(peak['used'])} samples are too few for partial correlations of so many variables."
        )
    explained = float(peak["explained"])
    share = f"{percent(explained)} %" if explained > 0.0 else "nothing"
    return (
        f"{words} {_steered(peak)} All variables together explain {share} of the ranks of the peak "
        f"(adjusted R\N{SUPERSCRIPT TWO} {explained:.2f})."
    )


def _explained(history):
    found = influences(history, "first_order")
    named = ", then ".join(map(influence_words, found.beyond_chance))
    if named:
        return f"Shown to explain some of that by itself: {named}; level of chance {found.chance:.2f}."
    return (
        "No variable is shown to explain any of that by itself: the largest share, "
        f"{influence_words(found.ranked[0])}, is within the level of chance, {found.chance:.2f}."
    )


def _steered(peak):
    found = influences(peak, "rank_correlation")
    named = ", then ".join(map(influence_words, found.beyond_chance))
    if named:
        return f"The peak follows {named} (partial rank correlation; level of chance {found.chance:.2f})."
    return (
        "No variable is shown to steer the peak: the largest partial rank correlation, "
        f"{influence_words(found.ranked[0])}, is within the level of chance, {found.chance:.2f}."
    )


def _seconds(result, noise):
    """Seconds in which a variable's share is beyond chance."""
    count, chance, found = windows_beyond_chance(result, noise)
    if not found:
        return f"In no single second is any share beyond chance ({chance:.2f})."
    told = ", ".join(
        f"{parameter_label(one.parameter)} in {one.count} (first about {one.first:.1f} s, last {one.last:.1f} s, at "
        f"most {one.largest:.2f})"
        for one in found
    )
    return f"Of the {count} seconds one by one, beyond chance ({chance:.2f}): {told}."


def influence_words(one):
    """One variable, marked if it is a control, with its measure and interval."""
    control = ", a control" if one.control else ""
    return f"{parameter_label(one.parameter)}{control} {one.value:.2f} [{one.lower:.2f}, {one.upper:.2f}]"
