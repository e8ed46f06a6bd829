"""The paper's ranking of its behaviours of blocks, viscoelastic ones best, held against the scores of the models."""

from typing import NamedTuple

import numpy as np

from blockshake.statistics.intervals import SURE_FROM

RIGID, ELASTIC, VISCOELASTIC = "nscd-rigid", "nscd-elastic", "nscd-viscoelastic"
_CASES = tuple(f"configuration-{place}" for place in (1, 2, 3, 4))


class Ranking(NamedTuple):
    """Numbers of comparisons of the viscoelastic model with another one in the paper's configurations.

    Attributes
    ----------
    borne_out, contradicted, untold : int
        Its score is beyond the intervals the lower one, the higher one, or neither.
    unknown : int
        Of a model with fewer than `SURE_FROM` samples, or of a case that is not there.
    """

    borne_out: int
    contradicted: int
    untold: int
    unknown: int


def rank_viscoelastic(comparisons):
    """`Ranking` of the statement of Zhou et al. (2023) that viscoelastic blocks describe all configurations best.

    Parameters
    ----------
    comparisons : dict of str to xarray.Dataset
        From `compare_models`, by case.

    Notes
    -----
    The better model has the lower score; two models are told apart where the interval of the difference of their
    scores holds no zero.
    """
    sides = [_side(comparisons.get(case), other) for case in _CASES for other in (RIGID, ELASTIC)]
    return Ranking(*map(sides.count, Ranking._fields))


def _side(comparison, worse):
    """Name of the count that a comparison with a model that is to be the worse one goes to."""
    pair = [VISCOELASTIC, worse]
    if comparison is None or not set(pair) <= set(comparison["model"].values):
        return "unknown"
    if (comparison["counted"].sel(model=pair) < SURE_FROM).any():
        return "unknown"
    at = comparison["score_difference_interval"].sel(model=VISCOELASTIC, other=worse)
    lower, upper = (float(at.sel(bound=one)) for one in ("lower", "upper"))
    if not np.isfinite(lower):
        return "unknown"
    return "borne_out" if lower > 0.0 else "contradicted" if upper < 0.0 else "untold"
