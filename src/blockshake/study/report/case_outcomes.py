"""How the samples of every case ended by every model, and where two models differ most."""

from itertools import combinations
from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.measurement.motion.joints import find_joints, find_leaves
from blockshake.pages.rows import face_markers
from blockshake.simulation.rocking import plastic_shares
from blockshake.statistics.intervals import SURE_FROM, share_interval
from blockshake.study.ensembles.envelope import STILL, counted_samples, is_moving
from blockshake.study.ensembles.outcomes import count_outcomes

_FARTHER = 1.25  # times, from which on medians without limits count as different


class Outcome(NamedTuple):
    """How the samples of a case by a model ended."""

    # collapsed, falling, counted, failed: samples that collapsed or still fell, those of them that still
    # fell, of those that count; and failed ones, which do not
    collapsed: int
    falling: int
    counted: int
    failed: int
    # block, marker: the block that moves farthest, of those with markers
    block: str
    marker: str
    # peak, least, most, end: its largest displacement along x from its place on the slab: median, smallest
    # and largest of the samples, and the median of what is left at the end [m], NaN where the block still
    # moves then (`is_moving`)
    peak: float
    least: float
    most: float
    end: float
    margin: float  # smallest median margin against overturning of any joint [1]; NaN where no joint has one
    over: str  # the joint
    leaves: dict  # str to float; the same of every leaf of `find_leaves` [1]
    # struck, blows: samples with blows of `pounding`, and the most in a sample
    struck: int
    blows: int
    # blow, pair: float, str; velocity of the fastest of all [m/s], and its blocks
    blow: float
    pair: str

    @property
    def share(self):
        """Share of the samples that collapsed [1]."""
        return self.collapsed / self.counted

    @property
    def limits(self):
        """Interval of 95 % of the probability of a collapse [1], see `share_interval`."""
        return share_interval(self.collapsed, self.counted, self.failed)


class Apart(NamedTuple):
    """Two models of a case that differ: name of the case, the model of the smaller response, and the other.

    ``falls``: difference of the shares that collapse [1]; ``times``: ratio of the median peaks [1].
    """

    falls: float
    times: float
    case: str
    near: str
    far: str


def outcomes(case):
    """`Outcome` of a case by model, of models with a sample that counts."""
    return {
        model: _outcome(case, one)
        for model, one in case.responses.items()
        if int(one.envelope.attrs["counted"])
    }


def _outcome(case, response):
    ended, blocks = count_outcomes(response.samples["status"]), face_markers(case.structure)
    at = response.envelope.sel(frame="slab", quantile=0.5, marker=list(blocks.values()))
    farthest = int(at["peak"].argmax("marker"))
    block, marker = list(blocks.items())[farthest]
    counted = counted_samples(response.samples)
    peaks = counted["peak"].sel(frame="slab", marker=marker)
    margins = at["joint_margin"].dropna("joint")
    least = int(margins.argmin("joint")) if margins.size else None
    upper, every = find_joints(case.structure)[0][:, 1], at["joint_margin"].to_numpy()
    blows, velocity = counted["blows"].to_numpy(), counted["blow_velocity"].to_numpy()
    return Outcome(
        collapsed=ended.collapsed + ended.falling,
        falling=ended.falling,
        counted=ended.counted,
        failed=ended.failed,
        block=block,
        marker=marker,
        peak=float(at["peak"][farthest]),
        least=float(peaks.min()),
        most=float(peaks.max()),
        end=np.nan if is_moving(response.envelope, marker) else abs(float(at["residual"][farthest])),
        margin=np.nan if least is None else float(margins[least]),
        over="" if least is None else str(margins["joint"].values[least]),
        leaves={
            name: float(np.min(every[np.isin(upper, leaf) & np.isfinite(every)], initial=np.inf))
            for name, leaf in find_leaves(case.structure).items()
        },
        struck=int((blows > 0).sum()),
        blows=int(blows.max()),
        blow=float(velocity.max()),
        pair=str(counted["blow_pair"].values[velocity.argmax()]),
    )


def most_telling(found):
    """Name of the case of the least margin, of those in which most samples stand by every model, if any do.

    ``found``: `Outcome` by model, by name of the case.
    """

    def nearness(name):
        ended = found[name].values()
        margin = min((one.margin for one in ended if np.isfinite(one.margin)), default=1.0)
        return max(one.share for one in ended) >= 0.5, margin, -max(one.peak for one in ended)

    return min(found, key=nearness)


def models_apart(case, ended):
    """`Apart` of each two models of which one collapses more often, or whose median peaks differ by their limits.

    ``ended``: `outcomes` of the case. Of few samples, which bear no limits, medians differ from 1.25 times on.
    """
    apart = []
    for pair in combinations(ended, 2):
        near, far = sorted(pair, key=lambda model: (ended[model].share, ended[model].peak))
        falls = ended[far].share - ended[near].share
        low, high = sorted((ended[near].peak, ended[far].peak))
        times = high / max(low, STILL)
        limits = [
            case.responses[model]
            .envelope["peak_interval"]
            .sel(frame="slab", marker=ended[model].marker, quantile=0.5)
            for model in pair
        ]
        sure = min(ended[model].counted for model in pair) >= SURE_FROM
        gap = max(float(one.min()) for one in limits) - min(float(one.max()) for one in limits)
        if falls or (high >= STILL and (gap > 0.0 if sure else times > _FARTHER)):
            apart.append(Apart(falls, times, case.name, near, far))
    return apart


def shares_at_impacts(case, models):
    """Joint that opens most of those whose impacts are known by both models, the share of the spin that each model's
    impacts keep there, and that of `plastic_shares` [1]; None where there is no such joint."""
    medians = [case.responses[model].envelope.sel(quantile=0.5) for model in models]
    kept = [at["joint_spin_kept"] for at in medians]
    plastic = xr.DataArray(plastic_shares(case.structure), {"joint": kept[0]["joint"]})
    told = kept[0].notnull() & kept[1].notnull() & (plastic > 0.0)
    lifted = sum(at["joint_uplift"] for at in medians).where(told).dropna("joint")
    if not lifted.size:
        return None
    joint = str(lifted["joint"].values[lifted.to_numpy().argmax()])
    return joint, [float(one.sel(joint=joint)) for one in (*kept, plastic)]
