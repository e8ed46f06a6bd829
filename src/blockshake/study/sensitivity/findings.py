"""Findings of a sensitivity study, and the words for them: spreads within the noise, and variables beyond chance."""

from typing import NamedTuple

import numpy as np

from blockshake.pages.rows import bodies_by_height, face_markers
from blockshake.pages.words import Words, span, whole_percent
from blockshake.study.ensembles.envelope import STILL

SHARED = 0.05  # r squared of two variables beyond which they are said to share their indices
_MOST_NAMED = 3  # pairs of such variables
_FOUND = Words(__name__)


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
    named = [(str(names[one]), str(names[other]), float(known[one, other])) for one, other in shared]
    return _FOUND.shared(bool(np.isfinite(known).all()), len(pairs), named, SHARED, _MOST_NAMED)


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
    history, peak = (result.sel(quantity=one, marker=marker) for one in ("history", "peak"))
    steered = ""
    if is_known(peak, "rank_correlation"):
        steered = _FOUND.steered(*_ranked(peak, "rank_correlation"), float(peak["explained"]))
    alone = _FOUND.alone(*_ranked(history, "first_order"))
    return _FOUND.spread(body, float(history["spread"]), alone, steered, int(peak["used"]))


def _ranked(result, measure):
    """`influences`, those of them beyond chance, and the level of chance."""
    ranked = influences(result, measure)
    return ranked, [one for one in ranked if one.beyond_chance], float(result[f"{measure}_chance"])


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
            alike.setdefault((known, *shares), []).append(name)
    for (known, *models), names in alike.items():
        yield _FOUND.motion(names, known, models)
