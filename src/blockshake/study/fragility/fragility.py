"""Probability of a potential collapse by level, and the lognormal fragility through it, with their limits."""

import numpy as np
import xarray as xr

from blockshake.statistics.intervals import CONFIDENCE, share_interval
from blockshake.store import load_made
from blockshake.study.ensembles.ensemble import describe
from blockshake.study.ensembles.envelope import BOUNDS, QUANTILES, over_samples
from blockshake.study.fragility.capacity import estimate_capacity

SAFE = 0.05  # probability of a potential collapse that a safe level may have
POINTS = 101  # of the curve
ESTIMATES = {
    "median": lambda fragility, fine: fragility.median,
    "dispersion": lambda fragility, fine: fragility.dispersion,
    "safe": lambda fragility, fine: fragility.level(SAFE),
    "curve": lambda fragility, fine: fragility.probability(fine),
}
"""Estimates of a fragility with their limits: functions of it, and of levels."""
_DESCRIBED = {
    "known": ("samples of which it is known whether they pass this scale", "1"),
    "share": ("share of these that do not pass it, or did not pass a lower one", "1"),
    "drift_ratio": (
        "largest displacement of a block from the slab over its limit, samples that climbed",
        "1",
    ),
    "fine_scale": ("factor of the motion", "1"),
    "curve": ("probability of a capacity below that factor, lognormal", "1"),
    "median": ("median capacity, factor of the motion", "1"),
    "dispersion": ("standard deviation of the logarithm of the capacity", "1"),
    "safe_scale": (f"factor that {100.0 * SAFE:g} % of the capacities are below", "1"),
}


def fragility_of_case(batches):
    """`fragility` of samples from the files of their climbs."""
    climbed = [load_made(batch) for batch in batches]
    joined = xr.concat(climbed, dim="sample", data_vars="minimal", coords="minimal", combine_attrs="override")
    return fragility(joined)


def fragility(climbed):
    """Probability of a potential collapse at the levels of `climb_samples`, and a lognormal curve through them.

    Parameters
    ----------
    climbed : xarray.Dataset
        From `climb_samples`.

    Returns
    -------
    xarray.Dataset
        ``climbed``'s variables but ``drift_ratio``, and: ``known(scale)``; ``share(scale)`` with
        ``share_interval(bound, scale)``; ``drift_ratio(quantile, scale)``; ``median``, ``dispersion`` and
        ``safe_scale``, the factor that 5 % of the capacities are below, each with its ``_interval(bound)``;
        ``curve(fine_scale)`` with ``curve_interval(bound, fine_scale)``. NaN where the samples bound the capacity on
        one side alone.

    Notes
    -----
    Limits of 95 %, of `likely_capacities`, NaN where the samples bear none; samples are taken as independent. A
    sample whose run ended for a numerical reason is known at the levels below; above them the limits of the share hold
    either outcome. The spread is that of the sampled
    variables under one motion: another motion has another fragility.
    """
    lower, upper = climbed["capacity_lower"].to_numpy(), climbed["capacity_upper"].to_numpy()
    scales = climbed["scale"].to_numpy()
    failed = (upper[:, None] <= scales + 1e-9).sum(axis=0)
    known = failed + (lower[:, None] >= scales - 1e-9).sum(axis=0)
    numbers = zip(failed, known, len(lower) - known, strict=True)
    limits = np.array([share_interval(*map(int, one)) for one in numbers])
    fine = np.linspace(scales[0], scales[-1], POINTS)
    fitted, likely, limits_over = estimate_capacity(lower, upper)
    result = climbed.drop_vars("drift_ratio").assign(
        known=("scale", known),
        share=("scale", np.divide(failed, known, out=np.full(len(scales), np.nan), where=known > 0)),
        share_interval=(("bound", "scale"), limits.T),
        drift_ratio=over_samples(climbed["drift_ratio"], xr.DataArray(list(QUANTILES), dims="quantile")),
    )
    for name, of in ESTIMATES.items():
        dims = ("fine_scale",) if name == "curve" else ()
        value, name = of(fitted, fine), "safe_scale" if name == "safe" else name
        if name == "curve" and not fitted.dispersion > 0.0:
            value = np.full(POINTS, np.nan)
        result[name] = dims, value
        result[f"{name}_interval"] = ("bound", *dims), limits_over(of(likely, fine[:, None]))
    result = result.assign_coords(bound=list(BOUNDS), quantile=list(QUANTILES), fine_scale=fine)
    describe(result, _DESCRIBED)
    result.attrs |= {"title": "fragility of a structure under one motion", "confidence": CONFIDENCE}
    return result
