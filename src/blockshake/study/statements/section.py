"""Findings of a study on the statements of the paper, one by one, as values for the page docs/results/the-paper.md."""

from dataclasses import replace

from blockshake.pages.wording import given, model_label
from blockshake.simulation.models import MODELS
from blockshake.study.comparison.tables import other_settings_table
from blockshake.study.statements.statement import PaperVerdict
from blockshake.study.statements.table import STATEMENTS

HEADER = ("Place", "Statement of the paper", "Verdict", "Finding")


def judge_statements(content):
    """Findings of a study on the statements: rows of text under `HEADER`, by heading; none without the structures of
    the paper, which the statements are about."""
    content = _of_the_paper(content)
    if not content.cases:
        return {}
    return {
        heading: tuple((one.place, one.claim, *map(str, one.finding(content))) for one in statements)
        for heading, statements in STATEMENTS.items()
    }


def _of_the_paper(content):
    """The content without the cases of other structures, and without a calibration that they take part in.

    And without the models that have settings of their own, which are told beside the plain ones elsewhere.
    """
    models = {name: settings for name, settings in content.study["models"].items() if name in MODELS}
    cases = {
        name: replace(case, responses={model: case.responses[model] for model in models})
        for name, case in content.cases.items()
        if case.is_shipped
    }
    calibrated = [
        replace(one, cases=tuple(name for name in one.cases if name in cases)) for one in content.calibrated
    ]
    return replace(
        content,
        study={**content.study, "models": models},
        cases=cases,
        calibrated=tuple(one for one in calibrated if one.cases),
        calibration=content.calibration if len(cases) == len(content.cases) else None,
    )


def count_words(rows_by_heading):
    """How many statements have which verdict, in a sentence."""
    verdicts = [row[2] for rows in rows_by_heading.values() for row in rows]
    counts = ", ".join(f"{verdicts.count(one)} {one}" for one in PaperVerdict)
    return f"Of {len(verdicts)} statements: {counts}."


def findings(content):
    """Findings of a study as JSON-like values: what it is, what settings change, and the rows of `judge_statements`."""
    prices = other_settings_table(content)
    return {
        "study": content.study["name"],
        "description": " ".join(content.study["description"].split()),
        "samples": len(content.design),
        "cases": [
            f"{case.name}, {case.motion} at {given(case.settings['scale'])}, {given(case.settings['duration'])} s"
            for case in content.cases.values()
        ],
        "models": [model_label(model) for model in content.study["models"]],
        "version": content.versions["blockshake"],
        "other_settings": prices and [prices.header, *prices.rows],
        "findings": {heading: list(map(list, rows)) for heading, rows in judge_statements(content).items()},
    }
