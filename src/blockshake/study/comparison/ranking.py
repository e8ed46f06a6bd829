"""The paper's ranking of its three behaviours of blocks, held against the scores of the models."""

from typing import NamedTuple

import numpy as np

RIGID, ELASTIC, VISCOELASTIC = "nscd-rigid", "nscd-elastic", "nscd-viscoelastic"
MET, NOT_MET, OPEN = "met", "not met", "cannot be judged"
FEWEST_JUDGED = (
    6  # samples; order statistics reach 95 % with so many, and a bootstrap of fewer holds far less
)
_ALL = tuple(f"configuration-{place}" for place in (1, 2, 3, 4))


class Claim(NamedTuple):
    """A statement of Zhou et al. (2023) on the behaviours.

    Attributes
    ----------
    words : str
    orders : tuple of (str, str, str)
        Case, model that is to be the better one, and model that is to be the worse one.
    """

    words: str
    orders: tuple


CLAIMS = (
    Claim(
        "the viscoelastic model describes all four configurations best",
        tuple((case, VISCOELASTIC, other) for case in _ALL for other in (RIGID, ELASTIC)),
    ),
    Claim(
        "the elastic model is poor for configurations 3 and 4, here taken as worse than the two others",
        tuple((case, other, ELASTIC) for case in _ALL[2:] for other in (RIGID, VISCOELASTIC)),
    ),
)


class Judgement(NamedTuple):
    """A claim against the scores.

    Attributes
    ----------
    claim : Claim
    answer : str
        `MET`, `NOT_MET` or `OPEN`; open wherever a test is synthetic.
    by_scores : str
        The same by the scores alone, whatever the tests are.
    borne_out, contradicted, untold, unknown : int
        Orders of the claim whose models the scores tell apart as it says, the other way round, or not; and those
        of a model with fewer than `FEWEST_JUDGED` samples, or of a case that is not there.
    synthetic : bool
        A test is synthetic.
    """

    claim: Claim
    answer: str
    by_scores: str
    borne_out: int
    contradicted: int
    untold: int
    unknown: int
    synthetic: bool


def judge(claim, comparisons):
    """`Judgement` of a `Claim`: met if every order is borne out, not met if any is contradicted.

    Parameters
    ----------
    claim : Claim
    comparisons : dict of str to xarray.Dataset
        From `compare_models`, by case.

    Notes
    -----
    The better model has the lower score; two models are told apart where the interval of the difference of their
    scores holds no zero. A synthetic test comes from a model of this program: a score then tells which model is nearest
    to that one, and nothing of real blocks.
    """
    counts = {"borne_out": 0, "contradicted": 0, "untold": 0, "unknown": 0}
    for case, better, worse in claim.orders:
        counts[_told(comparisons.get(case), better, worse)] += 1
    by_scores = OPEN
    if counts["contradicted"]:
        by_scores = NOT_MET
    elif counts["borne_out"] == len(claim.orders):
        by_scores = MET
    synthetic = any(one.attrs["synthetic"] for one in comparisons.values())
    return Judgement(claim, OPEN if synthetic else by_scores, by_scores, **counts, synthetic=synthetic)


def _told(comparison, better, worse):
    """Name of the count that an order of two models goes to."""
    if comparison is None or not {better, worse} <= set(comparison["model"].values):
        return "unknown"
    if (comparison["counted"].sel(model=[better, worse]) < FEWEST_JUDGED).any():
        return "unknown"
    at = comparison["score_difference_interval"].sel(model=better, other=worse)
    lower, upper = (float(at.sel(bound=one)) for one in ("lower", "upper"))
    if not np.isfinite(lower):
        return "unknown"
    return "borne_out" if lower > 0.0 else "contradicted" if upper < 0.0 else "untold"
