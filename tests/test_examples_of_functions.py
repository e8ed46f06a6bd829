"""Every public function shows an example, and the example gives what it shows."""

import doctest
import inspect
import shutil

import pytest
import yaml
from made_up_decision import made_up_cause

import blockshake
from blockshake.diagnosis.verdict.verdict import Misfit, Verdict, write_verdict
from blockshake.files import PACKAGE
from blockshake.own_files.templates import write_template

# these run the workflow, or simulate for minutes
LONG = {"diagnose", "run_study", "plan_campaign"}
CAMPAIGN = PACKAGE.parents[1] / "data" / "virtual-campaign" / "configuration-1"


CAUSE = made_up_cause(
    "weak-joint",
    {"joint": ["slab", "block-1"]},
    members=tuple({"factor": 0.2 + 0.005 * number} for number in range(40)),
)


@pytest.fixture
def own_files(tmp_path, monkeypatch):
    """Files that the examples call a user's."""
    monkeypatch.chdir(tmp_path)
    write_template("structure", "my.yaml")
    shutil.copytree(CAMPAIGN, "my-tests")
    found = {
        "decision": "named",
        "causes": ["weak-joint"],
        "probabilities": {},
        "runs": 0,
        "word": "established",
    }
    content = blockshake.load_structure("configuration-1").content
    verdict = Verdict(**found, misfit=Misfit(p=0.01, where="block-1"), extension=(CAUSE,), structure=content)
    write_verdict("verdict.json", verdict)
    study = {
        "name": "my-study",
        "description": "three blocks",
        "models": {"nscd-rigid": {"time_step": 1e-3}},
        "cases": [{"structure": "configuration-1", "motion": "alkion", "scale": 1.0, "duration": 1.0}],
        "ensemble": {"size": 10, "seed": 1},
    }
    (tmp_path / "my-study.yaml").write_text(yaml.safe_dump(study))


@pytest.mark.parametrize(
    "name", [pytest.param(one, marks=pytest.mark.slow if one in LONG else ()) for one in blockshake.__all__]
)
def test_an_example_gives_what_it_shows(name, own_files):
    public = getattr(blockshake, name)
    (example,) = doctest.DocTestFinder(recurse=False).find(public, name, globs={})
    assert example.examples
    failed, attempted = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(example)
    assert attempted > 0
    assert failed == 0


@pytest.mark.parametrize("name", blockshake.__all__)
def test_a_docstring_has_its_sections(name):
    public = getattr(blockshake, name)
    sections = ["Parameters", *([] if inspect.isclass(public) else ["Returns", "Raises"]), "Examples"]
    words = inspect.getdoc(public)
    missing = [section for section in sections if f"\n{section}\n{'-' * len(section)}\n" not in words]
    assert missing == []
    arguments = inspect.signature(public).parameters
    assert [one for one in arguments if one not in words.partition("\nReturns\n")[0]] == []
