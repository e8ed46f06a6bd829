"""Check of a user's file before anything runs: its kind, and its first fault."""

from pathlib import Path

from blockshake.dynamics.load_motion import load_motion
from blockshake.errors import InputError
from blockshake.files import load_yaml, shipped_names
from blockshake.forces.sight import sight_lines
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.study.config import load_config
from blockshake.study.config_checks import typical_structure
from blockshake.study.motion_remarks import motion_line, motion_remarks
from blockshake.study.sampling.distributions import TABLE_2
from blockshake.study.sampling.sample_parameters import has_parameter
from blockshake.study.structure_remarks import structure_lines, structure_remarks

_LATE = 5.0  # s of rest after a motion that need no remark


def check_file(source):
    """Content of a good file as it was understood, line by line, and remarks.

    Parameters
    ----------
    source : str or path
        A structure, a motion, a campaign or a study's configuration, by file, folder or shipped name.

    Raises
    ------
    InputError
        The first fault of the file.
    """
    if (Path(source) / "campaign.yaml").is_file():
        return _campaign_line(Path(source))
    if source in shipped_names("structures"):
        return _structure_line(source)
    if Path(source).suffix in (".yaml", ".yml"):
        keys = load_yaml(source).keys()
        if "bodies" in keys:
            return _structure_line(source)
        if "cases" in keys:
            return _study_line(source)
        if "tests" in keys:
            return _campaign_line(Path(source).parent)
        if "synthetic" not in keys:
            raise InputError(
                source, "", "expected a structure (bodies), a study (cases) or a synthetic motion (synthetic)"
            )
    motion = load_motion(source)
    return _with_remarks([motion_line(motion)], motion_remarks(motion))


def _structure_line(source):
    structure = load_structure(source)
    return _with_remarks(structure_lines(structure), structure_remarks(structure))


def _with_remarks(lines, remarks):
    return "\n".join([*lines, *(f"  remark: {remark}" for remark in remarks)])


def _campaign_line(folder):
    return "\n".join([*campaign_lines(folder), *sight_lines(load_campaign(folder))])


def _study_line(source):
    config = load_config(source)
    told = []
    for model in config.models:
        counts = sorted({config.samples(model, case.name) for case in config.cases})
        told.append(f"{model} ({' to '.join(map(str, dict.fromkeys((counts[0], counts[-1]))))} samples)")
    count = f"{len(config.cases)} case{'s' * (len(config.cases) != 1)}"
    return _with_remarks([f"a study of {count} by {', '.join(told)}"], _study_remarks(config))


def _study_remarks(config):
    """Structures whose samples are all alike, variables that none has, and remarks on each structure and motion."""
    structures = {case.structure: typical_structure(config, case) for case in config.cases}
    # Table 2 stands for all configurations of the paper, of which some have no steel
    for variable in (name for name in config.ensemble.distributions if name not in TABLE_2):
        if not any(has_parameter(one, variable) for one in structures.values()):
            yield f"ensemble.distributions.{variable}: no structure of the cases has it"
    for name, structure in structures.items():
        if not any(has_parameter(structure, variable) for variable in config.ensemble.distributions):
            yield f"{name}: no variable of ensemble.distributions is the structure's: all of its samples are alike"
        yield from (f"{name}: {remark}" for remark in structure_remarks(structure))
    motions = {case.motion: load_motion(case.motion) for case in config.cases}
    for name, motion in motions.items():
        yield from (f"{name}: {remark}" for remark in motion_remarks(motion))
    for case in config.cases:
        length = motions[case.motion].duration
        if case.duration > length + _LATE:
            yield f"{case.name}: {case.duration:g} s are simulated of a motion of {length:g} s"
