"""Gain on responses of sealed tests by rigid contact dynamics: of the extension that is proposed, and the oracle's.

The oracle's model has the true causes in their own form and size, and nothing else that is true: it gains what there is
to gain by naming them. Both are measured against the nominal model with the same draws, of one solver.
"""

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from effect_forms import FORMS
from outside_forces import OUTSIDE

from blockshake.diagnosis.gain.extended_model import Extension, can_extend
from blockshake.diagnosis.gain.response_gain import response_gain
from blockshake.diagnosis.misfit.judged_test import judged_test, measured_histories
from blockshake.diagnosis.nominal.ensemble import (
    EXTENDED,
    NOMINAL,
    RECALIBRATED,
    Member,
    nominal_members,
    simulate_members,
)
from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.diagnosis.nominal.planned_test import planned_sealed, planned_test
from blockshake.diagnosis.verdict.verdict import Contrast
from blockshake.effects.registry import with_effect
from blockshake.files import content_digest, load_json, write_json
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.sources import script_sources, source_digest
from blockshake.store import Store
from blockshake.validation import Strict, validated

MODEL, DRAWS, TWINS = "nscd-rigid", 8, 3
ABLE = 0.3  # gain of the oracle from which on a share of it is counted
_ORACLE = "oracle"


class ResponseGains(Strict):
    """The file ``gains.json`` of a case; a gain is None where nothing is there to gain within the draws' scatter."""

    proposed: bool  # the verdict proposes an extension
    found: Contrast | None  # gain of that extension over the nominal model
    oracle: Contrast | None  # gain of the true causes

    @property
    def idle(self):
        """Whether the oracle gains nothing: the causes are there and change no prediction."""
        return self.oracle is None or self.oracle.lower <= 0.0

    @property
    def share(self):
        """Gain of the proposed extension over the oracle's; None where the oracle gains less than `ABLE`."""
        if not self.proposed or self.oracle is None or self.oracle.estimate < ABLE:
            return None
        return (self.found.estimate if self.found else 0.0) / self.oracle.estimate


class TrueCauses:
    """Change of an `Experiment` by the causes that are hidden in a case, as they act in the test of a number."""

    def __init__(self, truth, number):
        self.truth, self.number = truth, number
        self.digest = content_digest(_ORACLE, truth["causes"], truth["laboratory"], number)

    def __call__(self, experiment):
        """The experiment with the causes in it; MuJoCo's laboratory has the registry's own forms."""
        for cause in self.truth["causes"]:
            name, values, place = cause["name"], cause["values"], cause["place"]
            if name in OUTSIDE:
                start = cause["start"][self.number]
                experiment = experiment if start is None else OUTSIDE[name].act(experiment, cause, start)
            elif self.truth["laboratory"] == "mujoco":
                experiment = with_effect(experiment, name, values, place)
            else:
                experiment = FORMS[name][1](experiment, values, place)
        return experiment


def response_gains(folder, truth, verdict, findings, store):
    """`ResponseGains` of a case on its sealed tests.

    Parameters
    ----------
    folder : path
        Of the campaign.
    truth : dict
    verdict : Verdict
        Its ``extension`` is what is proposed.
    findings : sequence of Finding
        Faults of sensors that were found, which are taken out of the readings.
    store : str or path
        Folder of finished runs.
    """
    campaign = load_campaign(folder)
    structure = load_structure(campaign.structure)
    causes = tuple(cause for cause in verdict.extension if can_extend(cause))
    opened = {name: planned_test(campaign, name, structure) for name in campaign.open}
    measured = measured_histories(campaign, list(campaign.sealed), findings)
    draws = [draw_nominal(structure, MODEL, number) for number in range(DRAWS)]
    runs_kept = Store(str(store), source_digest(*script_sources("simulate_nominal", MODEL)), _silent)
    tests = []
    for name in campaign.sealed:
        planned = planned_sealed(campaign, name, opened, structure)
        hidden = TrueCauses(truth, list(truth["tests"]).index(name))
        members = nominal_members(name, planned, MODEL, DRAWS, TWINS)
        members += [Member(_ORACLE, k, name, planned, draw, hidden) for k, draw in enumerate(draws)]
        if causes:
            found = partial(Extension, causes, test=name)
            members += [
                Member(EXTENDED, k, name, planned, draw, found(number=k)) for k, draw in enumerate(draws)
            ]
        kinds = (NOMINAL, _ORACLE, *([EXTENDED] if causes else []))
        tests.append(judged_test(name, measured[name], [simulate_members(members, runs_kept)], kinds))
    return ResponseGains(
        proposed=bool(causes), found=_gain(tests, EXTENDED) if causes else None, oracle=_gain(tests, _ORACLE)
    )


def _silent(line):
    """No line of a run."""


def _gain(tests, kind):
    """Gain of the members of a kind over the nominal ones; None where these score within noise."""
    held = [
        replace(test, members={
            NOMINAL: test.members[NOMINAL], RECALIBRATED: test.members[NOMINAL], EXTENDED: test.members[kind],
        })
        for test in tests
        if test.judged.any()
    ]  # fmt: skip
    if not held:
        return None
    gained = response_gain(held).sel(rival=NOMINAL)
    estimate, lower, upper = (float(gained[name]) for name in ("gain", "gain_lower", "gain_upper"))
    return None if np.isnan(estimate) else Contrast.cut_off(estimate, lower, upper)


def gains_of(results, name):
    """File of the gains of a case."""
    return Path(results) / name / "verdict" / "gains.json"


def write_gains(path, gains):
    """Write `ResponseGains`."""
    write_json(path, gains.model_dump(mode="json"))


def load_gains(path):
    """`ResponseGains` of a file; None where there is none."""
    return validated(ResponseGains, load_json(path), Path(path)) if Path(path).is_file() else None
