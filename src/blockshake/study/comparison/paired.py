"""Two models sample by sample: where they differ by more than chance, and which of them theory bears out."""

from itertools import combinations
from typing import NamedTuple

import numpy as np
import scipy
import xarray as xr

from blockshake.dynamics.system import FALLEN
from blockshake.measurement.motion.joints import find_joints
from blockshake.simulation.rocking import plastic_shares
from blockshake.statistics.intervals import CONFIDENCE, SURE_FROM
from blockshake.study.ensembles.envelope import STILL, counted_samples

_FARTHER = 1.1  # ratio of the displacements of one sample by two models, from which on it matters
ALIKE = 0.05  # of shares of the spin that impacts keep
_FALLEN = 1e6  # m, of a sample that collapsed: farther than any displacement
_AS_ONE = 0.2  # uplift of every other joint over that of the lowest, up to which all above it turns as one


class Apart(NamedTuple):
    """Two models that differ in a case or a level by more than chance: the one of the smaller response, and the other.

    A sample by one model is held against the same sample by the other.
    """

    stripe: str
    near: str
    far: str
    farther: int  # samples that go farther by ``far``: a collapse is farther than any displacement
    pairs: int  # samples that both models ran
    times: float  # ratio of the median displacements [1]
    falls: int  # collapses by ``far`` more than by ``near``, of these samples


class Theory(NamedTuple):
    """Reason of the difference of two models, as far as their runs show it."""

    rocks: bool  # the joint that opens most opens by more than any slips
    as_one: bool  # all above the joint turns as one body, as Housner's theory has it
    joint: str
    uplift: float  # largest uplift of a joint, median of the samples, by the model that moves farther [m]
    slip: float  # largest slip likewise [m]
    kept: dict  # str to float; share of the spin that impacts at the joint keep, by model; may be empty
    housner: float  # share that theory keeps there; NaN where the joint's lower body is not the slab [1]
    borne_out: str | None  # the model whose share is theory's, where only one is and the theory holds


def models_apart(stripes, found):
    """Which models differ in which stripes, and in which the samples of two models were enough to see it.

    Parameters
    ----------
    stripes : list of Stripe
    found : dict of str to dict
        `outcomes` by the name of the stripe.

    Returns
    -------
    apart : list of Apart
        The largest difference first.
    tried : list of str
        Names of the stripes with two models that can be distinguished.

    Notes
    -----
    Two models run the same samples. Exact sign test over the samples that both ran, and that differ by more than a
    marker's noise: at a level of 5 % over all pairs of models and stripes together (Holm 1979). Differences below a
    tenth of the displacement do not count, however sure they are.
    """
    pairs = ((stripe, pair) for stripe in stripes for pair in combinations(found.get(stripe.name, ()), 2))
    held = filter(None, (_held(stripe, found[stripe.name], pair) for stripe, pair in pairs))
    held = sorted(held, key=lambda item: item[0])
    apart = []
    for place, (probability, one) in enumerate(held):
        if probability > (1.0 - CONFIDENCE) / (len(held) - place):
            break
        if one.falls or one.times >= _FARTHER:
            apart.append(one)
    tried = list(dict.fromkeys(one.stripe for _, one in held))
    return sorted(apart, key=lambda one: (-one.falls, -one.times)), tried


def _held(stripe, ended, pair):
    """Probability of such a difference by chance, and the `Apart` it would be; None of fewer than six samples."""
    samples = [counted_samples(stripe.responses[model].samples) for model in pair]
    both = np.intersect1d(*(one["sample"].values for one in samples))
    if len(both) < SURE_FROM:
        return None
    marker = max((ended[model] for model in pair), key=lambda one: one.peak).marker
    of_both = [one.sel(sample=both) for one in samples]
    fell = np.array([np.isin(one["status"].values, FALLEN) for one in of_both])
    peaks = np.array([one["peak"].sel(frame="slab", marker=marker).to_numpy() for one in of_both])
    reached = np.where(fell, _FALLEN, peaks)
    least = max(stripe.case.marker_noise, STILL)
    differ = np.abs(reached[1] - reached[0]) > least
    first = int((differ & (reached[0] > reached[1])).sum())
    total = int(differ.sum())
    near, far = (1, 0) if 2 * first > total else (0, 1)
    probability = scipy.stats.binomtest(first, total).pvalue if total else 1.0
    low, high = np.median(peaks[near]), np.median(peaks[far])
    return probability, Apart(
        stripe=stripe.name,
        near=pair[near],
        far=pair[far],
        farther=max(first, total - first),
        pairs=len(both),
        times=float(high / max(low, STILL)),
        falls=int(fell[far].sum() - fell[near].sum()),
    )


def theory_of(stripe, apart):
    """`Theory` of two models that are `Apart` in a stripe.

    Notes
    -----
    Housner (1963): a rigid block on a fixed base keeps `plastic_shares` of its spin at an impact. A joint between
    blocks that both move has no such share, so that joints on the slab alone are held against it.
    """
    structure, models = stripe.case.structure, (apart.near, apart.far)
    medians = {model: stripe.responses[model].envelope.sel(quantile=0.5) for model in models}
    far = medians[apart.far]
    uplift, slip = (float(far[name].max()) for name in ("joint_uplift", "joint_slip"))
    opened = np.nan_to_num([at["joint_uplift"].to_numpy() for at in medians.values()])
    shares = xr.DataArray(plastic_shares(structure), {"joint": far["joint"]})
    known = [at["joint_spin_kept"].notnull().to_numpy() for at in medians.values()]
    known = (
        np.all(known, axis=0) & structure.driven[find_joints(structure)[0][:, 0]] & (shares.to_numpy() > 0.0)
    )
    at = int(np.where(known, opened.sum(axis=0), -1.0).argmax())
    kept, housner = {}, np.nan
    if known[at]:
        kept = {model: float(one["joint_spin_kept"][at]) for model, one in medians.items()}
        housner = float(shares[at])
    as_one = bool((np.delete(opened, at, axis=1) <= _AS_ONE * opened[:, [at]]).all())
    near = [model for model, one in kept.items() if abs(one - housner) < ALIKE]
    right = near[0] if len(near) == 1 and as_one and uplift > slip else None
    return Theory(uplift > slip, as_one, str(far["joint"].values[at]), uplift, slip, kept, housner, right)
