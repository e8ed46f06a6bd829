"""Joints of a case: table of their compression, uplift and slip."""

import numpy as np

from blockshake.pages.blocks import Table
from blockshake.pages.wording import MISSING, model_label, number, quantile_percent
from blockshake.simulation.run_histories import RARELY

_SHOWN = 0.95
_FIGURES = {"joint_compression": 1e-3, "joint_uplift": 1e3, "joint_slip": 1e3}  # factors from SI


def joints_table(case):
    """Table of a case's joints, in a list; an empty one where no sample of any model has a result."""
    envelopes = {
        model: one.envelope for model, one in case.responses.items() if int(one.envelope.attrs["counted"])
    }
    if not envelopes:
        return []
    rows = [
        (str(joint), *(_cell(one.sel(joint=joint, quantile=_SHOWN)) for one in envelopes.values()))
        for joint in reversed(next(iter(envelopes.values()))["joint"].values)
    ]
    labels = (f"{model_label(model)} (n = {int(one.attrs['counted'])})" for model, one in envelopes.items())
    return [
        Table(
            f"{case.name}: compression [kN] / uplift [mm] / slip [mm] of the joints from the top down, "
            f"{quantile_percent(_SHOWN)} quantile over the samples that did not fail. Compression: normal force that "
            f"is exceeded for {100.0 * RARELY:g} % of the time, so that it leaves impacts out; uplift and slip: the "
            "largest at the middle of the face.",
            ("Joint", *labels),
            tuple(rows),
            "l" + "r" * len(envelopes),
        )
    ]


def _cell(at):
    shown = [factor * float(at[name]) for name, factor in _FIGURES.items()]
    return " / ".join(map(number, shown)) if np.isfinite(shown).all() else MISSING
