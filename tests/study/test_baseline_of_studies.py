"""The key `baseline` wherever a study, a campaign or a command names a motion."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

from blockshake.cli import main
from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.files import PACKAGE
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.campaigns.campaign_folder import motion_in_folder
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.own_files.check import check
from blockshake.study.config import StudyConfig, check_config
from blockshake.study.ensembles.case_input import driving_motions
from blockshake.virtual.generate import generate_campaign
from blockshake.virtual.settings import VirtualCampaign, load_settings

sys.path.insert(0, str(Path(__file__).parents[1] / "dynamics"))
from made_records import wavelet, write_at2


@pytest.fixture
def record(tmp_path):
    """Record that ends with 0.3 m/s at 4.5 m."""
    return write_at2(tmp_path / "drift.AT2", wavelet(12.0)[1] + 0.01)


def study(record, **case):
    """Smallest study of a record."""
    given = {"structure": "configuration-1", "motion": str(record), "scale": 1.0, "duration": 40.0, **case}
    return {
        "name": "mine",
        "description": "mine",
        "models": {"nscd-rigid": {"time_step": 1e-3}},
        "cases": [given],
        "ensemble": {"size": 10, "seed": 1},
    }


@pytest.mark.parametrize(("baseline", "start"), [("auto", 30.0), ("none", None), (0.2, 15.0)])
def test_case_of_a_study_drives_its_models_so(baseline, start, record):
    case = check_config(study(record, baseline=baseline), "mine.yaml").model_dump()["cases"][0]
    motion = driving_motions(case, None, 1)(0)
    assert motion.attributes.get("record_start") == start
    expected = load_motion(record, baseline=baseline)
    assert motion.table.coefficients.tobytes() == expected.table.coefficients.tobytes()


def test_check_says_what_is_done_to_each_record(record, tmp_path):
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(study(record)))
    (line,) = [line for line in check(tmp_path / "mine.yaml").splitlines() if "baseline" in line]
    assert (
        "drift.AT2 (PEER NGA AT2); assumed: a component along x; baseline: corrected, not at rest: " in line
    )
    assert "along x it ends with 0.3 m/s at" in line
    assert "PGD 4500 to 4" in line
    assert "\n" not in check(record).strip()
    assert "baseline: corrected" in check(record)
    assert "baseline: none, as requested; the record ends with 0.3 m/s at 4500 mm" in check(record, "none")


def test_a_motion_has_one_baseline_in_a_study(record):
    mapping = study(record)
    mapping["cases"].append({**mapping["cases"][0], "name": "as-published", "baseline": "none"})
    with pytest.raises(
        InputError, match=r"mine\.yaml: cases\.1\.baseline: expected one baseline of .*drift\.AT2"
    ):
        check_config(mapping, "mine.yaml")


def test_window_before_the_record_is_refused(record):
    with pytest.raises(InputError, match=r"cases\.0\.duration: expected more than 30 s: drift is corrected"):
        check_config(study(record, duration=12.0), "mine.yaml")
    check_config(study(record, duration=12.0, baseline="none"), "mine.yaml")


@pytest.mark.parametrize("value", ["correct", 0, -1, True, None, [1]])
def test_wrong_baseline_is_named_by_its_key(value, record):
    with pytest.raises(InputError, match=r"mine\.yaml: cases\.0\.baseline: expected auto, none or a corner"):
        check_config(study(record, baseline=value), "mine.yaml")


def test_every_rule_with_a_motion_knows_its_baseline():
    """A change of the key reruns: it is a parameter of each rule that reads a motion."""
    files = sorted((PACKAGE.parents[1] / "workflow" / "rules").glob("*.smk"))
    rules = [rule for path in files for rule in re.split(r"^rule ", path.read_text(), flags=re.MULTILINE)[1:]]
    named = [rule for rule in rules if re.search(r"motion_file,|unpack\((case|run)_files\)", rule)]
    assert len(named) == 6
    for rule in named:
        known = re.search(r"BASELINES|case=case_definition|runs=sample_runs|case_keys\(", rule)
        assert known, rule.partition(":")[0]
    (keys,) = (path.read_text() for path in files if path.stem == "case")
    assert re.search(r'def case_keys\(.*\n.*\n    keys = \(.*"baseline"', keys)


def test_schema_of_a_study_takes_words_and_numbers():
    kinds = StudyConfig.model_json_schema()["$defs"]["StudyCase"]["properties"]["baseline"]["anyOf"]
    assert kinds == [{"enum": ["auto", "none"], "type": "string"}, {"exclusiveMinimum": 0, "type": "number"}]


def campaign_of(folder, record, **entry):
    """Campaign of a test without readings, its record in the folder."""
    folder.mkdir()
    name = motion_in_folder(record, folder)
    assert (folder / name).read_bytes() == Path(record).read_bytes()
    (folder / "t.nc").touch()
    test = {"name": "t", "file": "t.nc", "motion": name, "scale": 2.0, "role": "fit", **entry}
    (folder / "campaign.yaml").write_text(
        yaml.safe_dump({"name": "c", "structure": "configuration-1", "tests": [test]})
    )
    return load_campaign(folder)


@pytest.mark.parametrize("baseline", ["auto", "none", 0.2])
def test_test_of_a_campaign_is_commanded_so(baseline, record, tmp_path):
    campaign = campaign_of(tmp_path / "c", record, baseline=baseline)
    motion = commanded_motion(campaign, campaign.tests["t"])
    expected = load_motion(record, 2.0, baseline)
    assert motion.table.coefficients.tobytes() == expected.table.coefficients.tobytes()
    assert motion.attributes["format"] == "PEER NGA AT2"


def test_commanded_motion_follows_an_edit_of_its_file(record, tmp_path):
    campaign = campaign_of(tmp_path / "c", record)
    before = commanded_motion(campaign, campaign.tests["t"])
    write_at2(tmp_path / "c" / "drift.AT2", wavelet(12.0)[1])
    after = commanded_motion(campaign, campaign.tests["t"])
    assert "record_start" in before.attributes
    assert "record_start" not in after.attributes


def test_virtual_campaign_shakes_the_record_so(record, tmp_path, monkeypatch):
    shaken = []

    def shake(structure, parameters, effect, motion, *rest):
        shaken.append(motion)
        raise InterruptedError

    monkeypatch.setattr("blockshake.virtual.generate.shake", shake)
    monkeypatch.setattr("blockshake.virtual.truth.calibrate_stiffness", lambda *_: dict.fromkeys(
        ("normal_stiffness", "shear_stiffness"), 2e10
    ))  # fmt: skip
    given = {
        "name": "v",
        "seed": 1,
        "model": "nscd-rigid",
        "motions": [str(record)],
        "hidden": {"effect": "none"},
    }
    for baseline in ("none", "auto"):
        settings = VirtualCampaign(**given, baseline=baseline, duration=40.0)
        with pytest.raises(InterruptedError):
            generate_campaign(
                settings, "configuration-1", tmp_path / "v", tmp_path / "truth", "source", print
            )
    assert ["record_start" in motion.attributes for motion in shaken] == [False, True]
    settings = tmp_path / "v.yaml"
    settings.write_text(yaml.safe_dump({**given, "duration": 12.0}))
    with pytest.raises(InputError, match=r"v\.yaml: duration: expected more than 30 s"):
        load_settings(settings)


def test_simulate_says_and_keeps_what_was_done(record, tmp_path, caplog, capsys):
    run = ["simulate", "--structure", "configuration-1", "--motion", str(record), "--model", "nscd-rigid"]
    output = ["--output", str(tmp_path / "run.nc")]
    caplog.set_level("INFO", logger="blockshake")
    assert main([*run, "--duration", "12", *output]) == 2
    assert "--duration: expected more than 30 s: drift is corrected" in capsys.readouterr().err
    assert main([*run, "--duration", "0.05", "--baseline", "none", *output]) == 0
    assert (
        "drift.AT2 (PEER NGA AT2); assumed: a component along x; baseline: none, as requested" in caplog.text
    )
    assert "the record ends with 0.3 m/s" in caplog.text
    with xr.open_dataset(tmp_path / "run.nc", decode_times=False) as made:
        assert made.attrs["motion_baseline"].startswith("none, as requested")
    assert main([*run, "--baseline", "never", *output]) == 2
    assert "baseline: expected auto, none or a corner frequency" in capsys.readouterr().err


def test_convert_motion_and_check_take_the_option(record, tmp_path, capsys):
    for baseline, words in (("none", "baseline: none, as requested"), ("0.2", "high-pass at 0.2 Hz")):
        assert main(["check", str(record), "--baseline", baseline]) == 0
        assert words in capsys.readouterr().out
        assert (
            main(["convert-motion", str(record), "--baseline", baseline, "--output", str(tmp_path / "m.csv")])
            == 0
        )
        assert words in capsys.readouterr().out
        expected = load_motion(record, baseline=baseline)
        moved = load_motion(tmp_path / "m.csv").evaluate(expected.table.breaks)
        np.testing.assert_allclose(moved, expected.evaluate(expected.table.breaks), atol=1e-12)
