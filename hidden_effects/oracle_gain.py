"""Gain on responses of sealed tests by rigid contact dynamics: of the extension that is proposed, and the oracle's.

The oracle's model has the true causes in their own form and size, and nothing else that is true: it gains what there is
to gain by naming them. Both are measured against the nominal model with the same draws, of one solver.
"""

from pathlib import Path

from effect_forms import FORMS
from outside_forces import OUTSIDE

from blockshake.diagnosis.gain.extended_model import Extension, can_extend
from blockshake.diagnosis.gain.response_gain import gain_over_nominal, select_gain
from blockshake.diagnosis.misfit.judged_test import judged_test, measured_histories
from blockshake.diagnosis.nominal.ensemble import (
    EXTENDED,
    NOMINAL,
    Member,
    nominal_members,
    simulate_members,
)
from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.diagnosis.nominal.planned_test import planned_sealed, planned_test
from blockshake.diagnosis.verdict.verdict import Contrast, MeasuredGain
from blockshake.effects.registry import with_effect
from blockshake.files import content_digest, load_json, write_json
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.sources import script_sources, source_digest
from blockshake.store import Store
from blockshake.validation import Strict, validated

MODEL, DRAWS, TWINS = "nscd-rigid", 8, 3
ABLE = 0.3  # gain of the oracle from which on a share of it is counted
ORACLE = "oracle"


class ResponseGains(Strict):
    """The file ``gains.json`` of a case; a gain is None where nothing is there to gain within the draws' scatter."""

    proposed: bool  # the verdict has an extension, and it gains on the tests to select by
    found: Contrast | None  # gain of that extension over the nominal model
    oracle: Contrast | None  # gain of the true causes

    @property
    def idle(self):
        """Whether the oracle gains nothing: the causes are there and change no prediction."""
        return self.oracle is None or not self.oracle.gains

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
        self.digest = content_digest(ORACLE, truth["causes"], truth["laboratory"], number)

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
        The campaign.
    truth : dict
    verdict : Verdict
        Its ``extension`` is what is proposed, unless it gains nothing on the tests to select by.
    findings : sequence of Finding
        Faults of sensors that were found, which are taken out of the readings.
    store : str or path
        Folder of finished runs.
    """
    campaign = load_campaign(folder)
    causes = tuple(cause for cause in verdict.extension if can_extend(cause))
    numbers = {name: number for number, name in enumerate(truth["tests"])}
    changes = {ORACLE: lambda name, draw: TrueCauses(truth, numbers[name])}
    found = {EXTENDED: lambda name, draw: Extension(causes, draw, name)} if causes else {}
    select = [name for name, test in campaign.open.items() if test.role == "select"] if causes else []
    selected = select_gain(tests_of_models(campaign, select, found, findings, store))
    if not MeasuredGain(select=selected).proposes:
        found = {}
    tests = tests_of_models(campaign, campaign.sealed, changes | found, findings, store)
    return ResponseGains(
        proposed=bool(found),
        found=gain_over_nominal(tests) if found else None,
        oracle=gain_over_nominal(tests, ORACLE),
    )


def tests_of_models(campaign, names, changes, findings, store):
    """`JudgedTest` of some tests of a campaign, with the nominal model and its changes.

    Parameters
    ----------
    campaign : Campaign
    names : iterable of str
    changes : dict of str to callable
        By model: the change of an `Experiment`, with its digest, in a test of a name by the draw of a number.
    findings : sequence of Finding
        Taken out of the readings.
    store : str or path
        Folder of finished runs.
    """
    structure = load_structure(campaign.structure)
    opened = {name: planned_test(campaign, name, structure) for name in campaign.open}
    measured = measured_histories(campaign, list(names), findings)
    draws = [draw_nominal(structure, MODEL, number) for number in range(DRAWS)]
    runs_kept = Store(str(store), source_digest(*script_sources("simulate_nominal", MODEL)), _silent)
    tests = []
    for name in names:
        planned = opened[name] if name in opened else planned_sealed(campaign, name, opened, structure)
        members = nominal_members(name, planned, MODEL, DRAWS, TWINS)
        members += [
            Member(kind, k, name, planned, draw, change(name, k))
            for kind, change in changes.items()
            for k, draw in enumerate(draws)
        ]
        ensemble = simulate_members(members, runs_kept)
        tests.append(judged_test(name, measured[name], [ensemble], (NOMINAL, *changes)))
    return tests


def _silent(line):
    """No line of a run."""


def gains_of(results, name):
    """File of the gains of a case."""
    return Path(results) / name / "verdict" / "gains.json"


def write_gains(path, gains):
    """Write `ResponseGains`."""
    write_json(path, gains.model_dump(mode="json"))


def load_gains(path):
    """`ResponseGains` of a file; None where there is none."""
    return validated(ResponseGains, load_json(path), Path(path)) if Path(path).is_file() else None
