"""Analyses of a study: a row each, all that the checks, the workflow and the report know of their results."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from blockshake.files import load_json
from blockshake.simulation.models import solver_of
from blockshake.store import load_made
from blockshake.study.config_checks import (
    check_calibration,
    check_extension,
    check_fragility,
    check_limits,
)
from blockshake.study.sampling.sample_table import load_design

OF_THE_PAPER = tuple(f"configuration-{number}" for number in (1, 2, 3, 4))
"""Structures of Zhou et al. (2023), by their shipped names."""


def _every_case(study):
    return [case["name"] for case in study["cases"]]


def _measured_cases(study):
    return [case["name"] for case in study["cases"] if case["measured"]]


def _drawing_cases(study):
    """Cases whose samples draw motions, or are scaled to levels of one."""
    return [case["name"] for case in study["cases"] if case.get("intensity") is not None]


def _cases_of_stiffness(study):
    """Cases of a study that tells of contact stiffness: a model has any, or a structure is the paper's."""
    calibrated = any(solver_of(model).calibrated for model in study["models"])
    named = calibrated or any(case["structure"] in OF_THE_PAPER for case in study["cases"])
    return _every_case(study) if named else []


def _cases_of_limits(study):
    """Cases that a limit state names, or all where one names none; a structure may lack its bodies."""
    states = study["limits"].values()
    named = {name for state in states for name in state["cases"]}
    return [name for name in _every_case(study) if name in named or not all(one["cases"] for one in states)]


class Analysis(NamedTuple):
    """An analysis of a study."""

    name: str
    # its result, below the folder of the study's results: one for each ``{case}`` and ``{model}`` that is in
    # it
    file: str
    load: Callable = load_made  # reads it
    # names of the cases that have it, from the configuration as a mapping; None for one of the study as a
    # whole, which no report of a case alone has
    cases: Callable | None = _every_case
    settings: str | None = None  # key of the configuration without which a study has not got it
    # refuses settings by which it cannot be made: of the settings, the `StudyConfig`, its structures by name
    # and the file to name
    check: Callable | None = None

    def files(self, study, only=None):
        """Files that the report of a study, or of one of its cases, reads, by case and model; None without one."""
        if self.settings and not study.get(self.settings):
            return {}
        if self.cases is None:
            return {} if only else {(None, None): self.file}
        return {
            (case, model): self.file.format(case=case, model=model)
            for case in self.cases(study)
            if only in (None, case)
            for model in (study["models"] if "{model}" in self.file else [None])
        }

    def results(self, study, folder, only=None):
        """These as they are read from the folder of the study's results, by case and model."""
        return {key: self.load(Path(folder, file)) for key, file in self.files(study, only).items()}


def _cases_of(settings):
    return lambda study: study[settings]["cases"]


ANALYSES = (
    Analysis("stiffness", "stiffness/{case}.csv", load_design, _cases_of_stiffness),
    Analysis("waves", "waves/{case}.nc", cases=_cases_of_stiffness),
    Analysis("inputs", "inputs/{case}.nc", cases=_measured_cases),
    Analysis("envelopes", "envelopes/{model}/{case}.nc"),
    Analysis("samples", "samples/{model}/{case}.nc"),
    Analysis("shown", "shown/{model}/{case}.nc"),
    Analysis("comparisons", "comparisons/{model}/{case}.nc", cases=_measured_cases),
    Analysis("sensitivities", "sensitivities/{model}/{case}.nc"),
    Analysis("indices", "indices/{model}/{case}.nc"),
    Analysis("differences", "differences/{case}.nc"),
    Analysis(
        "fragility", "fragility/{case}.nc", load_made, _cases_of("fragility"), "fragility", check_fragility
    ),
    Analysis("clouds", "clouds/{model}/{case}.nc", cases=_drawing_cases),
    Analysis("limits", "limits/{model}/{case}.nc", load_made, _cases_of_limits, "limits", check_limits),
    Analysis("changes", "changes/{case}.nc", load_made, _cases_of("extension"), "extension", check_extension),
    Analysis("calibration", "calibration.json", load_json, None, "calibration", check_calibration),
)
