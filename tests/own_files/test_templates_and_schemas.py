"""Templates are right as they stand, and schemas for editors accept the shipped files."""

import itertools
import json
import subprocess
import sys

import jsonschema
import numpy as np
import pytest
import xarray as xr

from blockshake.cli import main
from blockshake.files import HOME, load_yaml
from blockshake.geometry.structure import load_structure
from blockshake.measurement.motion.body_poses import PLANAR, body_poses
from blockshake.own_files.commands import file_schema
from blockshake.own_files.keys import key_rows
from blockshake.own_files.templates import write_template

SHIPPED = {
    "structure": [*HOME.glob("config/structures/*.yaml"), HOME / "config/templates/structure.yaml"],
    "study": [HOME / f"config/{name}.yaml" for name in ("study", "quick", "paper", "templates/study")],
    "campaign": [
        *HOME.glob("data/virtual-campaign/*/campaign.yaml"),
        HOME / "config/templates/campaign.yaml",
    ],
}


@pytest.mark.parametrize(
    ("kind", "name"), [("structure", "wall.yaml"), ("study", "My Study.yaml"), ("campaign", "lab")]
)
def test_a_template_is_right_as_it_stands(kind, name, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["new", kind, name]) == 0
    assert main(["check", name]) == 0
    said = capsys.readouterr().out
    assert "remark" not in said
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert main(["new", kind, name]) == 2
    assert "nothing is overwritten" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_the_markers_of_the_template_show_the_pose_of_every_block(tmp_path):
    """Without it `plan-campaign` of the template, as in the README, is refused: no effect would show."""
    write_template("structure", tmp_path / "my.yaml")
    structure = load_structure(tmp_path / "my.yaml")
    names = [marker.name for marker in structure.file.markers]
    still = xr.DataArray(np.zeros((9, len(names), 3)), {"marker": names}, ("time", "marker", "axis"))
    known = np.array(body_poses(xr.Dataset({"marker_displacement": still}), structure, 1e-4).known)
    assert set(known[~structure.driven]) == {PLANAR}


def test_a_study_is_named_after_its_file(tmp_path):
    assert main(["new", "study", str(tmp_path / "My Study.yaml")]) == 0
    assert load_yaml(tmp_path / "My Study.yaml")["name"] == "my-study"
    assert main(["new", "study", str(tmp_path / "study.txt")]) == 2
    assert not (tmp_path / "study.txt").exists()


@pytest.mark.slow
def test_the_template_of_a_study_plans_its_jobs(tmp_path):
    assert main(["new", "study", str(tmp_path / "mine.yaml")]) == 0
    command = [
        "-m",
        "snakemake",
        "-n",
        "reports/mine.html",
        "--cores",
        "1",
        "--snakefile",
        HOME / "Snakefile",
    ]
    answer = subprocess.run(
        [sys.executable, *command, "--configfile", "mine.yaml"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert answer.returncode == 0, answer.stderr
    assert "simulate_batch" in answer.stdout


@pytest.mark.parametrize("kind", ["structure", "study", "campaign", "import"])
def test_every_key_of_a_file_is_printed_with_its_meaning(kind, capsys):
    assert main(["keys", kind]) == 0
    lines = capsys.readouterr().out.splitlines()
    keys = [line.split(": ")[0] for line in lines if not line.startswith(" ")]
    assert set(file_schema(kind)["properties"]) == {key for key in keys if "." not in key and "[" not in key}
    assert all(
        below.startswith("    ") and below.strip()
        for line, below in itertools.pairwise(lines)
        if not line.startswith(" ")
    )


def test_a_printed_key_has_kind_unit_and_default(capsys):
    main(["keys", "structure"])
    printed = capsys.readouterr().out
    assert "materials.NAME.viscous_modulus: number at least 0 [Pa s], default 0\n" in printed


def _faults(kind, mapping):
    # as an editor sees YAML: tuples are lists
    return list(
        jsonschema.Draft202012Validator(file_schema(kind)).iter_errors(json.loads(json.dumps(mapping)))
    )


@pytest.mark.parametrize("kind", SHIPPED)
def test_shipped_files_validate(kind):
    assert len(SHIPPED[kind]) > 1
    for path in SHIPPED[kind]:
        assert _faults(kind, load_yaml(path)) == [], path


def test_a_map_validates_with_names_and_entries_of_columns():
    mapping = {
        "name": "a", "structure": "b", "time": 1, "displacement_unit": "mm",
        "columns": {"slab.x": "A", "block.x": {"column": "B", "reversed": True}},
        "tests": [{"name": "t", "file": "t.csv", "motion": "alkion", "scale": 1.0, "role": "fit"}],
    }  # fmt: skip
    assert _faults("import", mapping) == []
    assert len(_faults("import", mapping | {"columns": {"slab.x": {"colum": "A"}}})) == 1


@pytest.mark.parametrize("kind", SHIPPED)
def test_a_misspelt_key_does_not_validate(kind):
    mapping = load_yaml(SHIPPED[kind][0])
    assert _faults(kind, mapping | {"desription": "x"}) != []


def test_the_command_writes_a_schema_that_is_one(tmp_path, capsys):
    for kind in (*SHIPPED, "import"):
        assert main(["schema", kind, "--output", str(tmp_path / "s.json")]) == 0
        assert capsys.readouterr().out == f"{tmp_path / 's.json'}\n"
        assert main(["schema", kind]) == 0
        printed = capsys.readouterr().out
        assert (tmp_path / "s.json").read_text() == printed
        jsonschema.Draft202012Validator.check_schema(json.loads(printed))


def test_a_folder_that_is_neither_a_campaign_nor_records_is_called_so(tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("no motion\n")
    assert main(["check", str(tmp_path)]) == 2
    assert (
        "expected a campaign, or a folder of records alone; it has no campaign.yaml"
        in capsys.readouterr().err
    )


@pytest.mark.parametrize("kind", ["import", "campaign"])
def test_the_scale_of_a_test_has_no_default(kind):
    """A test with a motion needs it, one without has none to multiply."""
    (row,) = [row for row in key_rows(kind) if row[0] == "tests[].scale"]
    assert row == (
        "tests[].scale", "number", "1", "see meaning", "multiplies the motion; needed where there is one; not 0",
    )  # fmt: skip
