"""Studies whose samples draw records, or are a user's own: what is checked before the first job, and what follows."""

import numpy as np
import pandas as pd
import pytest
import yaml

from blockshake.dynamics.describe_motion import describe_motions
from blockshake.dynamics.intensity import motion_figures
from blockshake.errors import InputError
from blockshake.own_files.check import check
from blockshake.study.config import check_config
from blockshake.study.ensembles.case_input import driving_motions
from blockshake.study.sampling.latin_hypercube import draw_design

PAIR, DENSITY = "friction.stone.stone", "materials.stone.density"


@pytest.fixture
def study(make_mapping, tmp_path, monkeypatch):
    """A cube under two records of a folder, in the current folder."""
    monkeypatch.chdir(tmp_path)
    cube = {"name": "cube", "shape": "cube", "position": [0.0, 0.0, 0.5]}
    structure = make_mapping([cube])
    structure["markers"] = [
        {"name": "slab-face", "body": structure["bodies"][0]["name"], "position": [0.1, 0.0, 0.0]},
        {"name": "cube-face", "body": "cube", "position": [0.1, 0.0, 0.0]},
    ]
    (tmp_path / "cube.yaml").write_text(yaml.safe_dump(structure))
    (tmp_path / "records").mkdir()
    time = np.arange(0.0, 1.0, 0.01)
    for peak in (1, 2):
        rows = [f"{t:.2f},{peak * np.sin(6.0 * t):.6f}" for t in time]
        (tmp_path / "records" / f"sine-{peak}.csv").write_text("\n".join(["time_s,acceleration_x", *rows]))
    return {
        "name": "mine",
        "description": "made up",
        "models": {"nscd-rigid": {"time_step": 1e-3}},
        "cases": [{"structure": "cube.yaml", "motion": "records", "duration": 1.5}],
        "ensemble": {"size": 10, "seed": 1, "distributions": {PAIR: {"mean": 0.6, "cov": 0.1}}},
    }


def refusal(study):
    with pytest.raises(InputError) as error:
        check_config(study, "mine.yaml")
    return str(error.value)


def test_a_folder_as_the_motion_has_the_peak_acceleration_as_its_measure(study):
    case = check_config(study, "mine.yaml").cases[0]
    assert case.intensity.measure == "pga"
    assert case.intensity.levels == ()
    assert case.scale == 1.0
    printed = check_config(study, "mine.yaml").model_dump(mode="json")
    assert check_config(printed, "printed.yaml").cases[0] == case


def test_models_share_the_motion_of_a_sample(study):
    case = check_config(study, "mine.yaml").model_dump(mode="json")["cases"][0]
    first, second = (driving_motions(case, None, 1) for _ in range(2))
    for sample in range(10):
        assert np.array_equal(first(sample).table.coefficients, second(sample).table.coefficients)
    peaks = [motion_figures(first(sample))["peak_acceleration"] for sample in range(10)]
    assert sorted(np.round(peaks, 2)) == [1.0] * 5 + [2.0] * 5


def test_the_record_of_median_peak_is_shown(study):
    described = describe_motions("records", "auto")
    assert described.attrs["name"] == "records, sine-1.csv"
    assert described.attrs["records"] == 2
    assert described["spectra"].sizes["record"] == 2
    assert float(described["spectra"][1, 50]) == pytest.approx(
        2.0 * float(described["spectra"][0, 50]), rel=1e-4
    )


def test_a_bad_record_is_named(study, tmp_path):
    (tmp_path / "records" / "readme.txt").write_text("these are records\n")
    assert refusal(study).startswith("mine.yaml: cases.0.motion: records/readme.txt: expected a motion CSV")


@pytest.mark.parametrize(
    ("intensity", "said"),
    [
        ({"measure": "sa"}, "cases.0.intensity: expected `period` with the measure sa"),
        ({"measure": "pgd"}, "cases.0.intensity.measure: "),
        ({"levels": [2.0, 1.0]}, "cases.0.intensity: expected levels that rise"),
        ({"levels": [0.0]}, "cases.0.intensity.levels.0: "),
    ],
)
def test_a_wrong_intensity_is_named(study, intensity, said):
    study["cases"][0]["intensity"] = intensity
    assert said in refusal(study)


@pytest.mark.parametrize(("levels", "remarked"), [([0.1, 0.15], True), ([0.5, 1.0], False), ([3.0], False)])
def test_levels_that_may_be_in_g_are_remarked(study, tmp_path, levels, remarked):
    study["cases"][0]["intensity"] = {"levels": levels}
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(study))
    assert ("not in g" in check(tmp_path / "mine.yaml")) == remarked


def test_samples_climb_from_one_level(study):
    study["ladder"] = {"first": 1.0}
    study["fragility"] = {"cases": ["cube"], "size": 5}
    study["cases"][0]["intensity"] = {"levels": [1.0, 2.0]}
    assert "fragility.cases: expected cube to have one level" in refusal(study)
    study["cases"][0]["intensity"] = {"levels": [1.0]}
    assert check_config(study, "mine.yaml")


def own_table(tmp_path, size=12, **columns):
    values = {PAIR: np.linspace(0.5, 0.7, size), DENSITY: np.linspace(2600.0, 2400.0, size)} | columns
    pd.DataFrame(values).to_csv(tmp_path / "samples.csv", index=False)


def test_own_samples_stay_as_they_are(study, tmp_path):
    own_table(tmp_path)
    study["ensemble"] = {"table": "samples.csv", "seed": 3}
    ensemble = check_config(study, "mine.yaml").ensemble
    assert ensemble.size == 12
    assert ensemble.distributions[DENSITY].mean == pytest.approx(2500.0)
    design = draw_design(ensemble.model_dump(mode="json"))
    assert design.values[PAIR].tolist() == pytest.approx(np.linspace(0.5, 0.7, 12))
    assert float(design.correlation.loc[PAIR, DENSITY]) == pytest.approx(-1.0)
    assert design.largest_error == 0.0
    printed = study | {"ensemble": ensemble.model_dump(mode="json")}
    assert check_config(printed, "printed.yaml").ensemble == ensemble


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"size": 11}, "mine.yaml: ensemble.size: expected no such key with `table`"),
        ({"table": "none.csv"}, "mine.yaml: ensemble.table: none.csv: expected a readable file"),
    ],
)
def test_keys_beside_a_table_are_refused(study, tmp_path, change, said):
    own_table(tmp_path)
    study["ensemble"] = {"table": "samples.csv", "seed": 3} | change
    assert refusal(study).startswith(said)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ({"friction.stone": np.ones(12)}, "friction.stone: unknown parameter"),
        (
            {"materials.wood.density": np.arange(1.0, 13.0)},
            "ensemble.distributions.materials.wood.density: expected a",
        ),
        ({PAIR: np.full(12, 0.5)}, "expected values that rise"),
        ({PAIR: np.linspace(-0.5, 0.7, 12)}, PAIR),
    ],
)
def test_a_wrong_table_is_named(study, tmp_path, columns, said):
    own_table(tmp_path, **columns)
    study["ensemble"] = {"table": "samples.csv", "seed": 3}
    assert said in refusal(study)


def test_too_few_own_samples_are_refused(study, tmp_path):
    own_table(tmp_path, size=9)
    study["ensemble"] = {"table": "samples.csv", "seed": 3}
    assert "ensemble.size: " in refusal(study)


def test_a_discrete_variable_is_sampled_with_its_correlation(study):
    study["ensemble"]["distributions"][DENSITY] = {
        "distribution": "discrete",
        "values": [2400.0, 2600.0],
        "probabilities": [0.5, 0.5],
    }
    design = draw_design(check_config(study, "mine.yaml").ensemble.model_dump(mode="json"))
    assert sorted(design.values[DENSITY]) == [2400.0] * 5 + [2600.0] * 5
    assert abs(float(design.correlation.loc[PAIR, DENSITY])) < 0.1


def test_a_check_of_a_set_and_of_a_study_tells_its_records(study, tmp_path):
    assert len(check("records").splitlines()) >= 2
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(study))
    told = check("mine.yaml")
    assert "records/sine-2.csv: sine-2.csv" in told
    assert "cube: 10 samples draw 2 motions, each several times" in told
