"""The way of a diagnosis, step by step, on a campaign of two blocks that a formula simulates."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from tiny_campaign import TESTS, write_campaign
from tiny_diagnosis import SOLVERS, TINY, diagnose, silent, two_effects_and_a_formula

from blockshake.diagnosis import steps
from blockshake.diagnosis.inference import calibration
from blockshake.diagnosis.inference.calibration import write_cases
from blockshake.diagnosis.inference.decision import write_result
from blockshake.diagnosis.laws.findings import LawFindings, OutsideForce
from blockshake.diagnosis.libraries import efforts, plan
from blockshake.diagnosis.verdict.frozen import freeze
from blockshake.errors import InputError
from blockshake.files import PACKAGE, write_dataset

PITCH = {"name": "table-pitch", "values": {"coefficient": 1.2e-3, "frequency": 18.0}, "place": {}}
STRUCTURE = PACKAGE.parents[1] / "hidden_effects" / "structures" / "two-blocks.yaml"

PUSH = OutsideForce(
    bodies=("block-2",), law="constant", scores={"constant": 0.0}, amplitude=-2e3, lower=-2.2e3, upper=-1.8e3,
    unit="N", tests={"one-100": {"start": 2.0}},
)  # fmt: skip


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """Results of every step and the files that the next ones read."""
    folder = tmp_path_factory.mktemp("tiny")
    write_campaign(folder / "campaign", STRUCTURE, PITCH)
    with two_effects_and_a_formula():
        yield diagnose(folder, str(folder / "campaign"))


def test_open_tests_are_read_off_with_sound_sensors(found):
    assert found.measured.parity.findings == ()
    assert found.measured.readings["test"].values.tolist() == ["one-100", "two-100"]


def test_a_killed_calibration_judges_each_draw_once(found, tmp_path, monkeypatch):
    judged, judge = [], calibration._cases_of_draw

    def counted(library, model, draw):
        if len(judged) == limit:
            raise KeyboardInterrupt
        judged.append((model, draw))
        return judge(library, model, draw)

    def attempt(source="source"):
        given = found.files.libraries, plan.considered(), tmp_path / "store", source
        write_cases(tmp_path / "cases.json", steps.calibrate_decision(*given, silent))

    monkeypatch.setattr(calibration, "_cases_of_draw", counted)
    limit = 7
    with pytest.raises(KeyboardInterrupt):
        attempt()
    limit = None
    attempt()
    draws = len(SOLVERS) * TINY.nominal_draws
    assert len(set(judged)) == len(judged) == draws
    assert (tmp_path / "cases.json").read_bytes() == Path(found.files.calibration).read_bytes()
    attempt("edited")
    assert len(judged) == 2 * draws


def test_the_cause_is_named_with_its_size(found):
    assert found.decided.decision.causes == ("table-pitch",)
    coefficient = found.sized.size.parameters["coefficient"]
    assert coefficient.lower < coefficient.estimate < coefficient.upper
    assert coefficient.lower > 0.0
    assert found.decided.evidence.attrs["candidate"] == "table-pitch"
    assert found.decided.misfit["test"].values.tolist() == found.decided.tests


def test_the_extended_model_is_scored_on_the_sealed_test(found):
    (sealed,) = (name for name, (_, _, role) in TESTS.items() if role == "sealed")
    assert found.gained.scores["test"].values.tolist() == [sealed]
    assert np.isfinite(found.gained.scores["fall"]).all()
    assert found.gained.consequences["drift_history"].notnull().any()
    # nominal, recalibrated and extended members by both solvers
    assert found.gained.summary.runs == 3 * len(SOLVERS) * TINY.members


def test_the_verdict_counts_its_runs_and_carries_its_word(found):
    verdict = found.verdict
    assert (verdict.decision, verdict.causes) == ("named", ("table-pitch",))
    assert verdict.word == "probable"
    assert "it was judged by 2 tests only" in verdict.missing
    planned = 2 * len(SOLVERS) * (TINY.nominal_draws + 2 * TINY.own_draws + 1 + TINY.twins)
    assert verdict.runs == planned + 2 * len(SOLVERS) * TINY.further_draws + found.gained.summary.runs


def test_twins_have_a_horizon_by_each_solver(found):
    assert found.horizon["model"].values.tolist() == list(SOLVERS)
    assert np.isfinite(found.horizon["horizon"]).all()


def test_a_decision_that_was_changed_is_refused_by_the_steps_behind_it(found, tmp_path):
    changed = tmp_path / "decision.json"
    write_result(changed, found.decided.decision.model_copy(update={"p_none": 0.5}))
    files = SimpleNamespace(**vars(found.files) | {"decision": str(changed)})
    with pytest.raises(InputError, match="frozen"):
        steps.size_cause(files, ["table-pitch"])
    with pytest.raises(InputError, match="frozen"):
        steps.measure_gain(found.campaign, files)


def test_a_campaign_without_a_gain_says_why(found):
    files = SimpleNamespace(**vars(found.files) | {"gain": (), "posterior": ()})
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(efforts.EFFORTS, "tiny", TINY)
        verdict = steps.conclude(found.campaign, "tiny", files)
    assert "no gain was measured on a sealed test" in verdict.missing
    assert verdict.gain is None


def test_a_force_that_the_laws_describe_extends_the_model(found, tmp_path):
    """The cause is unknown, and its gain is measured like that of a named one."""
    laws = LawFindings(laws=(), isolated=(), outside=PUSH, shares={}, p=1e-6)
    unknown = found.decided.decision.model_copy(update={"decision": "unknown", "causes": (), "laws": laws})
    decision, frozen = tmp_path / "decision.json", tmp_path / "frozen.json"
    write_result(decision, unknown)
    freeze(frozen, decision, found.decided.tests)
    given = {"decision": str(decision), "frozen": str(frozen), "posterior": (), "further": ()}
    files = SimpleNamespace(**vars(found.files) | given)
    made_by = tmp_path / "store", "source", silent
    files.extended = [str(tmp_path / f"{solver}.nc") for solver in SOLVERS]
    for solver, file in zip(SOLVERS, files.extended, strict=True):
        runs = steps.extend_model(found.campaign, "tiny", solver, files, plan.considered(), *made_by)
        assert (runs["kind"] == "extended").sum() == TINY.members
        write_dataset(file, runs)
    gained = steps.measure_gain(found.campaign, files)
    # the formula that simulates here feels no force: nothing is gained, and that is told
    assert gained.summary.gain.nominal.estimate == pytest.approx(0.0, abs=1e-6)


def test_readings_of_the_library_are_those_of_the_campaign(found):
    features = xr.load_dataset(found.files.libraries[0])
    assert set(features["feature"].values) == set(found.measured.readings["feature"].values)


def _leave(campaign, axes, names):
    """Leave readings of these axes alone in all tests of a campaign, of markers whose names end so."""
    for path in campaign.glob("*.nc"):
        test = xr.load_dataset(path)
        moved = test["marker_displacement"].where(test["axis"].isin(list(axes)))
        kept = [name for name in test["marker"].values if str(name).endswith(names)]
        write_dataset(path, test.assign(marker_displacement=moved).sel(marker=kept))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("axes", "names", "curve"), [("xz", "", "joint1.opening"), ("x", "face", "block-2.drift")]
)
def test_a_camera_and_transducers_along_x_are_diagnosed_too(axes, names, curve, tmp_path):
    """Nothing that was not measured enters: no curve, no residual, no force; the verdict is one of its words."""
    write_campaign(tmp_path / "campaign", STRUCTURE, PITCH)
    _leave(tmp_path / "campaign", axes, names)
    with two_effects_and_a_formula():
        found = diagnose(tmp_path, str(tmp_path / "campaign"))
    assert f"one-100.{curve}" in found.decided.misfit["curve"].values
    assert not found.measured.forces.data_vars
    residual = found.decided.misfit["residual"]
    assert residual.notnull().any() == ("z" in axes)
    assert not any("lateral" in name for name in found.measured.readings["feature"].values.tolist())
    assert found.verdict.decision in ("none", "named", "ambiguous", "combination", "unknown")
    assert np.isfinite(found.gained.scores["fall"]).all()
