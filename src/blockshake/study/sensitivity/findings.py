"""Findings of a sensitivity study, and the words for them: spreads within the noise, and variables beyond chance."""

from typing import NamedTuple

import numpy as np

from blockshake.pages.rows import bodies_by_height, face_markers
from blockshake.pages.wording import listed, millimetres, model_label, parameter_label, percent
from blockshake.pages.words import span, whole_percent
from blockshake.study.ensembles.envelope import STILL

SHARED = 0.05  # r squared of two variables beyond which they are said to share their indices
_MOST_NAMED = 3  # pairs of such variables
_WORDS = {
    "first_order": (
        "Shown to explain some of that by itself:", "No variable is shown to explain any of that by itself", "share",
    ),
    "rank_correlation": (
        "By partial rank correlation the peak follows", "No variable is shown to steer the peak",
        "partial rank correlation",
    ),
}  # fmt: skip


class Influence(NamedTuple):
    """One variable's measure with its 95 % interval [1]."""

    parameter: str  # dotted name
    control: bool  # model or structure has no use for the variable
    value: float
    lower: float
    upper: float
    beyond_chance: bool  # the measure is larger than the level of chance of all variables and markers


def differs(result, noise):
    """Whether samples of a `sensitivity` differ by at least a marker's noise [m], a standard deviation.

    At any marker and for any quantity; false where the spread is not known.
    """
    return bool((result["spread"] >= noise).any())


def is_known(result, measure):
    """Whether the samples of one quantity suffice for a measure and its level of chance."""
    return bool(np.isfinite(result[f"{measure}_chance"]))


def influences(result, measure):
    """List of `Influence` of a `sensitivity`, the strongest first, at one marker and for one quantity that is known.

    ``first_order``, ranked by the share, which is noise where negative; or ``rank_correlation``, by its magnitude.
    """
    chance, values = float(result[f"{measure}_chance"]), result[measure].to_numpy()
    strength = values if measure == "first_order" else np.abs(values)
    lower, upper = (result[f"{measure}_interval"].sel(bound=one).to_numpy() for one in ("lower", "upper"))
    order = np.argsort(-strength, kind="stable")
    names, controls = result["parameter"].values, result["control"].values
    return [
        Influence(
            str(names[index]), bool(controls[index]), *map(float, (values[index], lower[index], upper[index])),
            bool(strength[index] > chance),
        )
        for index in order
    ]  # fmt: skip


def shared_words(result):
    """Which variables of a `sensitivity` share their indices, since they are correlated among its samples."""
    known, names = result["correlation"].to_numpy(), result["parameter"].values
    if not np.isfinite(known).all():
        return "too few completed samples for an index"
    pairs = [*zip(*np.triu_indices(len(names), 1), strict=True)]
    shared = sorted((pair for pair in pairs if known[pair] ** 2 > SHARED), key=lambda pair: -abs(known[pair]))
    if not shared:
        return f"no two variables have r squared beyond {SHARED}"
    named = "; ".join(
        f"{parameter_label(names[one])} and {parameter_label(names[other])}, r {known[one, other]:.2f}"
        for one, other in shared[:_MOST_NAMED]
    )
    return f"{len(shared)} of {len(pairs)} pairs of variables share their indices, r squared beyond {SHARED}: {named}"


def quiet_markers(result, markers, noise):
    """Number of markers of a `sensitivity` whose histories differ by less than the noise [m].

    Markers without a known spread do not count.
    """
    return int((result["spread"].sel(quantity="history", marker=list(markers)) < noise).sum())


def markers_by_height(case):
    """Three bodies at most that stand for the heights of a structure, with their markers, from the lowest up."""
    markers = face_markers(case.structure)
    return {body: markers[body] for body in bodies_by_height(case.structure, markers, most=3)}


def sentence(result, body, marker):
    """Spread of a block, and the variables that explain it beyond chance, in sentences.

    ``result`` from `sensitivity`, of samples that differ.
    """
    history = result.sel(quantity="history", marker=marker)
    thick = f"the samples of {body} differ by {millimetres(history['spread'])} mm"
    words = f"{thick} (standard deviation over samples and time). {_found(history, 'first_order')}"
    peak = result.sel(quantity="peak", marker=marker)
    if not is_known(peak, "rank_correlation"):
        return (
            f"{words} {int(peak['used'])} samples are too few for partial correlations of so many variables."
        )
    explained = float(peak["explained"])
    share = f"{percent(explained)} %" if explained > 0.0 else "nothing"
    return (
        f"{words} {_found(peak, 'rank_correlation')} All variables together explain {share} of the ranks of the peak "
        f"(adjusted R\N{SUPERSCRIPT TWO} {explained:.2f})."
    )


def _found(result, measure):
    """Variables whose measure is beyond chance, or the largest measure where there is none, in a sentence."""
    ranked, (shown, hidden, noun) = influences(result, measure), _WORDS[measure]
    chance = f"{float(result[f'{measure}_chance']):.2f}"
    if named := ", then ".join(influence_words(one) for one in ranked if one.beyond_chance):
        return f"{shown} {named}; level of chance {chance}."
    return f"{hidden}: the largest {noun}, {influence_words(ranked[0])}, is within the level of chance, {chance}."


def influence_words(one):
    """One variable, marked if it is a control, with its measure and, where the samples suffice for one, interval."""
    control = ", a control" if one.control else ""
    limits = f" [{one.lower:.2f}, {one.upper:.2f}]" if np.isfinite([one.lower, one.upper]).all() else ""
    return f"{parameter_label(one.parameter)}{control} {one.value:.2f}{limits}"


def explained_by_motion(case):
    """Share of the spread of the largest displacement that record and level explain, by model [1].

    Adjusted R squared, in cases whose samples draw motions, of the logarithm of the demand on level and record, or on
    the logarithm of the intensity where there are no levels. Models with too few samples are left out.
    """
    shares = {}
    for model, one in case.responses.items():
        cloud = one.cloud
        if cloud is None or not case.levels:
            continue
        demand = np.log(np.maximum(cloud["demand"].to_numpy(), STILL) / cloud["largest_drift"].to_numpy())
        groups = [
            cloud["record"].values.astype(str),
            np.array([case.levels[int(sample)] for sample in cloud["sample"].values]),
        ]
        columns = [np.ones(len(demand))]
        columns += [(group == value) + 0.0 for group in groups for value in np.unique(group)[1:]]
        design = np.array(columns).T
        freedom, total = len(demand) - design.shape[1], float(((demand - demand.mean()) ** 2).sum())
        if freedom < 3 or total == 0.0:
            continue
        left = demand - design @ np.linalg.lstsq(design, demand, rcond=None)[0]
        shares[model] = max(0.0, 1.0 - float(left @ left) / freedom / (total / (len(demand) - 1)))
    return shares


def motion_sentences(content):
    """Share that record and level explain, a sentence for cases alike whose samples are scaled to levels of records."""
    alike = {}
    for name, case in content.cases.items():
        if shares := explained_by_motion(case):
            known = span(shares.values(), whole_percent)
            alike.setdefault((known, listed([*map(model_label, shares)])), []).append(name)
    for (known, models), names in alike.items():
        yield (
            f"{listed(names)}: record and level explain {known} % of the spread of the largest displacement "
            f"({models}). The sampled properties explain at most the rest."
        )
