"""Checks of all that a study's configuration names, by the functions that its jobs run: no job finds a fault first."""

import contextlib
import re
from pathlib import Path

import numpy as np
import pandas as pd

from blockshake.dynamics.baseline import check_window
from blockshake.dynamics.collapse import COSINE_OF_TILT
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.record_set import DrawnMotions, is_record_set
from blockshake.errors import InputError, faults_of
from blockshake.files import HOME
from blockshake.geometry.schema import EXTENSION
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign, load_test
from blockshake.measurement.motion.joints import contact_normals, find_joints
from blockshake.measurement.motion.measured_base import record_start
from blockshake.measurement.sensors.markers import block_markers, driven_marker
from blockshake.paths import check_plain
from blockshake.simulation.models import part_parameters, solver_of
from blockshake.simulation.simulate import check_run
from blockshake.study.calibration.comparison import has_use, parameter_of
from blockshake.study.calibration.settings import OTHERS, STIFFNESS
from blockshake.study.ensembles.case_input import COMMANDED, MEASURED, check_record
from blockshake.study.ensembles.drift_limits import OF_JOINT, slip_limits
from blockshake.study.sampling.distributions import LINKED, TABLE_2, Discrete, known_as, parameter_unit
from blockshake.study.sampling.latin_hypercube import complete_correlation, draw_design
from blockshake.study.sampling.sample_parameters import has_parameter, structure_parameters
from blockshake.study.stiffness.tower import tower_of

_NAME = re.compile(r"\w[\w.-]{0,99}")  # of a structure, a motion or a case: it names results
_RULE = re.compile(r"^(?:rule|checkpoint) (\w+):", re.MULTILINE)
_SHARED = re.compile(r"diagnosis(-.*)?|hidden-effects|kernels|store")
# where the configuration gives an argument of `simulate`
_ARGUMENTS = {
    "parameters": "models.{model}.parameters",
    "time_step": "models.{model}.time_step",
    "duration": "cases.{case}.duration",
    "output_rate": "output_rate",
}


def check_named(config, where):
    """Refuse a `StudyConfig` that names what is not there, or of which a job could not be done; its analyses apart.

    Returns
    -------
    dict of str to Structure
        By the name of their file.

    Raises
    ------
    InputError
        Names ``where``, the key, and the fault of what the key names.
    """
    check_names(config, where)
    for model, settings in config.models.items():
        for name in part_parameters(settings.parameters)[0]:
            raise InputError(where, f"models.{model}.parameters.{name}", "expected a parameter of the solver")
    loaded, structures, shaken = _read_motions(config, where), {}, []
    for index, case in enumerate(config.cases):
        key = f"cases.{index}"
        for model, count in case.samples.items():
            _one_of(model, config.models, where, f"{key}.samples")
            if not 1 <= count <= config.ensemble.size:
                raise InputError(
                    where, f"{key}.samples.{model}", f"expected 1 to {config.ensemble.size}, not {count}"
                )
        with faults_of(where, f"{key}.motion"):
            drawn = DrawnMotions.of(case.model_dump(), loaded)
            for record in drawn.records:
                check_plain(record.path, case.motion, record.name)
            motions = list(drawn.strongest())
        shaken.append(motions[0])
        climbs = config.fragility is not None and case.name in config.fragility.cases
        if case.input == COMMANDED or climbs:
            for motion in motions:
                check_window(motion, case.duration, where, f"{key}.duration")
        if case.structure not in structures:
            structures[case.structure] = check_structure(case.structure, where, key)
        if case.measured is not None:
            tested = check_structure(config.nominal(case).structure, where, key)
            check_measured(case, tested, where, f"{key}.measured")
    check_samples(config.ensemble, structures, where)
    check_drifts(config.ladder.largest_drift, structures, where)
    for index, case in enumerate(config.cases):
        check_simulations(config, index, structures[case.structure], shaken[index], where)
    for folder in config.diagnosis.campaigns:
        with faults_of(where, "diagnosis.campaigns"):
            load_campaign(folder)
    folders = [Path(folder).resolve().name for folder in config.diagnosis.campaigns]
    _each_once(folders, where, "diagnosis.campaigns")
    return structures


def _read_motions(config, where):
    """Motions by path and by the one baseline that the study gives it; records of sets are read with their case."""
    baselines, read = {}, {}
    for key, motion, baseline in config.named_motions():
        if baselines.setdefault(motion, baseline) != baseline:
            expected = f"expected one baseline of {motion}; a copy of the file may have another"
            raise InputError(where, f"{key}.baseline", expected)
        if not is_record_set(motion) and (motion, baseline) not in read:
            with faults_of(where, f"{key}.motion"):
                read[motion, baseline] = load_motion(motion, baseline=baseline)
    return read


def _one_of(name, known, where, key, kind="one of "):
    """Refuse a name that is none of the known ones."""
    if name not in known:
        raise InputError(where, key, f"expected {kind}{', '.join(known) or 'none'}, not {name}")


def _each_once(names, where, key):
    """Refuse a name that stands twice."""
    for name in names:
        if names.count(name) > 1:
            raise InputError(where, key, f"expected every name once, not {name} twice")


def check_names(config, where):
    """Refuse paths that the workflow reads as patterns, and names that cannot name results or are another's."""
    if _SHARED.fullmatch(config.name):
        raise InputError(where, "name", f"expected another name: results/{config.name} is all studies' own")
    rules = [
        rule
        for path in HOME.glob("workflow/**/*")
        if path.suffix == ".smk" or path.name == "Snakefile"
        for rule in _RULE.findall(path.read_text(encoding="utf-8"))
    ]
    names, by_name = [case.name for case in config.cases], {}
    paths = [("diagnosis.campaigns", folder) for folder in config.diagnosis.campaigns]
    paths += [(f"ensemble.{key}", getattr(config.ensemble, key)) for key in ("correlation", "table")]
    for index, case in enumerate(config.cases):
        paths.append((f"cases.{index}.measured.campaign", case.measured and case.measured.campaign))
        paths += [(f"cases.{index}.{key}", getattr(case, key)) for key in ("structure", "motion")]
    for key, path in paths:
        if path is not None:
            check_plain(path, where, key)
    for index, case in enumerate(config.cases):
        key = f"cases.{index}.name"
        if case.name != Path(case.structure).stem and not _NAME.fullmatch(case.name):
            raise InputError(where, key, f"expected letters, digits, dots, hyphens, not '{case.name}'")
        if case.name in rules:
            raise InputError(where, key, f"expected another name than the workflow's rule {case.name}")
        if names.count(case.name) > 1:
            raise InputError(where, key, f"expected a name of its own, as there are two cases {case.name}")
        for key, path in (("structure", case.structure), ("motion", case.motion)):
            if not _NAME.fullmatch(Path(path).stem):
                wrong = f"expected letters, digits, dots, hyphens in the name of the file, not '{Path(path).stem}'"
                raise InputError(where, f"cases.{index}.{key}", wrong)
        other = by_name.setdefault(Path(case.motion).stem, case.motion)
        if other != case.motion:
            wrong = f"expected motions of different names, not {other} and {case.motion}"
            raise InputError(where, f"cases.{index}.motion", wrong)


def check_structure(name, where, key):
    """`Structure` that can be read, with a marker on a driven body and on a free one."""
    with faults_of(where, f"{key}.structure"):
        structure = load_structure(name)
        driven_marker(structure)
        if not block_markers(structure):
            raise InputError(structure.source, "markers", "expected a marker on a body that is not driven")
    return structure


def typical_structure(structure, ensemble):
    """The structure with the medians of the variables."""
    medians = {name: one.median for name, one in ensemble.distributions.items()}
    return structure.with_parameters(structure_parameters(pd.Series(medians), structure, ensemble.linked))


def check_simulations(config, index, structure, motion, where):
    """Refuse a case that a model cannot simulate, or whose blocks make no tower for the contact stiffness."""
    case, structure = config.cases[index], typical_structure(structure, config.ensemble)
    for model, settings in config.models.items():
        given = settings.parameters, settings.time_step, case.duration, config.output_rate
        try:
            check_run(structure, motion, solver_of(model).name, *given)
            if solver_of(model).calibrated:
                tower_of(structure)
        except InputError as error:
            key = _ARGUMENTS.get(error.where)
            if key is None:
                raise InputError(where, f"cases.{index}.structure", f"{model}: {error}") from None
            key = ".".join(filter(None, [key.format(model=model, case=index), error.key]))
            raise InputError(where, key, error.expected) from None


def check_samples(ensemble, structures, where):
    """Refuse variables and links that no structure has, values that one cannot have, and a correlation of others."""
    variables = ensemble.distributions
    for kind, names, usual in (("distributions", variables, TABLE_2), ("linked", ensemble.linked, LINKED)):
        for name in names:
            with faults_of(where, f"ensemble.{kind}.{name}"):
                parameter_unit(name)
            if name not in usual and not any(has_parameter(one, name) for one in structures.values()):
                raise InputError(
                    where,
                    f"ensemble.{kind}.{name}",
                    f"expected a parameter that one of {', '.join(structures)} has",
                )
    for target, source in ensemble.linked.items():
        key = f"ensemble.linked.{target}"
        if source not in variables:
            raise InputError(where, key, f"expected one of the random variables, not {source}")
        if known_as(target, variables) or known_as(target, ensemble.linked) != target:
            raise InputError(where, key, "expected a parameter that is neither sampled nor linked already")
        if parameter_unit(target) != parameter_unit(source):
            raise InputError(where, key, f"expected a variable in {parameter_unit(target)}, not {source}")
    with faults_of(where, "ensemble.correlation"):
        complete_correlation(ensemble.correlation, list(variables))
    ends = {}
    for name, distribution in variables.items():
        values = distribution.stratum_medians(ensemble.size)
        key = f"ensemble.distributions.{name}"
        if isinstance(distribution, Discrete):
            if values[0] == values[-1]:
                raise InputError(where, key, f"expected {ensemble.size} samples that are not all alike")
        elif not (np.isfinite(values).all() and (np.diff(values) > 0.0).all()):
            raise InputError(where, key, f"expected {ensemble.size} different samples: another cov")
        ends[name] = values[0], values[-1]
    for structure in structures.values():

        def parameters(row, structure=structure):
            return structure_parameters(pd.Series(row), structure, ensemble.linked)

        check_ends(structure, ends, parameters, where, "ensemble.distributions")
    if any(map(_is_of_places, variables)):
        check_laid(ensemble, structures, where)


def _is_of_places(name):
    """Whether a variable changes sizes or places of blocks."""
    kind, *parts = name.removeprefix(EXTENSION).split(".")
    return (kind == "shapes" and parts[1] != "hollow") or (
        kind == "bodies" and parts[1] in ("position", "offset")
    )


def check_laid(ensemble, structures, where):
    """Refuse a sample whose blocks overlap, or that opens a bed joint of the structure; all samples are laid."""
    values = draw_design(ensemble.model_dump()).values
    lifted = {name.split(".")[1] for name in values if name.endswith(".offset.z")}
    for name, structure in structures.items():
        pairs, _ = find_joints(structure)
        up = -np.array(structure.file.gravity)
        beds = pairs[contact_normals(structure, pairs) @ up > COSINE_OF_TILT * np.linalg.norm(up)]
        for sample, row in values.iterrows():
            with faults_of(where, f"ensemble.distributions, sample {sample}"):
                laid = structure.with_parameters(structure_parameters(row, structure, ensemble.linked))
                for lower, upper in beds[~laid.touching[tuple(beds.T)]]:
                    below, above = structure.body_names[lower], structure.body_names[upper]
                    if above not in lifted:
                        expected = (
                            f"expected {above} to rest on {below} as in {name}: lay it there by `on: {below}`"
                        )
                        raise InputError(structure.source, f"bodies.{above}", expected)


def check_ends(structure, ends, parameters, where, key):
    """Refuse a variable whose lowest or highest value a structure cannot have.

    Parameters
    ----------
    structure : Structure
    ends : dict of str to tuple of float
        Both values by variable.
    parameters : callable
        Takes values by variable, returns parameters of the structure by dotted name.
    where, key : str
        File, and key under which the variables stand, that an error names.
    """
    with contextlib.suppress(InputError):
        for values in zip(*ends.values(), strict=True):
            structure.with_parameters(parameters(dict(zip(ends, values, strict=True))))
        return
    for name, values in ends.items():
        for value in values:
            with faults_of(where, f"{key}.{name}"):
                structure.with_parameters(parameters({name: value}))


def check_measured(case, structure, where, key):
    """The test a case is compared with: readable, of its structure, motion and scale, and not sealed."""
    with faults_of(where, f"{key}.campaign"):
        campaign = load_campaign(case.measured.campaign)
        tested = load_structure(campaign.structure)
    if tested.content != structure.content:
        raise InputError(
            where,
            f"{key}.campaign",
            f"expected a campaign of the structure {case.name}, not another one's content",
        )
    if case.measured.test not in campaign.open:
        raise InputError(
            where, f"{key}.test", f"expected a test that is not sealed: {', '.join(campaign.open)}"
        )
    test = campaign.tests[case.measured.test]
    commands = [(Path(one.motion).stem, one.scale, one.baseline) for one in (test, case)]
    if commands[0] != commands[1]:
        raise InputError(
            where,
            f"{key}.test",
            f"expected one of {case.motion} at {case.scale:g}, baseline {case.baseline}, not {test.motion} at "
            f"{test.scale:g}, baseline {test.baseline}",
        )
    with faults_of(where, f"{key}.test"):
        time = load_test(campaign, case.measured.test)["time"].to_numpy()
    if case.input == MEASURED:
        check_record(
            time[-1] - record_start(time), case.duration, where, f"{key.removesuffix('measured')}duration"
        )


def check_fragility(settings, config, structures, where):
    """Cases and a model of the study, and no more samples than there are."""
    for name in settings.cases:
        _one_of(name, [case.name for case in config.cases], where, "fragility.cases")
        if (strong := config.case(name).intensity) is not None and len(strong.levels) > 1:
            raise InputError(
                where, "fragility.cases", f"expected {name} to have one level, which samples climb from"
            )
    _each_once(settings.cases, where, "fragility.cases")
    _one_of(settings.model, config.models, where, "fragility.model")
    first = config.ensemble.size if config.ensemble.until is None else config.ensemble.batch
    if settings.size > first:
        raise InputError(
            where, "fragility.size", f"expected at most the first samples of the ensemble, {first}"
        )


def check_drifts(given, structures, where):
    """Refuse limits of drifts whose block or joint no structure has."""
    for name in given if isinstance(given, dict) else ():
        known = [
            one
            for structure in structures.values()
            for one in (
                map(OF_JOINT.join, slip_limits(structure, {name: 1.0}))
                if OF_JOINT in name
                else (body.name for body in structure.file.bodies if not body.driven)
            )
        ]
        if OF_JOINT not in name:
            _one_of(name, list(dict.fromkeys(known)), where, "ladder.largest_drift")
        elif not known:
            expected = "expected two bodies that touch at the start, LOWER/UPPER"
            raise InputError(where, f"ladder.largest_drift.{name}", expected)


def check_limits(settings, config, structures, where):
    """Cases of the study, bodies and joints of their structures."""
    for name, state in settings.items():
        key = f"limits.{name}"
        for case in state.cases:
            _one_of(case, [one.name for one in config.cases], where, f"{key}.cases")
        of = [structures[one.structure] for one in config.cases if not state.cases or one.name in state.cases]
        complete = [one for one in of if set(state.bodies) <= set(one.body_names)]
        if not complete or (state.cases and len(complete) < len(of)):
            lacking = next(one for one in of if one not in complete)
            for body in state.bodies:
                _one_of(body, lacking.body_names, where, f"{key}.{'body' if state.body else 'joint'}")
        for structure in complete:
            driven = [
                name
                for name, is_driven in zip(structure.body_names, structure.driven, strict=True)
                if is_driven
            ]
            if state.body in driven:
                raise InputError(
                    where, f"{key}.body", f"expected a body that is not driven, not {state.body}"
                )
            if state.joint is not None:
                pair = tuple(map(structure.body_names.index, state.joint))
                if not structure.touching[pair] and (
                    state.measure != "impact_velocity" or set(state.joint) & set(driven)
                ):
                    expected = "expected two bodies that touch at the start"
                    raise InputError(
                        where, f"{key}.joint", f"{expected}, which {' and '.join(state.joint)} do not"
                    )


def check_extension(settings, config, structures, where):
    """Pairs of cases that differ by the cause alone."""
    names = [case.name for case in config.cases]
    for extended, nominal in settings.cases.items():
        key = f"extension.cases.{extended}"
        _one_of(extended, names, where, "extension.cases")
        _one_of(nominal, names, where, key)
        pair = [config.case(name) for name in (extended, nominal)]
        if [bool(structures[case.structure].file.extension) for case in pair] != [True, False]:
            raise InputError(
                where, key, "expected a structure that states an `extension`, and one that does not"
            )
        alike, others = (case.model_copy(update={"name": "", "structure": ""}) for case in pair)
        if alike != others:
            raise InputError(where, key, f"expected the motion, window, samples and test of {nominal}")
    for name in settings.named_by:
        _one_of(name, settings.cases, where, "extension.named_by")


def check_calibration(settings, config, structures, where):
    """Models and measured cases of the study, and values of parameters that models and structures have a use for."""
    frictions = [name for name in config.ensemble.distributions if name.startswith("friction.")]
    known = [*frictions, *OTHERS]
    measured = [case.name for case in config.cases if case.measured is not None]
    for name in settings.parameters or ():
        _one_of(name, known, where, "calibration.parameters")
    for name in settings.ranges:
        _one_of(name, settings.parameters or known, where, f"calibration.ranges.{name}")
    _each_once(settings.parameters or (), where, "calibration.parameters")
    ranges = settings.ranges_of(config.ensemble.distributions)
    for name, source in settings.linked.items():
        _one_of(name, frictions, where, "calibration.linked")
        _one_of(
            source,
            [friction for friction in frictions if friction in ranges],
            where,
            f"calibration.linked.{name}",
        )
    _each_once(settings.tests or (), where, "calibration.tests")
    for model, names in settings.cases.items():
        key = f"calibration.cases.{model}"
        _one_of(model, config.models, where, key)
        _each_once(names, where, key)
        for name in names:
            _one_of(name, measured, where, key, "cases with a measured test: ")
            campaign = load_campaign(config.case(name).measured.campaign)
            if not settings.chosen(campaign):
                expected = f"expected an open test of {name}: {', '.join(campaign.open)}"
                raise InputError(where, "calibration.tests", expected)
            structure = structures[config.case(name).structure]
            used = [parameter for parameter in ranges if has_use(model, structure, parameter)]
            if not used:
                raise InputError(
                    where, key, f"expected a parameter among {', '.join(ranges)} that {model} has a use for"
                )
            spans = {parameter: ranges[parameter] for parameter in used if parameter != STIFFNESS}
            ends = {parameter: (span.lowest, span.highest) for parameter, span in spans.items()}

            def parameters(values, structure=structure):
                named = {parameter: parameter_of(structure, parameter) for parameter in values}
                return {name: factor * values[parameter] for parameter, (name, factor) in named.items()}

            check_ends(structure, ends, parameters, where, "calibration.ranges")
