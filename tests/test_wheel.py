"""An installed package holds all that ships with the program, and works in any folder."""

import os
import shutil
import subprocess
import sys

import pytest

from blockshake.files import PACKAGE

ROOT = PACKAGE.parents[1]
COPIED = (
    "Snakefile", "LICENSE", "README.md", "config", "data", "profiles", "pyproject.toml", "setup.py", "src", "workflow",
)  # fmt: skip


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Folder of an installed package, made from a copy of the checkout."""
    checkout, site = tmp_path_factory.mktemp("checkout"), tmp_path_factory.mktemp("site")
    for name in COPIED:
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copyfile
        copy(ROOT / name, checkout / name)
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation"]
    subprocess.run([*command, "--target", site, checkout], check=True)
    shutil.rmtree(checkout)
    return site


@pytest.fixture
def run(installed, tmp_path):
    """Run a module of Python with the installed package in an empty folder."""

    def started(*arguments):
        return subprocess.run(
            [sys.executable, "-m", *map(str, arguments)],
            cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(installed)}, capture_output=True, text=True,
            timeout=600, check=False,
        )  # fmt: skip

    return started


def test_editors_find_types_of_an_installed_package(installed):
    for name in ("py.typed", "__init__.pyi"):
        assert (installed / "blockshake" / name).read_bytes() == (PACKAGE / name).read_bytes()


def test_a_wheel_has_the_package_of_free_flight(installed):
    own = {path.name for path in PACKAGE.with_name("blockshake_flight").glob("*.py")}
    assert own == {path.name for path in (installed / "blockshake_flight").glob("*.py")}


def test_commands_find_what_is_shipped(run, tmp_path):
    assert "3 blocks" in run("blockshake", "check", "configuration-1", "alkion").stdout
    assert run("blockshake", "sample", "--size", 10, "--output", "design.csv").returncode == 0
    assert run("blockshake", "parameters").returncode == 0
    assert [path.name for path in tmp_path.iterdir()] == ["design.csv"]


def test_a_study_is_planned_in_the_current_folder(run, installed):
    assert run("blockshake", "new", "study", "my-study.yaml").returncode == 0
    answer = run(
        "snakemake", "-n", "--cores", 1, "--snakefile", installed / "blockshake" / "shipped" / "Snakefile",
        "--configfile", "my-study.yaml",
    )  # fmt: skip
    assert answer.returncode == 0, answer.stderr
    assert "make_report" in answer.stdout
    # with it a killed command leaves no lock
    assert "profiles/default" in answer.stderr
    assert not any(str(ROOT / name) in answer.stdout for name in COPIED)


def test_a_diagnosis_is_planned_in_the_current_folder(run, installed, tmp_path):
    shutil.copytree(ROOT / "data" / "virtual-campaign" / "configuration-1", tmp_path / "campaign")
    shipped = installed / "blockshake" / "shipped"
    answer = run(
        "snakemake", "-n", "diagnose", "--cores", 1, "--snakefile", shipped / "Snakefile",
        "--configfile", shipped / "config" / "diagnosis.yaml", "--config", "campaign=campaign", "effort=quick",
    )  # fmt: skip
    assert answer.returncode == 0, answer.stderr
    assert "decide" in answer.stdout
    assert not any(str(ROOT / name) in answer.stdout for name in COPIED)
