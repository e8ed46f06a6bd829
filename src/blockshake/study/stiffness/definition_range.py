"""Range of the contact stiffness over definitions of arrival and dampings, and its trace in a shaken stack."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.stats import kendalltau

_LEVEL = 0.05  # chance of a rank correlation as large at or below which a trend is shown


class Range(NamedTuple):
    """Smallest and largest of several values."""

    lowest: float
    highest: float


class Trend(NamedTuple):
    """Rank correlation of two quantities (Kendall 1938): tau [1], its chance ``p`` without any connection."""

    tau: float
    p: float

    @property
    def shown(self):
        """Whether chance reaches as much in at most 5 of 100 cases."""
        return bool(self.p <= _LEVEL)


class DefinitionRange(NamedTuple):
    """Consequences of the definition of arrival and of the damping.

    Attributes
    ----------
    at_own_damping : Range
        Normal stiffness over that of the study, over the definitions at the damping of the study [1].
    over_levels : Range
        The same over the levels of velocity and all dampings [1].
    top_peak : Range
        Peak of the highest block relative to the slab, over all runs [m].
    trend : Trend
        Of that peak with the normal stiffness.
    free_share : float
        Largest wave speed with rotations free over the shear wave speed of the material [1].
    free_factor : float
        Shear stiffness over that of the study up to which rotations were left free [1].
    """

    at_own_damping: Range
    over_levels: Range
    top_peak: Range
    trend: Trend
    free_share: float
    free_factor: float


def definition_range(definitions):
    """`DefinitionRange` of stiffness and peak over the definitions and dampings of `compare_definitions`."""
    own = {
        "definition": definitions.attrs["definition"],
        "restitution": definitions.attrs["study_restitution"],
    }
    normal = definitions["stiffness"].sel(direction="normal")
    ratio = normal / float(normal.sel(own))
    levels = [str(name) for name in definitions["definition"].values if str(name).endswith("%")]
    pairs = ("restitution", "definition")
    stiffness, peak = (
        values.transpose(*pairs).to_numpy().ravel() for values in (normal, definitions["top_peak"])
    )
    known = np.isfinite(stiffness) & np.isfinite(peak)
    found = kendalltau(stiffness[known], peak[known])
    target = float(definitions["target_wave_speed"].sel(direction="shear"))
    return DefinitionRange(
        at_own_damping=_range(ratio.sel(restitution=own["restitution"])),
        over_levels=_range(ratio.sel(definition=levels)),
        top_peak=_range(xr.concat([definitions["top_peak"], definitions["top_peak_same_damping"]], "run")),
        trend=Trend(float(found.statistic), float(found.pvalue)),
        free_share=float(definitions["free_speed"].max()) / target,
        free_factor=float(definitions["factor"].max()),
    )


def _range(values):
    return Range(float(values.min()), float(values.max()))
