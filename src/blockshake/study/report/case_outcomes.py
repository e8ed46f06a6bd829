"""How the samples of every case and level ended by every model, and which of these are the best evidence."""

from typing import NamedTuple

import numpy as np

from blockshake.measurement.motion.joints import find_joints, find_leaves
from blockshake.pages.rows import face_markers
from blockshake.statistics.intervals import SURE_FROM, share_interval
from blockshake.study.ensembles.envelope import counted_samples, is_moving
from blockshake.study.ensembles.outcomes import count_outcomes

_AS_MANY = 0.9  # of the runs of the model that has most, from which on another one's are as good evidence


class Outcome(NamedTuple):
    """How the samples of a case, or of one of its levels, ended by a model."""

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
    # margin, least_margin: least margin against overturning of any joint of a sample [1], median and least of
    # the samples; NaN where no joint has one
    margin: float
    least_margin: float
    over: str  # the joint of the least margin of all
    leaves: dict  # str to float; the median margin of every leaf of `find_leaves` [1]
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

    @property
    def is_sure(self):
        """Whether there are enough samples for limits of a median; fewer are reported as runs."""
        return self.counted >= SURE_FROM


def outcomes(stripe):
    """`Outcome` of a `Stripe` by model, of models with a sample that counts."""
    return {
        model: _outcome(stripe.case.structure, one)
        for model, one in stripe.responses.items()
        if int(one.envelope.attrs["counted"])
    }


def _outcome(structure, response):
    ended, blocks = count_outcomes(response.samples["status"]), face_markers(structure)
    at = response.envelope.sel(frame="slab", quantile=0.5, marker=list(blocks.values()))
    farthest = int(at["peak"].argmax("marker"))
    block, marker = list(blocks.items())[farthest]
    counted = counted_samples(response.samples)
    peaks = counted["peak"].sel(frame="slab", marker=marker)
    margins = counted["joint_margin"].dropna("joint", how="all")
    upper, every = find_joints(structure)[0][:, 1], at["joint_margin"].to_numpy()
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
        margin=float(margins.min("joint").median()) if margins.size else np.nan,
        least_margin=float(margins.min()) if margins.size else np.nan,
        over=str(margins["joint"].values[int(margins.min("sample").argmin("joint"))]) if margins.size else "",
        leaves={
            name: float(np.min(every[np.isin(upper, leaf) & np.isfinite(every)], initial=np.inf))
            for name, leaf in find_leaves(structure).items()
        },
        struck=int((blows > 0).sum()),
        blows=int(blows.max()),
        blow=float(velocity.max()),
        pair=str(counted["blow_pair"].values[velocity.argmax()]),
    )


def evidence(ended):
    """Outcomes that bear limits with about the most samples; all where none bears limits."""
    most = max(one.counted for one in ended.values())
    return {
        model: one
        for model, one in ended.items()
        if most < SURE_FROM or (one.is_sure and one.counted >= _AS_MANY * most)
    }


def most_telling(found):
    """Name of the stripe of the least margin, of those in which most samples stand by every model, if any do.

    ``found``: `Outcome` by model, by name of the stripe.
    """

    def nearness(name):
        ended = evidence(found[name]).values()
        margin = min((one.margin for one in ended if np.isfinite(one.margin)), default=1.0)
        return max(one.share for one in ended) >= 0.5, margin, -max(one.peak for one in ended)

    return min(found, key=nearness)
