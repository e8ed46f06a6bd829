from dataclasses import replace

import pytest

from blockshake.simulation.models import MODELS
from blockshake.study.report.content import load_content


@pytest.fixture(scope="session")
def loaded(fake):
    """Content of the made-up study by its models of rigid blocks alone."""
    rigid = {name: one for name, one in fake.study["models"].items() if MODELS[name].rigid}
    return load_content({**fake.study, "models": rigid}, fake.results, fake.logs)


@pytest.fixture
def content(loaded):
    """Content of the made-up study that a test may change."""
    cases = {}
    for name, case in loaded.cases.items():
        responses = {
            model: replace(
                one,
                envelope=one.envelope.copy(deep=True),
                samples=one.samples.copy(deep=True),
                comparison=one.comparison.copy(deep=True),
                sensitivity=one.sensitivity.copy(deep=True),
            )
            for model, one in case.responses.items()
        }
        cases[name] = replace(
            case,
            settings=dict(case.settings),
            base=case.base.copy(deep=True),
            differences=case.differences.copy(deep=True),
            responses=responses,
        )
    models = {name: {**one, "parameters": {}} for name, one in loaded.study["models"].items()}
    return replace(
        loaded,
        study={**loaded.study, "models": models, "ladder": dict(loaded.study["ladder"])},
        cases=cases,
        motions={name: one.copy() for name, one in loaded.motions.items()},
        design_summary=dict(loaded.design_summary),
    )


@pytest.fixture
def parameters(content):
    """Sets a parameter of a model in the study."""

    def put(model, **values):
        content.study["models"][model]["parameters"] |= values

    return put


@pytest.fixture
def real(content):
    """The same content as if its tests had been measured."""
    for name, case in content.cases.items():
        content.cases[name] = replace(case, synthetic=False)
    return content
