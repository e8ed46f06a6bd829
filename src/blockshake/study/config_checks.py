"""Checks of all that a study's configuration names: structures, motions, measured tests, models of its parts."""

import re
from pathlib import Path

from blockshake.errors import InputError
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.sensors.markers import block_markers, driven_marker
from blockshake.paths import check_plain
from blockshake.simulation.limits import check_run
from blockshake.simulation.models import split_parameters
from blockshake.study.calibration.settings import OTHERS
from blockshake.study.ensembles.case_input import MEASURED, check_record
from blockshake.study.sampling.sample_parameters import sample_parameters

_NAME = re.compile(r"\w[\w.-]*")  # of a structure, a motion or a case: it names results


def check_structure(name, where, key):
    """A structure that can be read, with a marker on a driven body and on a free one."""
    try:
        structure = load_structure(name)
    except InputError as error:
        raise InputError(where, f"{key}.structure", str(error)) from None
    driven_marker(structure)
    if not block_markers(structure):
        raise InputError(structure.source, "markers", "expected a marker on a body that is not driven")


def check_paths(config, where):
    """Refuse paths that the workflow reads as patterns, and structures and motions whose names cannot name results."""
    paths = [("diagnosis.campaigns", folder) for folder in config.diagnosis.campaigns]
    if config.ensemble.correlation is not None:
        paths.append(("ensemble.correlation", config.ensemble.correlation))
    paths += [
        (f"cases.{index}.measured.campaign", case.measured.campaign)
        for index, case in enumerate(config.cases)
        if case.measured
    ]
    naming = [("ladder.motions", motion) for motion in config.ladder.motions]
    if config.convergence is not None:
        naming.append(("convergence.structure", config.convergence.structure))
    for index, case in enumerate(config.cases):
        naming += [(f"cases.{index}.structure", case.structure), (f"cases.{index}.motion", case.motion)]
    for key, path in [*paths, *naming]:
        check_plain(path, where, key)
    for index, case in enumerate(config.cases):
        if case.name != Path(case.structure).stem and not _NAME.fullmatch(case.name):
            raise InputError(
                where, f"cases.{index}.name", f"expected letters, digits, dots, hyphens, not '{case.name}'"
            )
    by_name = {}
    for key, path in naming:
        name = Path(path).stem
        if not _NAME.fullmatch(name):
            raise InputError(
                where, key, f"expected letters, digits, dots, hyphens in the name of the file, not '{name}'"
            )
        if "motion" in key and by_name.setdefault(name, path) != path:
            raise InputError(
                where, key, f"expected motions of different names, not {by_name[name]} and {path}"
            )


def check_parameters(model, settings, key, where):
    """Refuse parameters shared by all samples that are not the solver's."""
    try:
        physical, _ = split_parameters(settings.parameters, model)
    except InputError as error:
        raise InputError(where, key, str(error).removeprefix("--set: ")) from None
    if physical:
        raise InputError(where, f"{key}.{next(iter(physical))}", "expected a parameter of the solver")


def typical_structure(config, case):
    """Structure of a case with the medians of the variables."""
    medians = {name: one.median for name, one in config.ensemble.distributions.items()}
    structure = load_structure(case.structure)
    return structure.with_parameters(sample_parameters(medians, structure, config.ensemble.linked))


def check_runs(config, case, where):
    """Refuse runs of a case that a model cannot make."""
    structure = typical_structure(config, case)
    for model, settings in config.models.items():
        try:
            check_run(structure, model, settings.time_step, case.duration, config.output_rate, False, True)
        except InputError as error:
            raise InputError(where, f"models.{model}", f"{case.name}: {error}") from None


def check_measured(case, where, key):
    """The test a case is compared with: of its structure, motion and scale, and not sealed."""
    campaign = load_campaign(case.measured.campaign)
    if not load_structure(campaign.structure).same_as(load_structure(case.structure)):
        raise InputError(
            where,
            f"{key}.campaign",
            f"expected a campaign of the structure {case.name}, not another one's content",
        )
    open_tests = [name for name, test in campaign.tests.items() if test.role != "sealed"]
    if case.measured.test not in open_tests:
        raise InputError(where, f"{key}.test", f"expected a test that is not sealed: {', '.join(open_tests)}")
    test = campaign.tests[case.measured.test]
    if (Path(test.motion).stem, test.scale) != (Path(case.motion).stem, case.scale):
        raise InputError(
            where,
            f"{key}.test",
            f"expected one of {case.motion} at {case.scale:g}, not {test.motion} at {test.scale:g}",
        )
    if case.input == MEASURED:
        time = load_test(campaign, case.measured.test)["time"].to_numpy()
        check_record(time[-1] - time[0], case.duration, where, f"{key.removesuffix('measured')}duration")


def check_fragility(config, where):
    """Cases and a model of the study, and no more samples than there are."""
    asked = config.fragility
    if asked is None:
        return
    known = [case.name for case in config.cases]
    for name in asked.cases:
        if name not in known:
            raise InputError(where, "fragility.cases", f"expected one of {', '.join(known)}, not {name}")
    if asked.model not in config.models:
        raise InputError(where, "fragility.model", f"expected a model of the study, not {asked.model}")
    if asked.size > config.ensemble.size:
        raise InputError(where, "fragility.size", f"expected at most ensemble.size, {config.ensemble.size}")


def check_calibration(config, where):
    """Models and measured cases of the study, and parameters that it samples or that contact springs have."""
    asked = config.calibration
    if asked is None:
        return
    for model, names in asked.cases.items():
        key = f"calibration.cases.{model}"
        if model not in config.models:
            raise InputError(where, key, f"expected a model of the study: {', '.join(config.models)}")
        for name in names:
            known = [case.name for case in config.cases if case.measured is not None]
            if name not in known:
                raise InputError(
                    where,
                    key,
                    f"expected cases with a measured test: {', '.join(known) or 'none'}, not {name}",
                )
    known = [*(name for name in config.ensemble.distributions if name.startswith("friction.")), *OTHERS]
    for name in asked.ranges:
        if name not in known:
            raise InputError(where, f"calibration.ranges.{name}", f"expected one of {', '.join(known)}")


def check_friction_search(config, where):
    """A model, measured cases and frictions of the study, and at least two candidates."""
    search = config.friction_calibration
    if search is None:
        return
    for kind, names, known in (
        ("cases", search.cases, [case.name for case in config.cases]),
        (
            "variables",
            search.variables,
            [name for name in config.ensemble.distributions if name.startswith("friction.")],
        ),
    ):
        for name in names:
            if name not in known:
                raise InputError(
                    where, f"friction_calibration.{kind}", f"expected one of {', '.join(known)}, not {name}"
                )
    for name in search.cases:
        if config.case(name).measured is None:
            raise InputError(
                where, "friction_calibration.cases", f"expected cases with a measured test, not {name}"
            )
    if search.model not in config.models:
        raise InputError(
            where, "friction_calibration.model", f"expected a model of the study, not {search.model}"
        )
    if search.lowest + search.step > search.highest + 1e-9:
        raise InputError(
            where, "friction_calibration.step", "expected at least two candidates between lowest and highest"
        )
