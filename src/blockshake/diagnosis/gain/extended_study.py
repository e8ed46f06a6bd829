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
from blockshake.effects.effect import Experiment
from blockshake.effects.places import nowhere
from blockshake.effects.registry import EFFECTS
from blockshake.errors import InputError
from blockshake.files import AnyPath, check_output, file_digest, load_yaml, write_text
from blockshake.geometry.schema import EXTENSION, StructureFile
from blockshake.geometry.structure import Structure, load_structure
from blockshake.geometry.structure_file import dotted_values, replace_into
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.campaigns.campaign_folder import copy_unless_same
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.quantities import unit_of
from blockshake.study.config import check_config, load_config
from blockshake.study.sampling.correlation_target import nearest_correlation
from blockshake.study.sampling.latin_hypercube import complete_correlation
from blockshake.validation import validated

_OF_THE_TABLE = ("base-compliance",)  # with those that act on the input: the slab's motion has it already
_STEPS = np.linspace(0.0, 1.0, 11)  # of the probability, at which quantiles are tabulated
_DIGITS = 6  # of a value
_RISE = 1e-4  # of their range, by which quantiles of equal members rise
_CORRELATED = 0.4  # correlation that 99 of 100 sets of 40 unrelated members stay below


class _Extended(NamedTuple):
    """A structure without and with a cause: the mapping of the latter at the medians, its file, and members of what
    varies, (n_members,) by dotted name."""

    structure: Structure
    mapping: dict
    path: Path
    members: dict


def extend_study(verdict: AnyPath, study: AnyPath, output: AnyPath) -> list[str]:
    """Write a study in which the cause of a verdict is a variable, and the structures that state it.

    Parameters
    ----------
    verdict : str or path
        ``verdict.json`` of a diagnosis.
    study : str or path
        Configuration of an ordinary study.
    output : str or path
        The extended study; the files of its structures, and of the correlation where there is any, lie with it
        and begin with its name.

    Returns
    -------
    list of str
        Lines that say what was written, and what was left out.

    Raises
    ------
    InputError
        A verdict of another version or that names nothing that a structure can hold, a study without a structure that
        has the cause, or one whose variables or names clash with it. Files that were there before stay as they are.

    Examples
    --------
    >>> import blockshake
    >>> for line in blockshake.extend_study("verdict.json", "my-study.yaml", "extended.yaml"):
    ...     print(line)
    extended-configuration-1.yaml
    extended.yaml
      extension.joints.slab.block-1.friction_factor [1]

    Notes
    -----
    The cause enters by `extended_experiment`, as in the diagnosis: each member of its posterior makes a structure, and
    the values by which these differ are the variables, tabulated by the quantiles of the members. Equal ones are
    linked; correlations that 40 members tell from none are kept. Calibrations and diagnoses stay with the study that
    is extended.
    """
    found, config, made = load_verdict(verdict), load_config(study), check_output(output)
    if made.suffix not in (".yaml", ".yml"):
        raise InputError(made, "", f"expected a YAML file, {made}.yaml")
    if config.extension is not None:
        raise InputError(study, "extension", "expected a study that has no cause yet")
    causes, lines = _causes(found, verdict)
    extended, pairs, cases, named_by = {}, {}, [], []
    for case in config.cases:
        structure = load_structure(case.structure)
        if any(map(_has_place, causes)) and structure.content != found.structure:
            lines.append(f"{case.name} is left out: its structure is not the one that was tested")
            continue
        path = made.with_name(f"{made.stem}-{Path(case.structure).stem}.yaml")
        name = f"{case.name}-extended"
        if case.structure not in extended:
            extended[case.structure] = _extended(structure, causes, path)
        given = case.model_dump(mode="json", exclude_defaults=True)
        cases += [given, {**given, "name": name, "structure": str(path)}]
        pairs[name] = case.name
        if case.measured and _digest(case.measured) in found.tests.values():
            named_by.append(name)
    if not cases:
        expected = "expected a case of the structure that the verdict is of, as its cause has a place there"
        raise InputError(study, "cases", expected)
    _check_clash(config.ensemble.distributions, extended.values(), study)
    variables = {name: values for one in extended.values() for name, values in one.members.items()}
    ensemble, target = _ensemble(config.ensemble, variables, made.with_name(f"{made.stem}-correlation.csv"))
    kept = {
        key: value
        for key, value in load_yaml(study).items()
        if key not in ("calibration", "diagnosis", "fragility", "structure")
    }
    whole = {
        **kept,
        "name": f"{config.name}-extended",
        "description": f"{config.description}; without and with {_title(causes)}",
        "cases": cases,
        "ensemble": ensemble,
        "extension": {"cases": pairs, "named_by": named_by},
    }
    climbs = [name for name in config.fragility.cases if name in pairs.values()] if config.fragility else []
    if climbs:
        climbs += [name for name, nominal in pairs.items() if nominal in climbs]
        whole["fragility"] = {**config.fragility.model_dump(mode="json"), "cases": climbs}
    header = _header(verdict, found, causes)
    texts = {one.path: header + _text(one.mapping) for one in extended.values()}
    texts |= {Path(ensemble["correlation"]): target.to_csv()} if target is not None else {}
    texts[made] = f"{header}# Run: blockshake study {made}\n{_text(whole)}"
    _write(texts, made)
    for one in extended.values():
        for mesh in {shape.mesh for shape in one.structure.file.shapes.values()} - {None}:
            copy_unless_same(one.structure.folder / mesh, made.parent / mesh)
    return [
        *lines,
        *map(str, texts),
        *(f"  {name} [{unit_of(name.removeprefix(EXTENSION))}]" for name in variables),
    ]


def _causes(found, verdict):
    """Causes of a verdict that a structure can hold, and lines on the others."""
    held = [cause for cause in found.extension if _can_state(cause)]
    others = [cause.name for cause in found.extension if not _can_state(cause)]
    if not held:
        expected = "expected a cause that acts in blocks, joints or forces and lasts"
        what = (
            f"found {', '.join(others)}"
            if others
            else f"its word is: {'; '.join([found.word, *found.missing])}"
        )
        raise InputError(verdict, "extension", f"{expected}; {what}")
    lines = [f"{name} is left out: no structure file can state it" for name in others]
    if found.decision == "ambiguous":
        lines.append(f"the verdict is one of several; the most probable is taken: {_title(held)}")
    return held, lines


def _can_state(cause):
    """Whether a structure file can state a cause: it is none of the table's or of the sensors', and it lasts."""
    held = cause.outside or EFFECTS[cause.name].acts not in ("input", "observation")
    return held and cause.name not in _OF_THE_TABLE and can_extend(cause)


def _title(causes):
    return " and ".join(cause.title for cause in causes)


def _has_place(cause):
    """Whether a cause acts at a place of the structure, and so in no other one."""
    return cause.outside or EFFECTS[cause.name].places is not nowhere


def _extended(structure, causes, path):
    """`_Extended` of a structure; members whose structures have other entries than most are left out."""
    made = []
    for number in range(MEMBERS):
        experiment = Experiment(structure, None, Instruments())
        for cause in causes:
            experiment = extended_experiment(experiment, cause, number, "")
        made.append(experiment.structure.file.model_dump(mode="json"))
    values = [dotted_values(mapping) for mapping in made]
    # entries with what is no number in them, such as the side of a stop
    forms = [
        repr([(key, not isinstance(value, float) and value) for key, value in one.items()]) for one in values
    ]
    ((usual, _),) = Counter(forms).most_common(1)
    kept = [number for number, form in enumerate(forms) if form == usual]
    scalars = [key for key, value in values[kept[0]].items() if isinstance(value, float)]
    drawn = {EXTENSION + key: np.array([values[number][key] for number in kept]) for key in scalars}
    members = {key: one for key, one in drawn.items() if np.ptp(one) > 0.0}
    mapping = made[kept[0]] | {"name": f"{structure.file.name}-extended", "extension": _title(causes)}
    for key, one in members.items():
        replace_into(mapping, key, _rounded(np.median(one)), structure.source)
    stated = validated(StructureFile, mapping, structure.source).model_dump(
        mode="json", exclude_defaults=True
    )
    return _Extended(structure, stated, path, members)


def _check_clash(variables, extended, study):
    """Refuse variables of a study that do not reach a block whose own value the cause states."""
    for one in extended:
        for body in one.structure.file.bodies:
            sampled = f"materials.{body.material}.density"
            if f"{EXTENSION}bodies.{body.name}.density" in one.members and sampled in variables:
                expected = f"expected no variable that the cause states of {body.name} itself"
                raise InputError(study, f"ensemble.distributions.{sampled}", expected)


def _digest(measured):
    campaign = load_campaign(measured.campaign)
    return file_digest(campaign.folder / campaign.tests[measured.test].file)


def _ensemble(ensemble, variables, path):
    """Entry ``ensemble`` of the extended study, and the target correlation of its file, None where there is none."""
    linked, leaders = dict(ensemble.linked), {}
    for name, values in variables.items():
        same = next((one for one in leaders if np.array_equal(leaders[one], values)), None)
        (leaders if same is None else linked)[name] = values if same is None else same
    given = {name: one.model_dump(mode="json") for name, one in ensemble.distributions.items()}
    for name, values in leaders.items():
        rising = np.quantile(values, _STEPS) + _RISE * np.ptp(values) * _STEPS
        given[name] = {"distribution": "tabulated", "values": list(map(_rounded, rising))}
    settings = {"size": ensemble.size, "seed": ensemble.seed, "distributions": given, "linked": linked}
    target = complete_correlation(ensemble.correlation, list(given))
    own = slice(len(ensemble.distributions), None)
    among = np.atleast_2d(np.corrcoef(list(leaders.values())))
    target[own, own] = np.round(nearest_correlation(np.where(np.abs(among) > _CORRELATED, among, 0.0)), 4)
    named = np.flatnonzero((target != np.eye(len(given))).any(axis=0))
    if not len(named):
        return settings, None
    return settings | {"correlation": str(path)}, pd.DataFrame(target, given, given).iloc[named, named]


def _rounded(value):
    return float(f"{value:.{_DIGITS}g}")


def _header(verdict, found, causes):
    """Comment lines that say where a file comes from."""
    lines = [
        f"Written by `blockshake extend-study` {blockshake.__version__} from {Path(verdict).name}, digest "
        f"{file_digest(verdict)}, version {found.version}.",
        f"Word of the verdict: {found.word} ({found.decision}).",
    ]
    for cause in causes:
        sizes = (
            f"{name} {one.estimate:.3g} [{one.lower:.3g}, {one.upper:.3g}] {one.unit}"
            for name, one in cause.parameters.items()
        )
        where = f", {' or '.join(cause.places)}" if cause.place else ""
        lines.append(
            f"Cause: {cause.title} ({cause.name}{where}); estimate and 90 % interval: {', '.join(sizes)}."
        )
    return "".join(f"# {line}\n" for line in lines)


def _text(mapping):
    plain = json.loads(json.dumps(mapping))  # nothing stands in two places, which YAML would make an alias
    return yaml.safe_dump(plain, sort_keys=False, default_flow_style=None, width=100, allow_unicode=True)


def _write(texts, output):
    """Write all files; where the study is then not right, those that were there before stay."""
    before = {path: path.read_bytes() if path.exists() else None for path in texts}
    there = output.parent.exists()
    try:
        for path, text in texts.items():
            write_text(path, text)
        check_config(load_yaml(output), output)
    except InputError:
        for path, content in before.items():
            path.unlink(missing_ok=True) if content is None else path.write_bytes(content)
        if not there:
            output.parent.rmdir()
        raise
