"""Joints of a case: figure and table of their compression, uplift and slip."""

import numpy as np

from blockshake.pages.blocks import Figure, Table
from blockshake.pages.drawing import svg_of
from blockshake.pages.wording import MISSING, model_label, number, quantile_percent
from blockshake.simulation.run_histories import RARELY
from blockshake.study.report.figures.joints import plot_joints

_SHOWN = 0.95
_FACTORS = {"joint_compression": 1e-3, "joint_uplift": 1e3, "joint_slip": 1e3}  # to kN and mm
_MEANING = (
    f"Compression: normal force that is exceeded for {100.0 * RARELY:g} % of the time, so that it leaves impacts out; "
    "uplift and slip: the largest at the middle of the face"
)


def joint_blocks(case):
    """Figure and table of a case's joints; nothing where no sample of any model has a result."""
    envelopes = {
        model: one.envelope for model, one in case.responses.items() if int(one.envelope.attrs["counted"])
    }
    if not envelopes:
        return []
    return [
        Figure(
            f"{case.name}: joints from the foundation up. {_MEANING}. Dots: median over the samples; lines: from the "
            "5 % to the 95 % quantile.",
            svg_of(plot_joints, envelopes),
        ),
        _table(case, envelopes),
    ]


def _table(case, envelopes):
    rows = [
        (str(joint), *(_cell(one.sel(joint=joint, quantile=_SHOWN)) for one in envelopes.values()))
        for joint in reversed(next(iter(envelopes.values()))["joint"].values)
    ]
    labels = (f"{model_label(model)} (n = {int(one.attrs['counted'])})" for model, one in envelopes.items())
    return Table(
        f"{case.name}: compression [kN] / uplift [mm] / slip [mm] of the joints from the top down, "
        f"{quantile_percent(_SHOWN)} quantile over the samples that did not fail. {_MEANING}.",
        ("Joint", *labels), tuple(rows), "l" + "r" * len(envelopes),
    )  # fmt: skip


def _cell(at):
    shown = [factor * float(at[name]) for name, factor in _FACTORS.items()]
    return " / ".join(map(number, shown)) if np.isfinite(shown).all() else MISSING
