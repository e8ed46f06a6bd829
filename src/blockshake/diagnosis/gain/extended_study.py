"""A study in which a diagnosed cause is one of the variables: the files of its structures, and its own."""

import json
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import yaml

import blockshake
from blockshake.diagnosis.answer.decision import MEMBERS
from blockshake.diagnosis.gain.extended_model import can_extend, extended_experiment
from blockshake.diagnosis.verdict.verdict import load_verdict
from blockshake.effects.base_compliance import EFFECT as BASE_COMPLIANCE
from blockshake.effects.effect import Experiment
from blockshake.effects.places import nowhere
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import check_output, file_digest, load_yaml, write_text
from blockshake.geometry.schema import EXTENSION, StructureFile
from blockshake.geometry.structure import load_structure
from blockshake.geometry.structure_file import dotted_values, replace_into
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.campaigns.campaign_folder import copy_beside
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.quantities import unit_of
from blockshake.study.config import check_config, load_config
from blockshake.study.sampling.correlation_target import nearest_correlation
from blockshake.study.sampling.latin_hypercube import complete_correlation
from blockshake.validation import validated

_STEPS = 10  # of the probability, between tabulated quantiles
_DIGITS = 6  # of a value
_RISE = 1e-4  # of their range, by which quantiles of equal members rise
_TOLD = 0.4  # correlation that 99 of 100 sets of 40 unrelated members stay below


class _Extended(NamedTuple):
    """A structure with a cause: its mapping at the medians, and members of what varies, (n_members,) by dotted name."""

    mapping: dict
    members: dict


def extend_study(verdict, study, output):
    """Write a study in which the cause of a verdict is a variable, and the structures that state it.

    Parameters
    ----------
    verdict : str or path
        ``verdict.json`` of a diagnosis.
    study : str or path
        Configuration of an ordinary study.
    output : str or path
        Of the extended study; the files of its structures, and of the correlation where there is any, lie beside it
        and begin with its name.

    Returns
    -------
    list of str
        Lines that say what was written, and what was left out.

    Raises
    ------
    InputError
        A verdict of another version or that names nothing that a structure can hold, a study without a structure that
        has the cause, or one whose variables or names clash with it. Nothing is written.

    Notes
    -----
    The cause enters by `extended_experiment`, as in the diagnosis: each member of its posterior makes a structure, and
    the values by which these differ are the variables, tabulated by the quantiles of the members. Equal ones are
    linked; correlations that 40 members tell from none are kept.
    """
    found, config, mapping = load_verdict(verdict), load_config(study), load_yaml(study)
    output = check_output(output)
    if output.suffix not in (".yaml", ".yml"):
        raise InputError(output, "", f"expected a YAML file, {output}.yaml")
    if config.extension is not None:
        raise InputError(study, "extension", "expected a study that has no cause yet")
    causes, lines = _causes(found, verdict)
    title = " and ".join(cause.title for cause in causes)
    extended, files, cases, named_by = {}, {}, [], []
    for case in config.cases:
        structure = load_structure(case.structure)
        if any(map(_has_place, causes)) and structure.content != found.structure:
            lines.append(f"{case.name} is left out: its structure is not the one that was tested")
            continue
        name = f"{case.name}-extended"
        if case.structure not in extended:
            path = output.with_name(f"{output.stem}-{Path(case.structure).stem}.yaml")
            extended[case.structure], files[case.structure] = _extended(structure, causes, title), path
        given = case.model_dump(mode="json", exclude_defaults=True)
        cases += [given, {**given, "name": name, "structure": str(files[case.structure])}]
        if case.measured and _digest(case.measured) in found.tests.values():
            named_by.append(name)
    if not cases:
        expected = "expected a case of the structure that the verdict is of, as its cause has a place there"
        raise InputError(study, "cases", expected)
    _check_clash(config.ensemble.distributions, extended, study)
    variables = {name: values for one in extended.values() for name, values in one.members.items()}
    pairs = {case["name"]: nominal["name"] for nominal, case in zip(cases[::2], cases[1::2], strict=True)}
    correlation = output.with_name(f"{output.stem}-correlation.csv")
    ensemble, target = _ensemble(config.ensemble, variables, correlation)
    kept = {key: value for key, value in mapping.items() if key not in ("calibration", "diagnosis")}
    whole = {
        **kept,
        "name": f"{config.name}-extended",
        "description": f"{config.description}; without and with {title}",
        "cases": cases,
        "ensemble": ensemble,
        "extension": {"cases": pairs, "named_by": named_by},
    }
    if config.fragility is not None:
        climbs = [case for case in config.fragility.cases if case in pairs.values()]
        climbs += [case for case, nominal in pairs.items() if nominal in climbs]
        whole["fragility"] = {**mapping["fragility"], "cases": climbs}
        if not climbs:
            del whole["fragility"]
    texts = {
        files[name]: _header(verdict, found, causes) + _text(one.mapping) for name, one in extended.items()
    }
    if target is not None:
        texts[correlation] = target.to_csv()
    texts[output] = _header(verdict, found, causes, f"snakemake -c2 --configfile {output}") + _text(whole)
    for name, one in extended.items():
        meshes = {shape["mesh"] for shape in one.mapping["shapes"].values() if shape.get("mesh")}
        for mesh in meshes:
            copy_beside(load_structure(name).folder / mesh, output.parent / mesh)
    _write(texts, output)
    named = [f"  {name} [{unit_of(name.removeprefix(EXTENSION))}]" for name in variables]
    return [*lines, *map(str, texts), *named]


def _causes(found, verdict):
    """Causes of a verdict that a structure can hold, and lines on the others."""
    if not found.extension:
        what = f"its word is: {found.word}" + (f" ({', '.join(found.causes)})" if found.causes else "")
        raise InputError(verdict, "extension", f"expected a cause in the blocks, joints or forces; {what}")
    causes, others = [], []
    for cause in found.extension:
        held = cause.outside or EFFECTS[cause.name].acts not in ("input", "observation")
        held = held and can_extend(cause) and cause.name != BASE_COMPLIANCE.name
        (causes if held else others).append(cause)
    if not causes:
        names = ", ".join(cause.name for cause in others)
        expected = f"expected a cause that a structure file can state and that lasts, found {names}"
        raise InputError(verdict, "extension", expected)
    lines = [f"{cause.name} is left out: no structure file can state it" for cause in others]
    if found.decision == "ambiguous":
        lines.append(f"the verdict is: one of {', '.join(found.causes)}; the likeliest is taken")
    return causes, lines


def _has_place(cause):
    """Whether a cause acts at a place of the structure, and so in no other one."""
    return cause.outside or EFFECTS[cause.name].places is not nowhere


def _extended(structure, causes, title):
    """`_Extended` of a structure; members whose structures have other entries than most are left out."""
    made = []
    for number in range(MEMBERS):
        experiment = Experiment(structure, None, Instruments())
        for cause in causes:
            experiment = extended_experiment(experiment, cause, number, "")
        made.append(experiment.structure.file.model_dump(mode="json"))
    values = [dotted_values(mapping) for mapping in made]
    forms = [
        tuple((key, value) for key, value in one.items() if not isinstance(value, float)) for one in values
    ]
    forms = [repr((sorted(one), form)) for one, form in zip(values, forms, strict=True)]
    ((usual, _),) = Counter(forms).most_common(1)
    kept = [number for number, form in enumerate(forms) if form == usual]
    mapping, values = made[kept[0]], [values[number] for number in kept]
    scalars = [key for key, value in values[0].items() if isinstance(value, float)]
    drawn = {key: np.array([one[key] for one in values]) for key in scalars}
    members = {EXTENSION + key: one for key, one in drawn.items() if np.ptp(one) > 0.0}
    for key, drawn in members.items():
        replace_into(mapping, key, _rounded(np.median(drawn)), structure.source)
    mapping |= {"name": f"{mapping['name']}-extended", "extension": title}
    stated = validated(StructureFile, mapping, structure.source)
    return _Extended(stated.model_dump(mode="json", exclude_defaults=True), members)


def _check_clash(variables, extended, study):
    """Refuse variables of a study that do not reach a block whose own value the cause states."""
    for structure, one in extended.items():
        for body in load_structure(structure).file.bodies:
            sampled = f"materials.{body.material}.density"
            if f"{EXTENSION}bodies.{body.name}.density" in one.members and sampled in variables:
                expected = f"expected no variable that the cause states of {body.name} itself"
                raise InputError(study, f"ensemble.distributions.{sampled}", expected)


def _digest(measured):
    campaign = load_campaign(measured.campaign)
    return file_digest(campaign.folder / campaign.tests[measured.test].file)


def _ensemble(ensemble, variables, path):
    """Entry ``ensemble`` of the extended study, and the target correlation, None where there is none."""
    linked, leaders = dict(ensemble.linked), {}
    for name, values in variables.items():
        same = next((one for one in leaders if np.array_equal(leaders[one], values)), None)
        if same is None:
            leaders[name] = values
        else:
            linked[name] = same
    given = {name: one.model_dump(mode="json") for name, one in ensemble.distributions.items()}
    given |= {
        name: {"distribution": "tabulated", "values": _quantiles(values)} for name, values in leaders.items()
    }
    target = complete_correlation(ensemble.correlation, list(given))
    own = slice(len(ensemble.distributions), None)
    among = np.atleast_2d(np.corrcoef(list(leaders.values())))
    among = np.where(np.abs(among) > _TOLD, among, 0.0)
    np.fill_diagonal(among, 1.0)
    target[own, own] = np.round(nearest_correlation(among), 4)
    asked = {"size": ensemble.size, "seed": ensemble.seed, "distributions": given, "linked": linked}
    named = np.flatnonzero((target != np.eye(len(given))).any(axis=0))
    if not len(named):
        return asked, None
    frame = pd.DataFrame(target, given, given).iloc[named, named]
    return {**asked, "correlation": str(path)}, frame


def _quantiles(values):
    """Quantiles at even steps of the probability from 0 to 1, rising."""
    steps = np.linspace(0.0, 1.0, _STEPS + 1)
    return [_rounded(value) for value in np.quantile(values, steps) + _RISE * np.ptp(values) * steps]


def _rounded(value):
    return float(f"{value:.{_DIGITS}g}")


def _header(verdict, found, causes, run=""):
    """Comment lines that say where a file comes from."""
    lines = [
        f"Written by `blockshake extend-study` {blockshake.__version__} from {Path(verdict).name}, digest "
        f"{file_digest(verdict)}, version {found.version}.",
        f"Word of the verdict: {found.word}{f' ({found.decision})' if found.causes else ''}.",
    ]
    for cause in causes:
        sizes = [
            f"{name} {one.estimate:.3g} [{one.lower:.3g}, {one.upper:.3g}] {one.unit}"
            for name, one in cause.parameters.items()
        ]
        where = f", {' or '.join(cause.places)}" if cause.place else ""
        lines.append(
            f"Cause: {cause.title} ({cause.name}{where}); estimate and 90 % interval: {', '.join(sizes)}."
        )
    lines += [f"Run: {run}"] if run else []
    return "".join(f"# {line}\n" for line in lines)


def _text(mapping):
    plain = json.loads(json.dumps(mapping))  # nothing stands in two places, which YAML would make an alias
    return yaml.safe_dump(plain, sort_keys=False, default_flow_style=None, width=100, allow_unicode=True)


def _write(texts, output):
    """Write all files; where the study is then not right, those that were there before stay."""
    before = {path: path.read_bytes() if path.exists() else None for path in texts}
    try:
        for path, text in texts.items():
            write_text(path, text)
        check_config(load_yaml(output), output)
    except InputError:
        for path, content in before.items():
            path.unlink(missing_ok=True) if content is None else path.write_bytes(content)
        raise
