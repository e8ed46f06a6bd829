"""Blocks of the section on the fragility that tell of samples which draw their motions."""

import numpy as np

from blockshake.pages.blocks import Figure, Heading, Table, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import (
    MISSING,
    limited,
    millimetre_range,
    model_label,
    percent,
)
from blockshake.study.ensembles.drift_limits import limits_joints
from blockshake.study.fragility.figure import failed, measure_words, plot_clouds
from blockshake.study.fragility.fragility import SAFE

_METHODS = {"regression": "cloud (regression)", "counts": "counts (maximum likelihood)"}


def cloud_blocks(content):
    """Fragilities over the intensity of drawn motions; none where no case draws any."""
    clouds = {
        (name, model): one.cloud
        for name, case in content.cases.items()
        for model, one in case.responses.items()
        if one.cloud is not None
    }
    if not clouds:
        return []
    given = content.study["ladder"]["largest_drift"]
    limits = millimetre_range(np.hstack([one["largest_drift"] for one in clouds.values()]))
    words = (
        "Every sample is shaken once, by a motion of its own. It does not pass when it collapses, still falls as its "
        f"window ends, or a marker moves along x from the slab by more than the limit of its block, {limits} mm"
        f"{', or a joint slips by more than its own' if limits_joints(given) else ''}. The "
        "cloud is the regression of the logarithm of that displacement on the logarithm of the intensity, over the "
        "samples that stand and move, with a logistic regression of the falls (Jalayer and Cornell 2009). The counts "
        "are fitted by the lognormal curve of largest likelihood (Baker 2015, Eq. 11). The regression needs no "
        "sample that fails, and rests on its straight line; the counts need both outcomes, and rest on no "
        "displacement. The dispersion is the standard deviation of the logarithm of the intensity at which a sample "
        "fails, for the regression half the logarithm of the ratio of its 84 and 16 % intensities. It holds the "
        "scatter from motion to motion and that of the sampled variables."
    )
    if any(one.attrs["weight"] < 1.0 for one in clouds.values()):
        words += (
            " Samples that draw the same record at the same level count together as one in the limits here; the other "
            "sections take all samples as independent, so that their limits are too narrow where records repeat."
        )
    return [
        Heading("Motions that the samples draw", "clouds"),
        Text(words),
        *(_figure(name, clouds) for name in dict.fromkeys(name for name, _ in clouds)),
        _table(clouds),
    ]


def _figure(name, clouds):
    """Samples and fragilities of a case, a row a model."""
    return Figure(
        f"{name}. Left: largest displacement of a marker from the slab, as a share of its limit, over the intensity, "
        "and the regression; crosses: samples that fell, at the upper edge. Right: probability of not passing by both "
        "methods, with limits of 95 %; squares: share of the samples at a level that do not pass, with limits of "
        f"Clopper and Pearson. Dotted: {percent(SAFE)} %.",
        svg_of(
            plot_clouds, {model_label(model): one for (case, model), one in clouds.items() if case == name}
        ),
    )


def _table(clouds):
    rows = []
    for (name, model), cloud in clouds.items():
        drawn = str(cloud.attrs["records"]), f"{int(failed(cloud).sum())} of {cloud.sizes['sample']}"
        measure = "{} [{}]".format(*measure_words(cloud))
        for method, label in _METHODS.items():
            one = cloud.sel(fit=method)
            figures = [limited(one, what) for what in ("median", "dispersion", "safe")]
            rows.append((name, model_label(model), *drawn, label, measure, *figures))
    return Table(
        f"Fragilities: intensity at which half and {percent(SAFE)} % of the samples do not pass, and dispersion, with "
        "limits of 95 % in brackets: of the regression by its parameters' posterior, of the counts by likelihood. "
        f"{MISSING.capitalize()}: the samples do not tell.",
        ("Case", "Model", "Motions", "Not passed", "Method", "Intensity", "Median", "Dispersion", f"{percent(SAFE)} %"),
        tuple(rows), "llrrllrrr",
    )  # fmt: skip
