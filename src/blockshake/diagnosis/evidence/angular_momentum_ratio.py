"""Share of the spin that impacts keep: what the tests say, and the evidence that less is lost than any model loses."""

from typing import NamedTuple

import numpy as np
from scipy.special import logsumexp, ndtr

from blockshake.forces.seen.impacts import find_impacts

# Losses over Housner's: flat elastic faces lose least (nodes 0.05 m apart, restitution 0.5), edges and grains most
_LEAST_LOST, _MOST_LOST, _LOSS_ERROR = 0.41, 1.1, 0.03
_OF_ONE, _OF_STACKS = 0.01, 0.03  # of the share kept: errors of the loss's law, of single blocks and stacks
_SCATTERS = np.array([0.0, 0.01, 0.02, 0.04, 0.08, 0.16])  # of single impacts, beyond their errors
# share of impacts that something else strikes; standard deviation of the share they keep
_STRAY, _STRAYS = 0.05, 0.5
_ANYTHING = 1e-6  # probability of a share that no impact explains
_SHARES = np.linspace(-1.0, 2.0, 6001)
_TELLING = 8.0  # nats by which nothing lost would have to stand out, where a verdict is possible
_TAILS = 0.05, 0.5, 0.95


class SpinKept(NamedTuple):
    """Share of the spin that the impacts of a campaign keep."""

    # logarithm of the evidence that less is lost than in any undamaged model, over that of none; 0 without
    # impacts
    gain: float
    estimate: float  # mean share of the spin kept [1]; NaN without impacts
    interval: tuple  # of float; its 90 % interval
    statement: str


def restitution_gain(seen_tests):
    """`SpinKept` of a campaign, by its list of `ReconstructedTest`.

    Notes
    -----
    With Housner's share r of an impact, the loss over Housner's is ``(1 - kept) / (1 - r)``: 1 for blocks on two rigid
    edges (Housner 1963) and for contact dynamics, 0.5 for flat faces on springs, more than 1 in some tests on concrete
    (ElGawady et al. 2011), less where uneven faces meet in consecutive impacts (Ther and Kollar 2017). All of these are
    nominal: no cause is a uniform prior of the loss over that range, the effect one from there down to no loss. Bounces
    at the other edge (Lipscombe and Pellegrino 1993) change no angular momentum about it.
    """
    impacts = [impact for seen in seen_tests for impact in find_impacts(seen)]
    changes = [impact for impact in impacts if not impact.returned]
    back = len(impacts) - len(changes)
    again = f"; {back} more returned to the same edge" if back else ""
    if not changes:
        return SpinKept(0.0, np.nan, (np.nan, np.nan), f"no impact tells of restitution{again}")
    plastic = float(np.median([change.plastic for change in changes]))
    # impacts of other joints are brought to the same range from plastic to nothing lost
    scale = [(1.0 - plastic) / (1.0 - change.plastic) for change in changes]
    kept = np.array([1.0 - by * (1.0 - change.kept) for by, change in zip(scale, changes, strict=True)])
    error = np.array([by * change.error for by, change in zip(scale, changes, strict=True)])
    law = _OF_ONE if all(change.blocks == 1 for change in changes) else _OF_STACKS
    logs = _log_likelihood(kept, error)
    weights = np.exp(logs - logsumexp(logs))
    lower, middle, upper = (float(value) for value in np.interp(_TAILS, np.cumsum(weights), _SHARES))
    nothing_lost = np.where(np.isclose(_SHARES, 1.0), 0.0, -np.inf)
    unsure = f"; no verdict: undamaged models differ by as much as that from 1{again}"
    verdict = again if _gain(nothing_lost, plastic, law) > _TELLING else unsure
    statement = (
        f"{len(changes)} impacts kept {middle:.3f} +- {0.5 * (upper - lower):.3f} of the spin (90 %), "
        f"Housner's plastic {plastic:.3f}{verdict}"
    )
    return SpinKept(_gain(logs, plastic, law), middle, (lower, upper), statement)


def _log_likelihood(kept, error):
    """Logarithm of the likelihood of every mean share, (n_shares,), averaged over the scatter of single impacts."""
    logs = []
    for scatter in _SCATTERS:
        spread = np.hypot(error, scatter)
        off = (kept - _SHARES[:, None]) / spread
        regular = np.log(1.0 - _STRAY) - 0.5 * off**2 - np.log(spread)
        wide = np.hypot(spread, _STRAYS)
        stray = np.log(_STRAY) - 0.5 * ((kept - _SHARES[:, None]) / wide) ** 2 - np.log(wide)
        logs.append(np.logaddexp(regular, stray).sum(axis=1))
    return logsumexp(logs, axis=0) - np.log(len(logs))


def _gain(logs, plastic, law):
    """Logarithm of the evidence of the effect over that of no cause."""
    loss, spread = (1.0 - _SHARES) / (1.0 - plastic), np.hypot(_LOSS_ERROR, law / (1.0 - plastic))
    evidence = []
    for least, most in ((0.0, _LEAST_LOST), (_LEAST_LOST, _MOST_LOST)):
        density = (ndtr((loss - least) / spread) - ndtr((loss - most) / spread)) / (most - least)
        evidence.append(logsumexp(logs + np.log((1.0 - _ANYTHING) * density + _ANYTHING)))
    return float(evidence[0] - evidence[1])
