"""Sensitivities in words: which variable dominates, and whether anything is beyond chance."""

import numpy as np

from blockshake.report.wording import millimetres, number, parameter_label, percent


def sentence(result, body, marker, noise):
    """In words, which variable dominates at a block and whether anything is beyond chance.

    Parameters
    ----------
    result : xarray.Dataset
        From `sensitivity`.
    body, marker : str
    noise : float
        Of a measured marker [m].

    Returns
    -------
    str
    """
    history = result.sel(quantity="history", marker=marker)
    if not np.isfinite(history["spread"]):
        return f"{int(history['used'])} completed samples are too few to say what {body} depends on."
    if float(history["spread"]) < noise:
        return (
            f"the samples of {body} differ by {number(1e3 * float(history['spread']), 2)} mm (standard deviation "
            f"over "
            "samples and time), less than a marker's noise: its envelope is a line and there is nothing to explain."
        )
    words = (
        f"the samples of {body} differ by {millimetres(history['spread'])} mm (standard deviation over samples and "
        f"time). "
        f"{_dominating(history, 'first_order')} {_seconds(result.sel(marker=marker), noise)}"
    )
    peak = result.sel(quantity="peak", marker=marker)
    if not np.isfinite(peak["rank_correlation_chance"]):
        return (
            f"{words} {int(peak['used'])} samples are too few for partial correlations of so many variables."
        )
    explained = float(peak["explained"])
    share = f"{percent(explained)} %" if explained > 0.0 else "nothing"
    return (
        f"{words} {_dominating(peak, 'rank_correlation')} All variables together explain {share} of the ranks of "
        f"the peak "
        f"(adjusted R\N{SUPERSCRIPT TWO} {explained:.2f})."
    )


def _seconds(result, noise):
    """In which seconds a variable explains more than chance would."""
    level = float(result["window_first_order_chance"])
    share = result["window_first_order"].where(result["window_spread"] >= noise)
    told = []
    for name in result["parameter"].values:
        one = share.sel(parameter=name)
        beyond = one["window"].values[one.values > level]
        if len(beyond):
            told.append(
                f"{parameter_label(str(name))} in {len(beyond)} (first about {beyond[0]:.1f} s, last "
                f"{beyond[-1]:.1f} s, at "
                f"most {float(one.max()):.2f})"
            )
    if not told:
        return f"In no single second is any share beyond chance ({level:.2f})."
    seconds = int((result["window_spread"] >= noise).sum())
    return f"Of the {seconds} seconds one by one, beyond chance ({level:.2f}): {', '.join(told)}."


def _dominating(result, measure):
    level = float(result[f"{measure}_chance"])
    strength = strength_of(result, measure)
    order = np.argsort(-strength, kind="stable")
    first = with_interval(result, measure, order[0])
    named = ", then ".join(
        with_interval(result, measure, place) for place in order if strength[place] > level
    )
    if measure == "first_order":
        if named:
            return f"Shown to explain some of that by itself: {named}; chance reaches {level:.2f}."
        return (
            f"No variable is shown to explain any of that by itself: the largest share, {first}, is within "
            f"{level:.2f}, the level of chance."
        )
    if named:
        return f"The peak follows {named} (partial rank correlation; chance reaches {level:.2f})."
    return (
        f"No variable is shown to steer the peak: the largest partial rank correlation, {first}, is within "
        f"{level:.2f}, the level of chance."
    )


def strength_of(result, measure):
    """What a variable is ranked by: its share, which is noise where negative, or the size of its correlation."""
    found = result[measure].to_numpy()
    return found if measure == "first_order" else np.abs(found)


def with_interval(result, measure, place):
    """One variable, marked if it is a control, with its measure and interval."""
    low, high = (float(result[f"{measure}_interval"].sel(bound=one)[place]) for one in ("lower", "upper"))
    name = parameter_label(str(result["parameter"].values[place]))
    unused = ", a control" if int(result["control"][place]) else ""
    return f"{name}{unused} {float(result[measure][place]):.2f} [{low:.2f}, {high:.2f}]"
