"""Probabilities of collapse and of large drift, and quantiles of peaks and rotations, with their intervals."""

import numpy as np

from blockshake.report.document.blocks import Table
from blockshake.report.document.rows import face_markers
from blockshake.report.document.wording import MISSING, model_label, number, percent
from blockshake.study.ensembles.intervals import CONFIDENCE
from blockshake.study.ensembles.outcomes import shortfall

_SHOWN = (0.5, 0.95)


def probability_table(content):
    """Collapse, drift beyond the limit, peak and rotation of the top block, each with its 95 % interval."""
    rows = []
    for case in content.cases.values():
        body, marker = next(iter(face_markers(case.structure).items()))
        for model, response in case.responses.items():
            one = response.envelope
            counted, failed, *_ = shortfall(one)
            top = one.sel(marker=marker, body=body)
            rows.append((
                f"{case.name}, {marker}", model_label(model),
                f"{counted} + {failed} failed" if failed else str(counted),
                _with_limits(top, "collapse_probability", percent), _with_limits(top, "drift_probability", percent),
                *(_with_limits(top.sel(frame="slab", quantile=q), "peak", _thousandths) for q in _SHOWN),
                *(_with_limits(top.sel(quantile=q), "peak_rotation", _thousandths) for q in _SHOWN),
            ))  # fmt: skip
    limit = next(iter(next(iter(content.cases.values())).responses.values())).envelope["drift_probability"]
    shown = " and ".join(f"{100 * one:.0f} %" for one in _SHOWN)
    quantiles = [f"{100 * one:.0f} %" for one in _SHOWN]
    return Table(
        "Top block, at its marker: probability of collapse, and of a displacement relative to the slab of more than "
        f"{number(1e3 * limit.attrs['largest_drift'])} mm (a collapse counts as more), with Clopper-Pearson limits; "
        f"quantiles {shown} of peak displacement [mm] and peak rotation [mrad] over the n samples that completed or "
        "collapsed, with bootstrap limits, which cannot reach beyond the largest sample and hold the upper quantile "
        f"less often than stated. All limits are of {100 * CONFIDENCE:.0f} % and take samples as independent; "
        "collapsed samples count with the displacement that they had reached.",
        (
            "Case, marker", "Model", "n", "Collapse [%]", "Drift [%]", *(f"Peak, {one} [mm]" for one in quantiles),
            *(f"Rotation, {one} [mrad]" for one in quantiles),
        ),
        tuple(rows), "llrrrrrrr",
    )  # fmt: skip


def _with_limits(dataset, name, show):
    value = float(dataset[name])
    if not np.isfinite(value):
        return MISSING
    low, high = (show(dataset[f"{name}_interval"].sel(bound=one)) for one in ("lower", "upper"))
    return f"{show(value)} [{low}, {high}]"


def _thousandths(value):
    return f"{1e3 * float(value):.1f}"
