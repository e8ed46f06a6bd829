import dataclasses

import numpy as np
import pytest
import yaml
from made_outcomes import DRAWS, SLOPES, STRUCTURE, made_campaign

from blockshake.diagnosis.nominal.nominal_model import MODELS
from blockshake.diagnosis.outcomes import runs as runs_module
from blockshake.diagnosis.outcomes.decide import decide_outcomes
from blockshake.diagnosis.outcomes.gain import outcome_gain
from blockshake.diagnosis.outcomes.posterior import load_outcomes
from blockshake.diagnosis.outcomes.runs import shares_of, simulate_outcomes
from blockshake.diagnosis.outcomes.unknowns import UNKNOWNS, model_at, value_of
from blockshake.errors import InputError
from blockshake.geometry.structure import build_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.own_files.check import check
from blockshake.store import Store

NAMES = [unknown.name for unknown in UNKNOWNS]


@pytest.fixture(scope="module")
def off_centre(tmp_path_factory):
    """A column whose mass centre lies off along x by two thirds of the most."""
    return made_campaign(tmp_path_factory.mktemp("made") / "off", {"offset_x": 0.67})


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A column as its structure file states."""
    return made_campaign(tmp_path_factory.mktemp("made") / "sound", {})


def test_slopes_of_the_law_come_out_of_a_few_leans(off_centre):
    """The emulator is reported leans between 0.3 and 20 degrees, and of all others the side alone."""
    (emulator,) = load_outcomes(off_centre[1]).emulators
    linear = dict(zip(NAMES, emulator.slopes, strict=False))
    for name in NAMES:
        assert linear[name] == pytest.approx(SLOPES.get(name, 0.0), abs=0.08)
    assert emulator.spread == pytest.approx(0.2, rel=0.15)


def test_a_mass_off_the_middle_is_named_by_outcomes_alone(off_centre):
    folder, files = off_centre
    decision, evidence = decide_outcomes(load_campaign(folder), files)
    assert decision.decision == "named"
    (part,) = decision.parts
    (cause,) = part.causes
    assert cause.name == "eccentricity"
    estimate = cause.parameters["offset_x"]
    truth = value_of(UNKNOWNS[0], 0.67, 0.8)
    assert estimate.lower < truth < estimate.upper
    assert estimate.lower > 0.0
    # what the law does not depend on stays open
    assert cause.parameters["offset_y"].lower < 0.0 < cause.parameters["offset_y"].upper
    assert set(evidence["test"].values) == set(load_campaign(folder).open)


def test_sound_columns_have_no_cause(sound):
    folder, files = sound
    decision, _ = decide_outcomes(load_campaign(folder), files)
    assert decision.decision == "none"
    assert decision.p == 1.0


def test_the_cause_gains_on_sealed_tests_over_sound_models_and_over_a_curve(off_centre):
    folder, files = off_centre
    campaign = load_campaign(folder)
    decision, _ = decide_outcomes(campaign, files)
    found = outcome_gain(campaign, files, decision)
    assert found.summary.gain.nominal.lower > 0.2
    assert found.summary.gain.discrepancy.estimate > 0.0
    assert set(found.scores["test"].values) == set(campaign.sealed)


def test_sealed_outcomes_have_no_say(off_centre, tmp_path):
    """With every sealed outcome turned about, the decision is the same to the last digit."""
    folder, files = off_centre
    campaign = load_campaign(folder)
    turned = {
        name: test.model_copy(update={"outcome": "fell" if test.outcome == "stood" else "stood"})
        if test.role == "sealed"
        else test
        for name, test in campaign.tests.items()
    }
    before, after = (
        decide_outcomes(one, files).decision
        for one in (campaign, dataclasses.replace(campaign, tests=turned))
    )
    assert before == after


@pytest.mark.parametrize("solver", MODELS)
def test_the_model_has_the_shares(solver):
    structure = build_structure(STRUCTURE, "column.yaml", ".")
    shares = np.zeros(len(UNKNOWNS))
    shares[[NAMES.index("offset_x"), NAMES.index("friction_factor"), NAMES.index("heading")]] = 0.5, 1.0, 1.0
    built, factor = model_at(structure, 1, solver, shares)
    assert factor == 1.0
    assert built.file.bodies[1].mass_offset == pytest.approx((0.015 * 0.8, 0.0, 0.0))
    assert built.file.friction[0].coefficient == pytest.approx(1.2)
    assert 2.0 * np.degrees(np.arccos(built.file.bodies[1].orientation[0])) == pytest.approx(10.0)


def test_batches_resume_and_simulate_the_shares_of_their_tests(off_centre, tmp_path, monkeypatch):
    """Strong and weak tests of one batch; what is kept is not run again."""
    campaign = load_campaign(off_centre[0])
    monkeypatch.setattr(runs_module, "BATCH", 2)
    said = []
    store = Store(tmp_path, "sources", said.append)
    first = simulate_outcomes(campaign, 1, "nscd-rigid", 2, store)
    assert list(first["test"].values) == ["test-2", "test-3"]
    np.testing.assert_array_equal(first["share"][1], shares_of(3, 2))
    assert (first["share"][:, 0] == 0.0).all()
    assert first["pga"].values == pytest.approx(
        [abs(campaign.tests[f"test-{n}"].scale) for n in (2, 3)], rel=0.01
    )
    monkeypatch.setattr(runs_module, "simulate", None)
    assert simulate_outcomes(campaign, 1, "nscd-rigid", 2, store).equals(first)
    assert len(said) == 8


def test_a_strong_pulse_throws_the_column_down(tmp_path, off_centre, monkeypatch):
    """b/h is 0.25: a sine of 12 m/s2 and 1 Hz topples it, one of 1 m/s2 does not make it rock (Housner 1963)."""
    campaign = load_campaign(off_centre[0])
    strong, weak = (
        campaign.tests["test-0"].model_copy(update={"name": name, "scale": scale})
        for name, scale in (("strong", 12.0), ("weak", 1.0))
    )
    campaign = dataclasses.replace(campaign, tests={"strong": strong, "weak": weak})
    lean = simulate_outcomes(campaign, 0, "nscd-rigid", 1, Store(tmp_path, "sources", list))["lean"].values
    assert np.isinf(lean[0, 0])
    assert lean[1, 0] < 1e-3


def test_check_says_what_is_there_and_what_contradicts(off_centre):
    folder, _ = off_centre
    lines = check(str(folder))
    opened = load_campaign(folder).open.values()
    assert f"{sum(test.outcome == 'fell' for test in opened)} fell" in lines
    assert (
        "stood at" in lines
    )  # one motion, scaled, with tests of their own: some stand where a weaker one fell


@pytest.mark.parametrize(("scale", "said"), [(0.01, True), (1.0, False), (30.0, True)])
def test_motions_in_another_unit_are_remarked(tmp_path, scale, said):
    (tmp_path / "column.yaml").write_text(yaml.safe_dump(STRUCTURE))
    test = {"name": "a", "motion": "alkion", "scale": scale, "role": "fit", "outcome": "stood"}
    mapping = {"name": "other unit", "structure": "column.yaml", "tests": [test]}
    (tmp_path / "campaign.yaml").write_text(yaml.safe_dump(mapping))
    assert ("remark: a: the peak acceleration is" in check(str(tmp_path))) == said


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"outcome": "toppled"}, "tests.a.outcome"),
        ({"file": "readings.csv", "outcome": "fell"}, "either file"),
        ({"outcome": "fell", "motion": None}, "motion"),
    ],
)
def test_bad_outcomes_are_refused(tmp_path, changed, said):
    (tmp_path / "column.yaml").write_text(yaml.safe_dump(STRUCTURE))
    test = {"name": "a", "motion": "alkion", "scale": 1.0, "role": "fit", "outcome": "stood"} | changed
    test = {key: value for key, value in test.items() if value is not None}
    mapping = {"name": "bad", "structure": "column.yaml", "tests": [test]}
    (tmp_path / "campaign.yaml").write_text(yaml.safe_dump(mapping))
    with pytest.raises(InputError, match=said):
        load_campaign(tmp_path)


def test_draws_of_other_tests_are_others():
    assert not np.allclose(shares_of(0, DRAWS)[1:], shares_of(1, DRAWS)[1:])
    assert (np.abs(shares_of(7, DRAWS)) <= 1.0).all()


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "cp1252"])
def test_a_table_of_tests_is_read_as_a_spreadsheet_writes_it(tmp_path, encoding):
    (tmp_path / "column.yaml").write_text(yaml.safe_dump(STRUCTURE))
    table = "name;motion;scale;role;outcome\r\npr\u00fcfung;alkion;1,5;fit;fell\r\nb;alkion;2;sealed;stood\r\n;;;;\r\n"
    (tmp_path / "tests.csv").write_bytes(table.encode(encoding))
    mapping = {"name": "good", "structure": "column.yaml", "tests": "tests.csv"}
    (tmp_path / "campaign.yaml").write_text(yaml.safe_dump(mapping))
    tests = load_campaign(tmp_path).tests
    assert {name: test.scale for name, test in tests.items()} == {"pr\u00fcfung": 1.5, "b": 2.0}


@pytest.mark.parametrize(
    ("table", "said"),
    [
        ("name,motion,scale,outcome\na,alkion,1.0,fell\n", "tests.csv: expected .* the table has no role"),
        ("nom;r\u00f4le\na;fit\n", "has no name and no role"),
        ("name,name,role\na,b,fit\n", "name: expected every column to have a name of its own"),
        ("name,role\na,fit,1\n", "row 1: expected 2 cells, not 3"),
        ("name,motion,scale,role,outcome\n", "has no row"),
        (None, "tests: expected a list, or a CSV table"),
    ],
)
def test_a_wrong_table_of_tests_is_named_once(tmp_path, table, said):
    (tmp_path / "column.yaml").write_text(yaml.safe_dump(STRUCTURE))
    if table:
        (tmp_path / "tests.csv").write_text(table)
    mapping = {"name": "bad", "structure": "column.yaml", "tests": "tests.csv"}
    (tmp_path / "campaign.yaml").write_text(yaml.safe_dump(mapping))
    with pytest.raises(InputError, match=said):
        load_campaign(tmp_path)
