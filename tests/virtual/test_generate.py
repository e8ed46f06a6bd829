"""The virtual shake table: repeatable, resumable, honest about what is synthetic, and read like any campaign."""

import json

import numpy as np
import pytest
import xarray as xr
import yaml

from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.study.config import check_config
from blockshake.virtual import generate
from blockshake.virtual.settings import Hidden, VirtualCampaign, load_settings
from blockshake.virtual.truth import hidden_effect

SETTINGS = {
    "name": "small",
    "seed": 7,
    "model": "nscd-rigid",
    "time_step": 1e-3,
    "duration": 3.0,
    "motions": ["motion.csv"],
    "intensities": {"first": 1.0, "increment": 1.0, "highest": 3.0},
    "hidden": {"effect": "weak-joint", "values": {"factor": 0.2}},
}
PLACED = 3e-4  # m, default misplacement


@pytest.fixture(scope="module")
def stiffness():
    """The true stiffness does not matter to NSCD: no wave is simulated here."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("blockshake.virtual.truth.calibrate_stiffness", lambda *_: dict.fromkeys(
            ("normal_stiffness", "shear_stiffness"), 2e10
        ))  # fmt: skip
        yield


@pytest.fixture
def make(tmp_path, monkeypatch, stiffness):
    """Campaign and truth of settings; the folders and the lines of progress are returned."""
    time = np.arange(0.0, 1.5001, 0.01)
    rows = [f"{t:.2f},{1.2 * np.sin(4.0 * np.pi * t):.6f}" for t in time]
    (tmp_path / "motion.csv").write_text("time_s,acceleration_x\n" + "\n".join(rows) + "\n")
    # the table goes 0.3 m to one side and stays, times the scale
    rows = [f"{t:.2f},{0.15 * (1.0 - np.cos(np.pi * min(t, 1.0))):.6f}" for t in time]
    (tmp_path / "push.csv").write_text("time_s,displacement_x\n" + "\n".join(rows) + "\n")
    monkeypatch.chdir(tmp_path)

    def made(name="c", source="one", **changed):
        settings = VirtualCampaign(**{**SETTINGS, **changed})
        said = []
        generate.generate_campaign(settings, "configuration-1", name, f"{name}-truth", source, said.append)
        return tmp_path / name, tmp_path / f"{name}-truth", said

    return made


def test_it_is_read_like_any_campaign_and_says_synthetic(make):
    folder, truth, _ = make()
    campaign = load_campaign(folder)
    assert [test.role for test in campaign.tests.values()] == ["fit", "select", "sealed"]
    for name in campaign.tests:
        test = load_test(campaign, name)
        assert np.isfinite(test["marker_displacement"]).all()
        assert "accelerometer" in test
        with xr.open_dataset(folder / f"{name}.nc") as file:
            assert file.attrs["synthetic"] == 1
    assert "SYNTHETIC" in (folder / "campaign.yaml").read_text()
    assert len(campaign_lines(folder)) >= 4
    known = json.loads((truth / "truth.json").read_text())
    assert known["effect"]["name"] == "weak-joint"
    assert known["effect"]["values"]["factor"] == 0.2
    # nothing of it where a diagnosis looks: no name, and no seed from which noise and survey could be drawn again
    for file in folder.iterdir():
        assert b"weak-joint" not in file.read_bytes()
    for name in campaign.tests:
        with xr.open_dataset(folder / f"{name}.nc") as file:
            assert not any("seed" in key for key in file.attrs)


def test_same_settings_same_bytes_and_another_seed_other_readings(make):
    first, second, other = make("a")[0], make("b")[0], make("c", seed=8)[0]
    for name in load_campaign(first).tests:
        same = xr.load_dataset(first / f"{name}.nc")
        xr.testing.assert_identical(same, xr.load_dataset(second / f"{name}.nc"))
        assert not same.equals(xr.load_dataset(other / f"{name}.nc"))


def test_what_an_earlier_call_finished_is_kept(make, monkeypatch):
    folder, _, _ = make()
    shaken = []
    shake = generate.shake
    monkeypatch.setattr(generate, "shake", lambda *values: shaken.append(1) or shake(*values))
    make()
    assert not shaken
    (folder / "motion-200.nc").unlink()
    make()
    assert len(shaken) == 1
    make(source="two")
    assert len(shaken) == 4


def _survey(campaign, name):
    return load_test(campaign, name)["initial_offset"].transpose("body", "axis").to_numpy()


def test_a_restored_stack_is_surveyed_where_it_was_put(make):
    folder, _, _ = make()
    campaign = load_campaign(folder)
    offsets = np.array([_survey(campaign, name) for name in campaign.tests])
    free = offsets[:, 1:, :2]
    assert np.abs(offsets[:, 0]).max() == 0.0
    # 18 draws of PLACED and of a survey noise of a third of it, between a half and twice
    assert 0.5 * PLACED < free.std() < 2.0 * PLACED
    assert np.ptp(free, axis=0).min() > 0.0


def test_a_clock_that_is_ahead_reads_to_the_end(make):
    folder, _, _ = make(
        hidden={"effect": "clock-lag", "values": {"lag": -0.02}},
        intensities={"first": 1.0, "increment": 1.0, "highest": 1.0},
    )
    test = load_test(load_campaign(folder), "motion-100")
    assert np.isfinite(test["marker_displacement"]).all()
    # the times count from the start of the command, which this clock reads 20 ms early
    assert float(test["time"][-1]) == pytest.approx(SETTINGS["duration"] + 0.02, abs=2e-4)


def test_a_ladder_ends_where_a_block_drifts_too_far(make):
    folder, _, said = make(
        intensities={"first": 1.0, "increment": 1.0, "highest": 3.0, "largest_drift": 0.01}
    )
    drifts = [float(line.split()[-2]) for line in said]
    assert len(drifts) < 3
    assert drifts[-1] > 10.0
    assert len(load_campaign(folder).tests) == len(drifts)


def test_a_test_in_which_a_block_falls_is_not_in_the_campaign(make):
    # two blocks of a joint without friction slide apart
    folder, truth, said = make(
        hidden={"effect": "weak-joint", "values": {"factor": 0.0}, "place": {"joint": ["block-2", "block-3"]}},
        motions=["push.csv"], intensities={"first": 1.0, "increment": 1.0, "highest": 2.0},
    )  # fmt: skip
    assert said[-1].startswith("push-200: collapsed")
    assert list(load_campaign(folder).tests) == ["push-100"]
    assert json.loads((truth / "push-200.json").read_text())["status"] == "collapsed"
    assert not (folder / "push-200.nc").exists()


def test_every_effect_is_drawn_by_some_seed_with_a_size_that_shows(stiffness):
    structure, names = load_structure("configuration-2"), set()
    for seed in range(100):
        effect = hidden_effect(Hidden(), structure, seed)
        assert effect == hidden_effect(Hidden(), structure, seed)
        assert effect["place"] in EFFECTS[effect["name"]].places(structure)
        size = EFFECTS[effect["name"]].parameters[0]
        share = abs((effect["values"][size.name] - size.null) / (size.visible - size.null))
        assert 0.49 < share < 1.51
        names.add(effect["name"])
    # a seed misses an effect by (12/13)^100, 3e-4
    assert names == set(EFFECTS)


@pytest.mark.parametrize(("name", "joint"), [("configuration-2", "block"), ("configuration-3", "wall-a")])
def test_of_several_places_the_first_that_the_structure_has_is_taken(name, joint):
    places = [{"joint": [f"{one}-1", f"{one}-2"]} for one in ("block", "wall-a")]
    hidden = Hidden(effect="weak-joint", place=places)
    assert hidden_effect(hidden, load_structure(name), 1)["place"] == {"joint": [f"{joint}-1", f"{joint}-2"]}


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"hidden": {"effect": "ghost"}}, "hidden.effect: expected drawn, none or one of table-pitch"),
        (
            {"hidden": {"effect": "none", "values": {"a": 1.0}}},
            "hidden: expected values and place of a named",
        ),
        ({"sead": 3}, "sead: unknown key"),
        ({"time_step": 0.0}, "time_step: "),
    ],
)
def test_wrong_settings_are_one_line(changed, message, tmp_path):
    path = tmp_path / "settings.yaml"
    path.write_text(yaml.safe_dump({**SETTINGS, **changed}))
    with pytest.raises(InputError) as error:
        load_settings(path)
    assert str(error.value).startswith(f"{path}: {message}")
    assert "\n" not in str(error.value)


OWN = """
name: own
materials: {stone: {density: 2700.0, youngs_modulus: 5.0e+10, poisson_ratio: 0.25}}
shapes: {table: {box: [2.0, 2.0, 0.1]}, block: {box: [0.5, 1.0, 0.8]}}
bodies:
  - {name: table, shape: table, material: stone, position: [0.0, 0.0, -0.05], driven: true}
  - {name: block, shape: block, material: stone, position: [0.0, 0.0, 0.4]}
friction: [{pair: [stone, stone], coefficient: 0.6}]
markers:
  - {name: T1, body: table, position: [0.0, 0.0, 0.05]}
  - {name: B1, body: block, position: [0.25, 0.0, 0.0]}
"""


def test_a_study_of_an_own_structure_accepts_its_campaign(tmp_path, stiffness):
    """Structures are the same by content: the campaign has a copy under another name."""
    own, other = tmp_path / "own.yaml", tmp_path / "other.yaml"
    own.write_text(OWN)
    other.write_text(OWN.replace("0.5, 1.0, 0.8", "0.4, 1.0, 0.8"))
    settings = VirtualCampaign(
        **SETTINGS | {"motions": ["alkion"], "hidden": {"effect": "none"}, "duration": 0.3}
    )
    generate.generate_campaign(settings, str(own), tmp_path / "c", tmp_path / "truth", "one", print)
    measured = {"campaign": str(tmp_path / "c"), "test": "alkion-100"}
    study = {
        "name": "own",
        "description": "own",
        "models": {"nscd-rigid": {"time_step": 1e-3}},
        "cases": [
            {"structure": str(own), "motion": "alkion", "scale": 1.0, "duration": 0.3, "measured": measured}
        ],
        "ensemble": {"size": 10, "seed": 1},
    }
    assert check_config(study, "own.yaml").cases[0].measured.test == "alkion-100"
    study["cases"][0]["structure"] = str(other)
    with pytest.raises(InputError, match="expected a campaign of the structure other"):
        check_config(study, "own.yaml")
