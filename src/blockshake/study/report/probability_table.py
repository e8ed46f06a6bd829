"""Probabilities of collapse and of large drift, and quantiles of peaks and rotations, with their intervals."""

import numpy as np

from blockshake.pages.blocks import Table
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import MISSING, model_label, number, percent
from blockshake.statistics.intervals import CONFIDENCE, samples_needed
from blockshake.study.ensembles.outcomes import shortfall

_SHOWN = (0.5, 0.95)
_needed = ", ".join(f"{100 * one:.0f} % needs {samples_needed(one)}" for one in _SHOWN)


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
        f"{number(1e3 * limit.attrs['largest_drift'])} mm, with Clopper-Pearson limits; quantiles {shown} of peak "
        "displacement [mm] and peak rotation [mrad] over the n samples that did not fail, with limits by order "
        f"statistics. {MISSING.capitalize()}: of a quantile for which n is too small to bear limits ({_needed}). All "
        f"limits are of {100 * CONFIDENCE:.0f} % and take samples as independent. A sample that collapsed, or still "
        "fell when the window ended, counts as a collapse and as more than that drift, and with the peak that it had "
        "reached.",
        (
            "Case, marker", "Model", "n", "Collapse [%]", "Drift [%]", *(f"Peak, {one} [mm]" for one in quantiles),
            *(f"Rotation, {one} [mrad]" for one in quantiles),
        ),
        tuple(rows), "llrrrrrrr",
    )  # fmt: skip


def _with_limits(dataset, name, show):
    value, limits = float(dataset[name]), dataset[f"{name}_interval"].sel(bound=["lower", "upper"])
    if not np.isfinite([value, *limits]).all():
        return MISSING
    return f"{show(value)} [{', '.join(map(show, limits))}]"


def _thousandths(value):
    return f"{1e3 * float(value):.1f}"
