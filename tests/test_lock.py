"""The lock pins all that is installed, with digests, and its audit tells a finding from a missing index."""

import importlib.util
import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import blockshake
from blockshake.files import load_yaml

ROOT = Path(__file__).parents[1]
PIN = re.compile(r"(\S+)==(\S+?)(?: ; .*)? \\\n((?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+)")


@pytest.fixture(scope="module")
def pins():
    text = (ROOT / "requirements.lock").read_text()
    assert PIN.sub("", text) == ""  # nothing but pins with digests
    return {canonicalize_name(name): version for name, version, _ in PIN.findall(text)}


def test_every_package_that_is_installed_is_pinned(pins):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    for text in (*project["dependencies"], *extras["test"], *extras["build"]):
        wanted = Requirement(text)
        assert wanted.specifier.contains(pins[canonicalize_name(wanted.name)]), text


def test_only_pins_are_installed():
    assert (
        "pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock"
        in (ROOT / "Makefile").read_text()
    )


def test_the_version_is_one():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    cited = load_yaml(ROOT / "CITATION.cff")
    released = re.search(r"^## (\S+), (\S+)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert project["version"] == cited["version"] == released[1] == blockshake.__version__
    assert str(cited["date-released"]) == released[2]


def test_the_environment_of_the_rules_holds_all_that_the_package_needs():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    conda = load_yaml(ROOT / "workflow" / "envs" / "blockshake.yaml")["dependencies"]
    listed = [one for one in conda if isinstance(one, str)] + conda[-1]["pip"]
    names = {one.split()[0].removesuffix("-base") for one in listed} - {"python", "pip"}
    assert names == {Requirement(one).name for one in project["dependencies"]} - {"snakemake"}


@pytest.fixture(scope="module")
def judge():
    spec = importlib.util.spec_from_file_location("audit", ROOT / ".ci" / "audit.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.judge


SOUND = {"name": "a", "version": "1", "vulns": []}
UNKNOWN = {"name": "b", "skip_reason": "b: not found"}
FAULTY = {"name": "c", "version": "2", "vulns": [{"id": "PYSEC-1", "fix_versions": ["3"]}]}


@pytest.mark.parametrize(
    ("report", "code", "words"),
    [
        ([SOUND], 0, "1 of 1 packages audited, 0 complaints"),
        ([SOUND, UNKNOWN], 1, "b: not found"),
        ([SOUND, FAULTY], 1, "c 2: PYSEC-1, mended in 3"),
        ([UNKNOWN, FAULTY], 1, "c 2: PYSEC-1, mended in 3"),
        ([UNKNOWN], 0, "audit SKIPPED: the index gives no advisories for any of 1 packages"),
    ],
)
def test_an_audit_tells_findings_from_a_missing_index(report, code, words, judge):
    found, lines = judge(report)
    assert found == code
    assert words in "\n".join(lines)
