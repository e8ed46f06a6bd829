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
from blockshake.pages.words import Words
from blockshake.study.ensembles.drift_limits import limits_joints
from blockshake.study.fragility.figure import failed, measure_words, plot_clouds
from blockshake.study.fragility.fragility import SAFE

_CLOUD = Words(__name__)
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
    weighted = any(one.attrs["weight"] < 1.0 for one in clouds.values())
    return [
        Heading("Motions that the samples draw", "clouds"),
        Text(_CLOUD.method(limits, limits_joints(given), weighted)),
        *(_figure(name, clouds) for name in dict.fromkeys(name for name, _ in clouds)),
        _table(clouds),
    ]


def _figure(name, clouds):
    """Samples and fragilities of a case, a row a model."""
    return Figure(
        _CLOUD.figure(name, percent(SAFE)),
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
        _CLOUD.table(percent(SAFE), MISSING),
        ("Case", "Model", "Motions", "Not passed", "Method", "Intensity", "Median", "Dispersion", f"{percent(SAFE)} %"),
        tuple(rows), "llrrllrrr",
    )  # fmt: skip
