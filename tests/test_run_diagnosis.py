"""The command's bad input: one clear line, exit 2, nothing half-written."""

import os
import shutil

import pytest

from blockshake import run_diagnosis
from blockshake.cli import main
from blockshake.errors import InputError
from blockshake.files import PACKAGE
from blockshake.own_files import run_workflow
from blockshake.pages.blocks import Box, Document, Heading, Items, Section, Text, numbered
from blockshake.pages.writing import write_html
from blockshake.working_folder import hold, this_command

CAMPAIGN = PACKAGE.parents[1] / "data" / "virtual-campaign" / "configuration-1"


def _changed(folder, change):
    copy = folder / "campaign"
    shutil.copytree(CAMPAIGN, copy)
    path = copy / "campaign.yaml"
    path.write_text(change(path.read_text()))
    return copy


BAD = {
    "sealed tests only": (
        lambda text: text.replace("role: fit", "role: sealed").replace("role: select", "role: sealed"),
        "expected a test with the role fit or select",
    ),
    "a motion nobody has": (
        lambda text: text.replace("motion: alkion,", "motion: nothing,"),
        "expected a shipped motion",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_a_campaign_that_cannot_be_diagnosed(tmp_path, capsys, case):
    change, message = BAD[case]
    output = tmp_path / "output"
    assert main(["diagnose", str(_changed(tmp_path, change)), "--output", str(output)]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert not output.exists()


@pytest.mark.parametrize("cores", [0, -3])
def test_a_number_of_cores_that_is_none(tmp_path, capsys, cores):
    output = tmp_path / "output"
    assert main(["diagnose", str(CAMPAIGN), "--output", str(output), "--cores", str(cores)]) == 2
    assert capsys.readouterr().err.count(f"expected a whole number from 1, not {cores}") == 1
    assert not output.exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nowhere", "--output", "x"], "nowhere"),
        ([str(CAMPAIGN), "--output", "x", "--effort", "most"], "expected one of quick, standard, deep"),
        ([str(CAMPAIGN), "--output", "/dev/null/x"], "/dev/null"),
    ],
)
def test_bad_arguments(capsys, arguments, message):
    assert main(["diagnose", *arguments]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_a_diagnosis_beside_another_command_is_refused_and_touches_nothing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    held = hold(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    assert main(["diagnose", str(CAMPAIGN), "--output", str(tmp_path / "output")]) == 2
    os.close(held)
    error = capsys.readouterr().err
    assert "expected a folder in which no other study or diagnosis runs" in error
    assert error.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before


def test_the_workflow_ends_with_the_diagnosis_and_works_in_its_folder(tmp_path, monkeypatch):
    """A diagnosis that is killed leaves no workflow behind, which would hold the folder; another folder is free."""
    given, folder, held = {}, tmp_path / "own", hold(tmp_path)
    folder.mkdir()

    class Stopped:
        stdout = ()

        def __init__(self, command, env, **_):
            given.update(env, folder=command[command.index("--directory") + 1])

        def __enter__(self):
            return self

        def __exit__(self, *_):
            return None

        def wait(self):
            return 1

    monkeypatch.chdir(folder)
    monkeypatch.setattr(run_workflow.subprocess, "Popen", Stopped)
    with pytest.raises(run_workflow.WorkflowError, match="the workflow stopped"):
        run_diagnosis.diagnose(CAMPAIGN, tmp_path / "new" / "output")
    os.close(held)
    assert not (tmp_path / "new").exists()
    assert this_command().items() <= given.items()
    assert given["folder"] == str(folder)


def test_functions_of_the_package_are_no_modules(tmp_path):
    """A module of a function's name takes its place as soon as the module is imported."""
    import blockshake

    for name in blockshake.__all__:
        assert not list(PACKAGE.glob(f"{name}.py")), name
    from blockshake import diagnose

    with pytest.raises(InputError, match="nowhere"):
        diagnose("nowhere", tmp_path)


def test_the_terminal_has_the_answer_of_the_report(tmp_path, capsys, monkeypatch):
    def diagnose(campaign, output, *arguments):
        facts = (("Chance without a cause", "p = 0.03", "upper bound"),)
        blocks = (
            Box("Probable: a weak joint.", facts),
            Text("Until then: use 1.3."),
            Items(("Next: tilt & see.",)),
        )
        later = (Heading("Later", "later"), Text("Not on this screen."))
        sections = Section("Answer", "answer", blocks), Section("Odds", "odds", later)
        write_html(output + "/report.html", numbered(Document("title", "subtitle", sections)))

    monkeypatch.setattr(run_diagnosis, "diagnose", diagnose)
    assert main(["diagnose", str(CAMPAIGN), "--output", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "Probable: a weak joint.",
        "  Chance without a cause: p = 0.03; upper bound",
        "Until then: use 1.3.",
        "  Next: tilt & see.",
        f"{tmp_path}/report.html",
    ]
