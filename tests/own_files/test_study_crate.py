"""A finished study as a research object: the musts of RO-Crate 1.1 and of the Workflow Run Crate profile 0.5."""

import hashlib
import json
import os
from urllib.parse import unquote

import pytest
import xarray as xr
import yaml
from block_on_slab import BLOCK

from blockshake.cli import main
from blockshake.files import HOME

END = 1_790_000_000  # s since 1970: 2026-09-21, 14:13:20 UTC
STUDY = {
    "name": "mine",
    "description": "a block under a record",
    "models": {"nscd-rigid": {"time_step": 1e-3}},
    "cases": [{"structure": "own/block.yaml", "motion": "alkion", "duration": 1.0}],
    "ensemble": {"size": 10, "seed": 1, "distributions": {
        "friction.stone.stone": {"distribution": "empirical", "file": "slip tests.csv", "column": "mu"},
    }},
}  # fmt: skip


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Folder of a study that has run, which is the current one."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "block.yaml").write_text(BLOCK)
    (tmp_path / "slip tests.csv").write_text("mu\n" + "".join(f"{0.6 + 0.01 * k}\n" for k in range(10)))
    (tmp_path / "study.yaml").write_text(yaml.safe_dump(STUDY))
    runs = tmp_path / "results" / "mine" / "runs" / "nscd-rigid" / "block"
    runs.mkdir(parents=True)
    xr.Dataset(attrs={"blockshake_version": "0.8.1"}).to_netcdf(runs / "000-009.nc")
    (tmp_path / "results" / "mine" / "responses.csv").write_text("sample\n0\n")
    (tmp_path / "reports").mkdir()
    for kind in ("html", "pdf"):
        (tmp_path / "reports" / f"mine.{kind}").write_text("a report")
    for path in (*tmp_path.glob("results/**/*.*"), *tmp_path.glob("reports/*")):
        os.utime(path, (END, END))
    return tmp_path


@pytest.fixture
def crate(folder):
    """Entities of the crate of this study, by their identifiers."""
    assert main(["export", "study.yaml", "--ro-crate", "--output", "crate"]) == 0
    metadata = json.loads((folder / "crate" / "ro-crate-metadata.json").read_text())
    assert metadata["@context"] == [
        "https://w3id.org/ro/crate/1.1/context",
        "https://w3id.org/ro/terms/workflow-run/context",
    ]
    return {entity["@id"]: entity for entity in metadata["@graph"]}


def references(value):
    """Every ``{"@id": ...}`` inside of a value."""
    if isinstance(value, dict):
        return (
            [value["@id"]]
            if set(value) == {"@id"}
            else [x for one in value.values() for x in references(one)]
        )
    return [x for one in value for x in references(one)] if isinstance(value, list) else []


def ids(entity, key):
    return references(entity[key])


def test_the_metadata_say_what_they_conform_to(crate):
    descriptor, root = crate["ro-crate-metadata.json"], crate["./"]
    assert ids(descriptor, "about") == ["./"]
    assert "https://w3id.org/ro/crate/1.1" in ids(descriptor, "conformsTo")
    assert set(ids(root, "conformsTo")) == {
        "https://w3id.org/ro/wfrun/process/0.5",
        "https://w3id.org/ro/wfrun/workflow/0.5",
        "https://w3id.org/workflowhub/workflow-ro-crate/1.0",
    }
    assert (root["name"], root["description"]) == ("mine", "a block under a record")
    assert root["datePublished"] == "2026-09-21"
    assert "No licence" in root["license"]


def test_every_reference_leads_to_an_entity(crate):
    found = {name for entity in crate.values() for name in references(entity)}
    assert found - set(crate) == {"https://w3id.org/ro/crate/1.1"}


def test_every_file_of_the_crate_is_there_with_its_digest(crate, folder):
    files = {name: one for name, one in crate.items() if "File" in one["@type"]}
    assert set(ids(crate["./"], "hasPart")) == set(files)
    for name, entity in files.items():
        data = (folder / "crate" / unquote(name)).read_bytes()
        assert entity["sha256"] == hashlib.sha256(data).hexdigest()
        assert entity["contentSize"] == str(len(data))
    there = {
        str(path.relative_to(folder / "crate")) for path in (folder / "crate").rglob("*") if path.is_file()
    }
    assert there == {*map(unquote, files), "ro-crate-metadata.json"}


def test_the_run_has_its_workflow_inputs_results_and_end(crate):
    main_entity = crate[ids(crate["./"], "mainEntity")[0]]
    assert {"File", "SoftwareSourceCode", "ComputationalWorkflow"} == set(main_entity["@type"])
    assert main_entity["version"] == "0.8.1"  # of the runs, not of the program that exports them
    assert crate[ids(main_entity, "programmingLanguage")[0]]["name"] == "Snakemake"
    (action,) = [one for one in crate.values() if one["@type"] == "CreateAction"]
    assert ids(crate["./"], "mentions") == [action["@id"]]
    assert ids(action, "instrument") == [main_entity["@id"]]
    assert action["endTime"] == "2026-09-21T14:13:20+00:00"
    assert set(ids(action, "object")) == {
        "study.yaml", "own/block.yaml", "slip%20tests.csv", "config/motions/alkion.yaml",
    }  # fmt: skip
    assert set(ids(action, "result")) == {
        "reports/mine.html", "reports/mine.pdf", "results/mine/responses.csv",
        "results/mine/runs/nscd-rigid/block/000-009.nc",
    }  # fmt: skip
    assert not {"agent", "startTime"} & set(action)  # nothing tells them


def test_the_workflow_of_the_crate_is_whole(crate):
    own = {f"workflow/{path.relative_to(HOME / 'workflow')}" for path in (HOME / "workflow").rglob("*.smk")}
    assert own <= set(crate)


def test_the_same_study_gives_the_same_crate(crate, folder):
    assert main(["export", "study.yaml", "--ro-crate", "--output", "again"]) == 0
    one, other = ((folder / name / "ro-crate-metadata.json").read_bytes() for name in ("crate", "again"))
    assert one == other


def test_files_from_elsewhere_keep_their_names(folder, monkeypatch):
    (folder / "elsewhere").mkdir()
    (folder / "elsewhere" / "results").symlink_to(folder / "results")
    (folder / "elsewhere" / "reports").symlink_to(folder / "reports")
    table = STUDY["ensemble"]["distributions"]["friction.stone.stone"] | {"file": "../slip tests.csv"}
    study = STUDY | {"cases": [STUDY["cases"][0] | {"structure": "../own/block.yaml"}]}
    study["ensemble"] = STUDY["ensemble"] | {"distributions": {"friction.stone.stone": table}}
    (folder / "elsewhere" / "study.yaml").write_text(yaml.safe_dump(study))
    monkeypatch.chdir(folder / "elsewhere")
    assert main(["export", "study.yaml", "--ro-crate", "--output", "crate"]) == 0
    graph = json.loads((folder / "elsewhere" / "crate" / "ro-crate-metadata.json").read_text())["@graph"]
    moved = [one for one in graph if one["@id"].startswith("inputs/")]
    assert {one["alternateName"] for one in moved} == {"slip tests.csv", "block.yaml"}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda folder: (folder / "reports" / "mine.pdf").unlink(), "a finished study: reports/mine.pdf is not"),
        (lambda folder: (folder / "crate" / "own").mkdir(parents=True), "crate: expected a new or an empty folder"),
        (lambda folder: (folder / "study.yaml").unlink(), "study.yaml: "),
    ],
)  # fmt: skip
def test_what_cannot_be_exported_is_refused_in_one_line(folder, capsys, change, words):
    change(folder)
    assert main(["export", "study.yaml", "--ro-crate", "--output", "crate"]) == 2
    assert words in capsys.readouterr().err
    assert not (folder / "crate" / "ro-crate-metadata.json").exists()


def test_meshes_of_a_run_are_no_option_of_a_study(folder, capsys):
    assert main(["export", "study.yaml", "--ro-crate", "--meshes", "own", "--output", "crate"]) == 2
    assert (
        capsys.readouterr().err == "blockshake: --meshes: own: expected a run, not `--ro-crate` of a study\n"
    )
