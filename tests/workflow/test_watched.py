"""The sources that a rule watches are those that its script imports, by Python's own account: no more, no fewer."""

import dataclasses

import pytest
from watched import EDITS, SCRIPTS, modules_of

from blockshake.diagnosis.nominal.plan import EFFORTS
from blockshake.files import PACKAGE
from blockshake.simulation.models import MODELS
from blockshake.sources import kernel_sources, script_sources

BY_MODEL = ("simulate_batch", "simulate_nominal")


@pytest.mark.parametrize("script", sorted(path.stem for path in SCRIPTS.glob("*.py")))
def test_a_rule_watches_the_modules_that_its_script_imports(script):
    for models in [(), *((model,) for model in MODELS if script in BY_MODEL)]:
        assert set(script_sources(script, *models)) == modules_of(script, *models)


@pytest.mark.parametrize("model", MODELS)
def test_kernels_follow_the_modules_of_their_driver(model):
    assert set(kernel_sources(model)) == modules_of(None, model)


@pytest.mark.parametrize("module", [module for modules in EDITS.values() for module in modules])
def test_the_modules_that_faults_edit_are_there(module):
    """Tests of faults are long and seldom run."""
    assert (PACKAGE / module).is_file()


@pytest.mark.parametrize("name", [field.name for field in dataclasses.fields(EFFORTS["quick"])])
def test_every_number_of_an_effort_is_a_parameter_of_a_rule(name):
    """The file of the efforts is no source: an edit there may leave no result as it was."""
    rules = "".join(path.read_text() for path in (PACKAGE.parents[1] / "workflow" / "rules").glob("*.smk"))
    # the number of tests is that of the ensembles; the plan has the number of clean campaigns
    by_plan = {"tests": "plan(campaign).simulated", "clean": ".clean", "clean_seconds": ".clean"}
    assert by_plan.get(name, f"effort().{name}") in rules
