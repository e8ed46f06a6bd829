"""The simulating steps of a diagnosis, on a campaign of two blocks that a formula simulates."""

from types import SimpleNamespace

import pytest
import xarray as xr
from made_up_decision import made_up_cause, made_up_decision, part_of
from tiny_campaign import write_campaign
from tiny_diagnosis import SOLVERS, TINY, a_formula, gain_of, simulate_open_tests

from blockshake.diagnosis import steps
from blockshake.diagnosis.answer.decision import write_decision
from blockshake.diagnosis.verdict.grade import NOT_JUDGED
from blockshake.diagnosis.verdict.verdict import load_verdict, write_verdict
from blockshake.errors import InputError
from blockshake.files import PACKAGE, write_dataset, write_json, write_text
from blockshake.store import load_made

STRUCTURE = PACKAGE.parents[1] / "hidden_effects" / "structures" / "two-blocks.yaml"
JOINT = ["block-1", "block-2"]
WEAK = {"name": "weak-joint", "values": {"factor": 0.5}, "place": {"joint": JOINT}}


def _decision(factor, places=("block-1-block-2",)):
    """That the joint is weak, by a factor and a little about it."""
    members = [{"factor": factor + 0.01 * (number % 3 - 1)} for number in range(10)]
    cause = made_up_cause("weak-joint", {"joint": JOINT}, places=places, members=members)
    return made_up_decision("named", parts=[part_of(cause)], tests=["one-100", "two-100"])


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tiny")
    write_campaign(folder / "campaign", STRUCTURE, WEAK)
    with a_formula():
        campaign = str(folder / "campaign")
        yield folder, campaign, simulate_open_tests(folder, campaign)


def test_nominal_ensembles_and_twins_are_of_every_open_test_and_solver(found):
    _, _, files = found
    assert len(files.ensembles) == 2 * len(SOLVERS)
    for path in files.ensembles:
        kinds = load_made(path)["kind"].values.tolist()
        assert kinds == ["nominal"] * TINY.draws + ["twin"] * (TINY.twins + 1)


def test_what_the_nominal_model_gets_wrong_is_in_the_misfit(found):
    _, campaign, files = found
    misfit = steps.describe_misfit(campaign, "tiny", files)
    assert misfit["test"].values.tolist() == ["one-100", "two-100"]
    assert float(misfit["p"]) == pytest.approx(1.0 / (2 * TINY.draws + 1))
    assert "times the usual error" in misfit.attrs["where"]
    assert (misfit["horizon"].max("cell") > 2.0).all()


def test_the_right_cause_gains_and_a_wrong_size_less(found):
    folder, campaign, files = found
    gained = gain_of(folder, campaign, files, _decision(0.5))
    assert gained.scores["test"].values.tolist() == ["one-150"]
    assert gained.summary.gain.nominal.estimate > 0.8
    assert gained.summary.gain.placebo.estimate == pytest.approx(0.0, abs=0.3)  # the formula knows no joint
    assert gained.summary.runs > 0
    # the cause halves a friction, and the formula moves the more the less friction there is
    effect = gained.scores.sel(test="one-150")
    assert int(effect["paired"]) == TINY.members * len(SOLVERS)
    change = effect.sel(response="median_drift", side="change")
    assert float(change["value_interval"].min()) > 0.0
    assert float(effect["value"].sel(response="collapse", side="extended")) == 0.0
    extended = float(effect["value"].sel(response="median_drift", side="extended"))
    assert float(effect["largest"].sel(response="median_drift")) == pytest.approx(extended, rel=0.2)
    nothing = gain_of(folder, campaign, files, _decision(0.98))
    assert nothing.summary.gain.recalibrated.estimate < 0.3
    gone = gain_of(folder, campaign, files, _decision(0.5, ("block-1-block-2", "slab-block-1")))
    assert gone.summary.gain.placebo is None


def test_a_changed_decision_is_refused(found):
    folder, campaign, files = found
    gain_of(folder, campaign, files, _decision(0.5))
    path = folder / "decision.json"
    write_text(path, path.read_text().replace("0.51", "0.52"))
    own = type(files)(**vars(files), decision=str(path), frozen=str(folder / "frozen.json"), extended=[])
    with pytest.raises(InputError, match="frozen"):
        steps.measure_gain(campaign, "tiny", own)


def test_a_second_diagnosis_simulates_nothing_anew(found):
    folder, campaign, files = found
    before = {path.name for path in (folder / "store").iterdir()}
    again = simulate_open_tests(folder, campaign)
    assert {path.name for path in (folder / "store").iterdir()} == before
    for one, other in zip(files.ensembles, again.ensembles, strict=True):
        xr.testing.assert_identical(load_made(one), load_made(other))


def test_tests_that_are_too_short_end_in_a_verdict_that_says_so(tmp_path):
    write_campaign(tmp_path / "campaign", STRUCTURE)
    for path in (tmp_path / "campaign").glob("*.nc"):
        whole = load_made(path)
        write_dataset(path, whole.sel(time=slice(0.0, 0.1)))
    decided = steps.decide(str(tmp_path / "campaign"), ())
    assert decided.decision.decision == "none"
    assert decided.decision.tests == ()
    assert all("too short" in line for line in decided.decision.cannot_see)
    files = SimpleNamespace(parity=tmp_path / "parity.json", decision=tmp_path / "decision.json", gain=[])
    write_json(files.parity, decided.parity.as_json())
    write_decision(files.decision, decided.decision)
    verdict = steps.conclude(str(tmp_path / "campaign"), 0, files)
    write_verdict(tmp_path / "verdict.json", verdict)
    assert load_verdict(tmp_path / "verdict.json").word == NOT_JUDGED
    assert decided.evidence.sizes["instant"] == decided.evidence.sizes["reading"] == 0
