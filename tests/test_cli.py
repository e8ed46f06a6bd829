"""The command line of docs/guide/contracts.md: files, messages and exit codes."""

import json
import os
import re
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml

import blockshake
from blockshake.cli import BAD_INPUT, UNREAD, main
from blockshake.errors import InputError
from blockshake.files import HOME, check_output, load_yaml, shipped, write_text
from blockshake.simulation.models import MODELS


def test_simulate_writes_a_run_file(tmp_path, capsys):
    output = tmp_path / "run.nc"
    code = main(
        ["simulate", "--structure", "configuration-1", "--motion", "alkion", "--scale", "0.5", "--duration", "0.1",
         "--model", "nscd-rigid", "--set", "friction.foundation.concrete=0.6", "--set", "nscd.tolerance=1e-5",
         "--output-rate", "100", "--output", str(output)]
    )  # fmt: skip
    assert code == 0
    run = xr.load_dataset(output)
    assert run.sizes["time"] == 11
    acted = json.loads(run.attrs["parameters"])
    assert acted["friction.concrete.foundation"] == 0.6
    assert acted["nscd.tolerance"] == 1e-5
    assert run.attrs["motion_scale"] == 0.5
    assert run.attrs["motion_synthetic"] == 1
    said = capsys.readouterr()
    assert said.err == ""
    answer, *lines = said.out.splitlines()
    assert re.fullmatch(r".*run\.nc: no block fell in 0\.1 s; computed in \S+ s", answer)
    found = re.findall(
        r"^  largest (?:drift|lift): (\S+) mm, block-\d at \S+ s", "\n".join(lines), re.MULTILINE
    )
    moved = run["position"] - run["position"].sel(body="slab")
    moved = 1e3 * (moved - moved.isel(time=0))
    largest = np.hypot(moved.sel(axis="x"), moved.sel(axis="y")).max(), moved.sel(axis="z").max()
    assert found == [f"{float(one):.3g}" for one in largest]


def test_several_models_at_once(tmp_path, capsys):
    models = ("ls-dem", "nscd-rigid")
    asked = ["simulate", "--structure", "configuration-1", "--motion", "alkion", "--duration", "0.1"]
    asked += [word for model in models for word in ("--model", model)]
    assert main([*asked, "--output", str(tmp_path / "run.nc")]) == 0
    files = [tmp_path / f"run-{model}.nc" for model in models]
    assert sorted(tmp_path.iterdir()) == sorted(files)
    assert [xr.load_dataset(file).attrs["model"] for file in files] == list(models)
    answers = [line for line in capsys.readouterr().out.splitlines() if not line.startswith(" ")]
    assert [line.partition(":")[0] for line in answers] == list(map(str, files))
    assert main([*asked, "--model", "dem", "--output", str(tmp_path / "other.nc")]) == 2
    assert sorted(tmp_path.iterdir()) == sorted(files)


def test_sample_and_its_table(tmp_path):
    output = tmp_path / "design.csv"
    assert main(["sample", "--size", "12", "--seed", "3", "--output", str(output)]) == 0
    design = pd.read_csv(output)
    assert design.shape == (12, 9)
    assert design.columns[0] == "friction.concrete.concrete"


def test_convert_motion_round_trip(tmp_path, capsys):
    assert main(["convert-motion", "basso-tirreno", "--output", str(tmp_path / "m.csv")]) == 0
    assert f"{tmp_path / 'm.csv'}: a motion of " in capsys.readouterr().out
    assert (tmp_path / "m.csv").read_text().splitlines()[0].startswith("time_s,acceleration_x")
    assert main(["check", str(tmp_path / "m.csv")]) == 0


def test_numerical_failure_keeps_what_was_computed(tmp_path, capsys):
    output = tmp_path / "run.nc"
    # ten times the stable step of the stiffest contact
    code = main(
        ["simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", "ls-dem", "--duration", "0.5",
         "--time-step", "5e-3", "--output", str(output)]
    )  # fmt: skip
    assert code == 3
    assert xr.load_dataset(output).attrs["status"] == "diverged"
    assert "diverged" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["simulate"], "the following arguments are required"),
        (["jump"], "jump"),
        (["check", "nowhere.yaml"], "nowhere.yaml: expected a readable file"),
        (["sample", "--size", "5", "--output", "x.csv"], "10"),
        (["sample", "--size", "1_0", "--output", "x.csv"], "invalid int value: '1_0'"),
        (["simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", "ls-dem", "--scale", "1_0",
          "--output", "x.nc"], "invalid float value: '1_0'"),
        (["simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", "ls-dem",
          "--set", "restitution", "--output", "x.nc"], "--set: restitution: expected KEY=VALUE"),
        (["simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", "ls-dem", "--set",
          "friction.wood.wood=1", "--output", "x.nc"], "friction.wood.wood"),
        (["calibrate-stiffness", "--structure", "configuration-1", "--set", "restitution=0.1", "--set",
          "restitution=0.2", "--output", "x.json"], "--set: restitution=0.2: expected restitution once"),
        (["simulate", "--scale", "1", "--scale", "2"], "blockshake simulate: expected --scale once"),
        (["convert-motion", "m.csv", "--decimal", ",", "--decimal", "."], "expected --decimal once"),
        (["simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", "ls-dem", "--duration", "-1",
          "--output", "x.nc"], "--duration: expected a positive number"),
        (["simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", "nscd-rigid", "--time-step",
          "0.5", "--output", "x.nc"], "--time-step: expected at most 0.01 s"),
    ],
)  # fmt: skip
def test_bad_input_is_one_line_and_exit_2(arguments, line, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    said = capsys.readouterr().err.strip().splitlines()
    assert len(said) == 1
    assert line in said[0]
    assert list(tmp_path.iterdir()) == []


def test_simulate_remarks_a_setting_without_use_and_one_in_another_unit(capsys, caplog, tmp_path):
    caplog.set_level("INFO", logger="blockshake")
    call = ["simulate", "--structure", "configuration-1", "--motion", "alkion", "--model", "nscd-rigid"]
    call += ["--duration", "0.1", "--set", "restitution=0.9", "--set", "gravity=[0, 0, -9810]"]
    assert main([*call, "--output", str(tmp_path / "x.nc")]) in (0, 3)
    assert "remark: restitution has no effect on nscd-rigid, which has nscd_restitution" in caplog.messages
    assert any(said.endswith("is usual; perhaps given in mm/s2") for said in caplog.messages)


def test_simulate_remarks_a_motion_that_is_hardly_meant(capsys, caplog, tmp_path):
    """Accelerations in g taken as m/s2; the run itself is refused."""
    path = tmp_path / "weak.csv"
    path.write_text("time_s,acceleration_x\n0,0\n0.5,0.3\n1,0\n")
    run = ["--structure", "configuration-1", "--model", "nscd-rigid", "--duration", "-1"]
    assert main(["simulate", *run, "--motion", str(path), "--output", str(tmp_path / "x.nc")]) == 2
    assert "remark: the peak acceleration is 0.031 g: expected m/s2, not g" in caplog.text


def test_parameters_lists_units_and_sources(capsys):
    assert main(["parameters"]) == 0
    table = capsys.readouterr().out
    for word in (
        "friction.concrete.concrete",
        "kg/m3",
        "ls_dem.normal_stiffness",
        "nscd.tolerance",
        "Table 2",
    ):
        assert word in table


def test_functions_of_the_package():
    for name in ("load_structure", "load_motion", "simulate", "draw_samples", "calibrate_stiffness"):
        assert callable(getattr(blockshake, name))
    with pytest.raises(AttributeError):
        blockshake.no_such_name  # noqa: B018


def test_help_lists_the_models_and_loads_no_compiler():
    command = "import sys; from blockshake.cli import main\ntry: main(['simulate', '--help'])\nfinally: "
    command += "assert not {'numba', 'numpy'} & set(sys.modules)"
    said = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True, check=True).stdout
    for name, model in MODELS.items():
        assert f"{model.time_step:g} for {name}" in " ".join(said.split())


@pytest.mark.parametrize("output", ["", ".", "file/run.nc", "run.csv"])
def test_output_that_cannot_be_written_is_bad_input_before_anything_runs(
    output, capsys, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    code = main(
        ["simulate", "--structure", "no-such", "--motion", "alkion", "--model", "ls-dem", "--output", output]
    )
    assert code == 2
    assert "no-such" not in capsys.readouterr().err


def test_step_too_large_to_trust_is_a_numerical_failure(tmp_path, capsys):
    """Half of the step at which it blows up: the run ends, but its energy audit tells."""
    code = main(
        ["simulate", "--structure", "configuration-1", "--motion", "basso-tirreno", "--scale", "2.25",
         "--duration", "4", "--model", "ls-dem", "--time-step", "5e-4", "--output", str(tmp_path / "run.nc")]
    )  # fmt: skip
    assert code == 3
    assert xr.load_dataset(tmp_path / "run.nc").attrs["status"] in ("not-converged", "diverged")


def test_an_interrupt_before_a_run_has_begun_is_said_too(monkeypatch, capsys):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("blockshake.own_files.check.check", interrupted)
    assert main(["check", "configuration-1"]) == 130
    assert capsys.readouterr().err == "blockshake: interrupted\n"


def test_a_run_is_plotted_animated_and_exported(leaning_file, tmp_path, capsys):
    for command, output in (
        ("plot", "a.svg"),
        ("animate", "a.gif"),
        ("export", "a.glb"),
        ("export", "a.csv"),
    ):
        assert main([command, str(leaning_file), "--output", str(tmp_path / output)]) == 0
    said = capsys.readouterr().out.split()
    assert {path.name for path in tmp_path.iterdir()} == {path.rsplit("/", 1)[1] for path in said}
    assert str(tmp_path / "a-joints.csv") in said


def test_check_draws_the_structure(tmp_path):
    assert main(["check", "configuration-1", "--picture", str(tmp_path / "a.png")]) == 0
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["plot", "RUN", "--output", "a.jpg"], "a.jpg: expected a picture's suffix"),
        (["animate", "RUN", "--output", "a.avi"], "a.avi: expected a suffix of moving pictures"),
        (["animate", "RUN", "--output", "a.gif", "--speed", "-1"], "--speed: expected a positive number"),
        (["export", "RUN", "--output", "a.vtu"], "a.vtu: expected one of the suffixes"),
        (["export", "RUN", "--output", "file/a.csv"], "file/a.csv: expected a folder to write to"),
        (["plot", "file", "--output", "a.png"], "file: expected a readable netCDF file"),
        (["plot", "none.nc"], "none.nc: expected a run file"),
        (["check", "alkion", "alkion", "--picture", "a.png"], "--picture: expected one structure"),
        (["check", "alkion", "--picture", "a.png"], "alkion"),
    ],
)
def test_a_picture_or_export_that_cannot_be_made_leaves_nothing(
    arguments, line, leaning_file, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    assert main([str(leaning_file) if word == "RUN" else word for word in arguments]) == 2
    (said,) = capsys.readouterr().err.splitlines()
    assert line in said
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", "--structure", "nothing", "--motion", "alkion", "--model", "nscd-rigid"],
        ["plot", "nothing.nc"],
        ["export", "nothing.nc"],
        ["animate", "nothing.nc"],
        ["convert-motion", "nothing.csv"],
        ["sample", "--correlation", "nothing.csv"],
        ["calibrate-stiffness", "--structure", "nothing"],
        ["import-campaign", "nothing.yaml"],
        ["generate-campaign", "nothing.yaml", "--structure", "configuration-1", "--truth", "new/truth"],
        ["diagnose", "nothing"],
        ["plan-campaign", "nothing", "--motions", "alkion"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_a_command_that_fails_leaves_no_folder_and_one_line(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    suffix = {"simulate": ".nc", "plot": ".png", "export": ".csv", "animate": ".gif"}.get(arguments[0], "")
    assert main([*arguments, "--output", f"new/deep/output{suffix}"]) == 2
    assert list(tmp_path.iterdir()) == []
    assert capsys.readouterr().err.count("\n") == 1


def test_a_check_of_several_files_says_last_how_many_are_wrong(tmp_path, capsys):
    (tmp_path / "bad.yaml").write_text("bodies: []\n")
    assert main(["check", "configuration-1", str(tmp_path / "bad.yaml"), "configuration-2"]) == 2
    assert capsys.readouterr().err.splitlines()[-1] == "blockshake: 1 of 3 files is wrong"


def test_a_missing_folder_is_made_with_the_file_alone(tmp_path):
    path = tmp_path / "new" / "deep" / "file.txt"
    assert check_output(path) == path
    assert list(tmp_path.iterdir()) == []
    write_text(path, "x")
    assert path.read_text() == "x"
    with pytest.raises(InputError, match="expected a folder to write to"):
        check_output(path / "below")


def _process(command, tmp_path, output=subprocess.PIPE, **environment):
    return subprocess.Popen(
        [sys.executable, "-m", "blockshake", *command], cwd=tmp_path, stdout=output, stderr=subprocess.PIPE,
        env={**os.environ, **environment},
    )  # fmt: skip


@pytest.mark.parametrize(
    "command", [["parameters"], ["--help"], ["sample", "--size", "10", "--output", "d.csv"]], ids=" ".join
)
def test_a_reader_that_has_gone_is_no_fault(command, tmp_path):
    """As after `| head -1`: no traceback, whether the pipe closes at the first line or at the last flush."""
    running = _process(command, tmp_path)
    running.stdout.close()
    complaint = running.stderr.read().decode()
    assert running.wait(timeout=120) in (0, UNREAD)
    assert complaint == ""


def test_a_full_disk_behind_the_output_is_one_line(tmp_path):
    with open("/dev/full", "wb") as full:
        running = _process(["parameters"], tmp_path, full)
        complaint = running.stderr.read().decode()
    assert running.wait(timeout=120) == BAD_INPUT
    assert complaint == "blockshake: output: expected room to write to; the disk is full\n"


PLAIN = {"LC_ALL": "C", "LANG": "", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}  # ASCII and nothing else


def test_a_terminal_that_knows_no_other_signs_gets_escapes(tmp_path):
    structure = load_yaml(shipped("structures", "configuration-1"))
    structure["bodies"][1]["name"] = "bloc-\u00e9\u00b5"
    for sensor in [*structure["markers"], *structure["accelerometers"], *structure.get("stoppers", [])]:
        sensor["body"] = "bloc-\u00e9\u00b5" if sensor["body"] == "block-1" else sensor["body"]
    (tmp_path / "s.yaml").write_text(yaml.safe_dump(structure, allow_unicode=True), encoding="utf-8")
    running = _process(["parameters", "--structure", "s.yaml"], tmp_path, **PLAIN)
    said, complaint = running.communicate(timeout=120)
    assert (running.returncode, complaint) == (0, b"")
    assert b"bodies.bloc-\\xe9\\xb5.position" in said


@pytest.mark.parametrize("environment", [{}, PLAIN], ids=["UTF-8", "C"])
def test_a_process_refuses_an_output_whose_name_is_not_utf_8_in_one_line(environment, tmp_path):
    running = _process(["sample", "--size", "10", "--output", b"a\xff"], tmp_path, **environment)
    said, complaint = running.communicate(timeout=120)
    assert running.returncode == BAD_INPUT, complaint
    assert said == b""
    assert complaint.decode().count("\n") == 1
    assert "expected a path in UTF-8" in complaint.decode()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "command",
    [
        ["sample", "--size", "10", "--output"], ["convert-motion", "alkion", "--output"],
        ["new", "structure"], ["schema", "structure", "--output"],
        ["export", "RUN", "--output"], ["plot", "RUN", "--output"], ["animate", "RUN", "--output"],
        ["generate-campaign", "SETTINGS", "--structure", "configuration-1", "--truth", "t", "--output"],
    ],
    ids=lambda command: command[0],
)  # fmt: skip
def test_every_command_refuses_an_output_whose_name_is_not_utf_8(
    command, tmp_path, leaning_file, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    given = {"RUN": str(leaning_file), "SETTINGS": str(HOME / "config" / "virtual-campaign.yaml")}
    suffix = {"export": ".csv", "plot": ".png", "animate": ".gif", "new": ".yaml"}.get(command[0], "")
    command = [given.get(word, word) for word in command]
    assert main([*command, os.fsdecode(b"a\xff") + suffix]) == BAD_INPUT
    said, complaint = capsys.readouterr()
    assert said == ""
    assert complaint.count("\n") == 1
    assert "expected a path in UTF-8" in complaint
    assert list(tmp_path.iterdir()) == []
