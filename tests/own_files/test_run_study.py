"""`blockshake study`: errors with the valid names, progress by case, the folder of the results, one closing line."""

import os
from itertools import product
from pathlib import Path

import pytest
import yaml
from block_on_slab import BLOCK

from blockshake.cli import main
from blockshake.files import HOME, load_yaml
from blockshake.own_files import run_study as of_study
from blockshake.own_files.run_workflow import WorkflowError, workflow_command
from blockshake.study.config import load_config
from blockshake.study.planned_runs import planned_runs
from blockshake.working_folder import hold

STUDY = {
    "name": "mine",
    "description": "two cases of one structure",
    "models": {"ls-dem": {"time_step": 5e-5}, "nscd-rigid": {"time_step": 1e-3}},
    "cases": [
        {"name": name, "structure": "own/block.yaml", "motion": "alkion", "scale": scale, "duration": duration}
        for name, scale, duration in (("weak", 1.0, 1.0), ("strong", 2.0, 2.0))
    ],
    "ensemble": {"size": 10, "seed": 1, "distributions": {
        "friction.stone.stone": {"distribution": "lognormal", "mean": 0.7, "cov": 0.1},
    }},
}  # fmt: skip


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A user's folder with a study and a structure, which is the current one."""
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "block.yaml").write_text(BLOCK)
    (tmp_path / "study.yaml").write_text(yaml.safe_dump(STUDY))
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def workflow(monkeypatch):
    """Commands of workflows that would have run; each states these lines."""
    commands, lines = [], []

    def run(command, hear):
        commands.append(command)
        for line in lines:
            hear(line)
        reports = Path(command[command.index("--directory") + 1], "reports")
        reports.mkdir(exist_ok=True)
        for name in ("mine", "mine-strong"):
            (reports / f"{name}.html").write_text('<div class="box"><p>Both stand.</p></div></section>')
        if lines and lines[-1].startswith("blockshake:"):
            raise WorkflowError(2)

    monkeypatch.setattr(of_study, "run_workflow", run)
    return commands, lines


def sample(case, model, number, took=None, part="samples"):
    ended = "kept: completed" if took is None else f"simulated: completed; took {took} s"
    return f"{part} of {case}, {model}: sample {number}, {ended}"


def test_a_study_runs_where_the_user_is_and_says_where_all_is(folder, workflow, capsys):
    assert main(["study", "study.yaml", "--cores", "3"]) == 0
    checked, *said = capsys.readouterr().out.partition("mine: ")
    assert checked.startswith(
        "study.yaml: a study of 2 cases by ls-dem (10 samples), nscd-rigid (10 samples)\n"
    )
    said = "".join(said).splitlines()
    assert said[0] == f"mine: 48 runs of ls-dem, nscd-rigid, on 3 cores, in {folder}"
    assert said[-2] == "Both stand."
    assert said[-1].endswith("; reports/mine.html, reports/mine.pdf, results/mine/")
    ((*_, command),) = (workflow[0],)
    assert command == workflow_command(3, folder, folder / "study.yaml", "all")
    assert command[command.index("--snakefile") + 1] == str(HOME / "Snakefile")


def test_progress_is_told_by_case_with_the_time_left(folder, workflow, capsys):
    workflow[1].extend(
        [
            *(sample("weak", "nscd-rigid", number, 2.0) for number in range(10)),
            *(sample("weak", "ls-dem", number, 5.0) for number in range(10)),
            "30 of 60 steps (50%) done",
            *(sample("strong", "ls-dem", number) for number in range(10)),
        ]
    )
    assert main(["study", "study.yaml", "--cores", "2"]) == 0
    told = [line for line in capsys.readouterr().out.splitlines() if ": 10 of 10; " in line]
    # nothing is known of LS-DEM; strong runs last twice as long as weak ones, replicates take half the step:
    # 12 x 4 s and 2 x 2 s on 2 cores
    assert told[0] == "samples of weak, nscd-rigid: 10 of 10; 10 of 48 runs; more than 26 s for the runs left"
    # and 12 x 10 s and 2 x 5 s by LS-DEM
    assert told[1] == "samples of weak, ls-dem: 10 of 10; 20 of 48 runs; about 2 min for the runs left"
    # samples that were kept cost nothing
    assert told[2] == (
        "samples of strong, ls-dem: 10 of 10; 30 of 48 runs, 10 of them from the store; about 41 s for the runs left"
    )
    assert len(told) == 3


def test_a_command_that_goes_on_counts_what_is_there(folder, workflow, capsys):
    runs = folder / "results" / "mine" / "runs" / "ls-dem" / "weak"
    runs.mkdir(parents=True)
    for batch in ("000-004", "005-007"):
        (runs / f"{batch}.nc").touch()
    (runs / "half-step.nc").touch()
    workflow[1].extend([*(sample("weak", "ls-dem", number, 2.0) for number in (8, 9))])
    assert main(["study", "study.yaml", "--cores", "1"]) == 0
    said = capsys.readouterr().out.partition("mine: ")[2].splitlines()
    assert said[1] == "10 of them are there from before, and run again only where their input changed"
    assert any(line.startswith("samples of weak, ls-dem: 10 of 10; 12 of 48 runs; ") for line in said)


def test_no_time_is_told_where_none_is_known_and_never_no_time_while_runs_are_left(folder):
    heard = []
    progress = of_study._Progress(load_config("study.yaml"), 1, None, folder, heard.append)
    for number in range(10):
        progress(sample("weak", "ls-dem", number))
    assert heard[-1].endswith(
        "10 of 48 runs, 10 of them from the store; the time of the runs left is not known yet"
    )
    for case, model in (("strong", "ls-dem"), ("weak", "nscd-rigid"), ("strong", "nscd-rigid")):
        for number in range(10):
            progress(sample(case, model, number, 0.01))
        assert " 0 s" not in heard[-1]
    for case, model in product(("weak", "strong"), ("ls-dem", "nscd-rigid")):
        assert heard[-1].endswith(" for the runs left")
        progress(sample(case, model, 0, 0.02, "replicate"))
    assert heard[-1].endswith(
        "48 of 48 runs, 10 of them from the store; all runs are done, and the jobs after them are left"
    )


def test_a_command_without_anything_to_do_says_so(folder, workflow, capsys):
    workflow[1].append("Nothing to be done (all requested files are present and up to date).")
    assert main(["study", "study.yaml"]) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("mine: nothing was due; reports/mine.html, ")


def test_every_run_that_the_estimate_lists_is_counted_by_its_own_lines(folder):
    """Twins, climbing samples and calibrations are no samples of the study, whatever their case is called."""
    climbs = {"model": "nscd-rigid", "cases": ["weak"], "size": 4}
    ladder = {"first": 1.0, "increment": 1.0, "highest": 3.0}
    (folder / "study.yaml").write_text(yaml.safe_dump(STUDY | {"fragility": climbs, "ladder": ladder}))
    heard, config = [], load_config("study.yaml")
    progress = of_study._Progress(config, 1, None, folder, heard.append)
    parts = [
        one for case in config.cases for model in config.models for one in planned_runs(config, model, case)
    ]
    assert list(progress.parts.values()) == parts
    assert progress.total == sum(one.count for one in parts) == 48 + 4 * 3
    progress(sample("weak", "ls-dem", 0, 1.0))
    progress(sample("weak", "ls-dem", 0, 1.0, "replicate"))
    assert progress.done["samples of weak, ls-dem"] == {"sample 0"}
    assert progress.runs_left() == 60 - 1 - 2
    for number in range(4):
        progress(f"fragility of weak, nscd-rigid: sample {number}, passed 3, completed; took 6 s")
    assert heard[-1].startswith("fragility of weak, nscd-rigid: 4 of 4; 15 of 60 runs; about ")
    assert progress.runs_left() == 60 - 15
    progress("calibration of weak, ls-dem: sample 1 in t1, simulated: completed; took 1 s")
    assert progress.runs_left() == 60 - 15


def test_a_model_with_a_name_of_its_own_is_told_by_it(folder):
    study = STUDY | {"models": STUDY["models"] | {"ls-dem-as-printed": {"time_step": 5e-5}}}
    (folder / "study.yaml").write_text(yaml.safe_dump(study))
    heard = []
    progress = of_study._Progress(load_config("study.yaml"), 1, None, folder, heard.append)
    for number in range(10):
        progress(sample("weak", "ls-dem-as-printed", number, 1.0))
    assert heard[-1].startswith("samples of weak, ls-dem-as-printed: 10 of 10; 10 of 72 runs; ")


def test_the_study_in_the_very_folder_of_the_output_is_left_as_it_is(folder, workflow):
    before = (folder / "study.yaml").read_bytes()
    assert main(["study", "study.yaml", "--output", "."]) == 0
    assert (folder / "study.yaml").read_bytes() == before
    assert not (folder / "mine.yaml").exists()


def test_one_case_is_run_and_reported_alone(folder, workflow, capsys):
    assert main(["study", "study.yaml", "--case", "strong"]) == 0
    assert "reports/mine-strong.html" in workflow[0][0]
    said = capsys.readouterr().out
    assert "mine: 24 runs" in said
    assert said.endswith("; reports/mine-strong.html, reports/mine-strong.pdf, results/mine/\n")


def test_another_folder_gets_the_study_with_paths_from_there(folder, workflow, capsys):
    assert main(["study", "study.yaml", "--output", "out/first"]) == 0
    there = folder / "out" / "first"
    moved = load_yaml(there / "mine.yaml")
    assert [case["structure"] for case in moved["cases"]] == ["../../own/block.yaml"] * 2
    assert [case["motion"] for case in moved["cases"]] == ["alkion"] * 2  # a shipped name is no path
    assert workflow[0][0] == workflow_command(os.cpu_count(), there, there / "mine.yaml", "all")
    assert "out/first/reports/mine.html" in capsys.readouterr().out.splitlines()[-1]
    os.chdir(there)
    assert load_config("mine.yaml").name == "mine"
    assert not (folder / "results").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere.yaml"], "nowhere.yaml"),
        (
            ["study.yaml", "--case", "middle"],
            "study.yaml: case: expected one of weak, strong, not 'middle'",
        ),
        (["study.yaml", "--cores", "0"], "expected a whole number from 1, not 0"),
        (["own/block.yaml"], "own/block.yaml"),
        (["study.yaml", "--output", "/dev/null/x"], "/dev/null"),
    ],
)
def test_bad_input_is_one_line_and_makes_nothing(folder, workflow, capsys, arguments, message):
    before = sorted(folder.rglob("*"))
    assert main(["study", *arguments]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert workflow[0] == []
    assert sorted(folder.rglob("*")) == before


def test_a_second_study_in_the_folder_is_refused(folder, workflow, capsys):
    held = hold(folder)
    assert main(["study", "study.yaml"]) == 2
    os.close(held)
    assert "expected a folder in which no other study or diagnosis runs" in capsys.readouterr().err
    assert workflow[0] == []


def test_the_last_lines_of_a_workflow_that_fails_are_its_reason(folder, workflow, capsys):
    workflow[1].extend(
        ["Select jobs", "Not finished. All is kept.", "  job: one", "blockshake: a file is missing"]
    )
    assert main(["study", "study.yaml"]) == 2
    assert capsys.readouterr().err.splitlines() == workflow[1][1:]


def test_a_workflow_that_dies_without_a_word_shows_its_last_lines(folder, monkeypatch, capsys):
    def run(command, hear):
        hear("Killed")
        hear.explain(1)
        raise WorkflowError(1)

    monkeypatch.setattr(of_study, "run_workflow", run)
    assert main(["study", "study.yaml"]) == 1
    assert capsys.readouterr().err == "Killed\n"


def test_the_shipped_template_names_the_command():
    assert "blockshake study FILE" in Path(HOME, "config", "templates", "study.yaml").read_text()
