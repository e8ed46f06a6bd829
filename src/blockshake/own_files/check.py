"""Check of a user's file before anything runs: its kind, and its first fault, by the functions that commands run."""

import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from blockshake.diagnosis.nominal.plan import plan_diagnosis
from blockshake.diagnosis.nominal.planned_test import planned_motion
from blockshake.dynamics.baseline import AUTO
from blockshake.dynamics.intensity import motion_figures, strong_until
from blockshake.dynamics.load_motion import load_motion, provenance
from blockshake.dynamics.motion import GroundMotion
from blockshake.dynamics.record_choice import mean_and_scatter
from blockshake.dynamics.record_set import DrawnMotions, is_record_set, read_records, record_files
from blockshake.dynamics.synthetic_motion import SyntheticMotion
from blockshake.errors import InputError, faults_of
from blockshake.files import AnyPath, check_past, load_yaml, named_file, shipped_names
from blockshake.forces.seen.sight import sight_lines
from blockshake.geometry.schema import StructureFile
from blockshake.geometry.structure import Structure, load_structure
from blockshake.measurement.campaigns.campaign import CampaignFile, load_campaign, load_test
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.measurement.checks.campaign_check import campaign_lines
from blockshake.own_files.import_campaign import make_campaign
from blockshake.own_files.import_map import ImportMap, load_map
from blockshake.pages.wording import count_words
from blockshake.study.config import StudyConfig, load_config
from blockshake.study.config_checks import typical_structure
from blockshake.study.ensembles.case_input import measured_input
from blockshake.study.remarks import motion_line, motion_remarks, structure_lines, structure_remarks
from blockshake.study.sampling.sample_parameters import has_parameter
from blockshake.validation import Strict
from blockshake.virtual.settings import VirtualCampaign, load_settings

_WIDEST = 1.0  # of a variable, its standard deviation over its mean
_SLOWEST = 50.0  # Hz; impacts and peaks of a rocking stack lie between rows that are farther apart
_LOW = 5.0  # times the highest level that the records' own intensities are
_LATE = 5.0  # s of rest after a motion that need no remark


def check(source: AnyPath | Structure | GroundMotion, baseline: str | float = AUTO) -> str:
    """Content of a good file as it was understood, line by line, and remarks.

    Parameters
    ----------
    source : str, path, Structure or GroundMotion
        A structure, a motion, a campaign, a study's configuration, the map of an import or the settings of a virtual
        campaign, by file, folder or shipped name; or a loaded structure or motion.
    baseline : str or float
        Baseline correction of a motion, see `load_motion`; the other files name their own.

    Returns
    -------
    str

    Raises
    ------
    InputError
        The first fault of the file, or of what it names.

    Examples
    --------
    >>> import blockshake
    >>> print(blockshake.check("my.yaml"))
    a structure of 2 blocks of 3813 kg in all, and 2 joints
      2 of 0.6 x 1.2 x 1 m, 1907 kg, height over width along x 1.7
      2 blocks from block-1 up: mass centre at x 0 m, 1 m above the foot, height over width along x 3.3
    """
    if isinstance(source, Structure) or source in shipped_names("structures"):
        return _structure_line(source)
    if isinstance(source, GroundMotion):
        return _motion_line(source, baseline)
    if (Path(source) / "campaign.yaml").is_file():
        return _campaign_line(Path(source))
    if is_record_set(source):
        try:
            lines = (f"{one.name}: {_motion_line(one.path, baseline)}" for one in read_records(source))
            return "\n".join(lines)
        except InputError as error:
            if not Path(source).is_dir():
                raise
            wrong = f"expected a campaign, or a folder of records alone; it has no campaign.yaml, and {error}"
            raise InputError(source, "", wrong) from None
    if Path(source).suffix not in (".yaml", ".yml"):
        return _motion_line(source, baseline)
    keys = load_yaml(source).keys()
    known = {schema: len(keys & schema.model_fields.keys()) for schema in _LINES}
    if not any(known.values()):
        wrong = (
            "expected a structure (bodies), a study (cases), a campaign (tests), the map of an import (columns), a "
            "virtual campaign (intensities) or a synthetic motion (synthetic)"
        )
        raise InputError(source, "", wrong)
    kind = max(known, key=lambda schema: known[schema])
    return _motion_line(source, baseline) if kind is SyntheticMotion else _LINES[kind](source)


def _motion_line(source, baseline):
    motion = load_motion(source, baseline=baseline)
    return _with_remarks([motion_line(motion)], motion_remarks(motion))


def _structure_line(source):
    structure = load_structure(source)
    return _with_remarks(structure_lines(structure), structure_remarks(structure))


def _with_remarks(lines, remarks):
    return "\n".join([*lines, *(f"  remark: {remark}" for remark in remarks)])


def _campaign_line(folder):
    campaign = load_campaign(folder)
    lines = campaign_lines(folder)
    more, remarks = campaign.kind.remark(campaign)
    lines += more
    return _with_remarks(lines, [remark for remark in remarks if not any(remark in line for line in lines)])


def remark_shaken(campaign):
    """Lines on what the sensors show of a stack, and remarks on its structure."""
    return sight_lines(campaign), structure_remarks(load_structure(campaign.structure))


def remark_outcomes(campaign):
    """No line; remarks on the structure and the motions of a campaign of outcomes."""
    remarks = structure_remarks(load_structure(campaign.structure))
    for test in campaign.tests.values():
        remarks += [f"{test.name}: {remark}" for remark in motion_remarks(commanded_motion(campaign, test))]
    return [], remarks


def _import_line(source):
    """Lines of the campaign that the map would make; it is made, and thrown away."""
    with tempfile.TemporaryDirectory() as folder:
        lines = make_campaign(load_map(source), Path(folder) / "campaign", source)
    return "\n".join(line.replace(f"{folder}/", "") for line in lines)


def _virtual_line(source):
    settings = load_settings(source)
    return f"a virtual campaign by {settings.model}, under {', '.join(settings.motions)}"


def _study_line(source):
    config = load_config(source)
    for case in config.cases:
        for path in (named_file("structures", case.structure), *record_files(case.motion)):
            check_past(path)
    _read_measured(config, source)
    models = []
    for model in config.models:
        counts = sorted({config.samples(model, case.name) for case in config.cases})
        models.append(f"{model} ({' to '.join(map(str, dict.fromkeys((counts[0], counts[-1]))))} samples)")
    loaded = {}
    drawn = {case.name: DrawnMotions.of(case.model_dump(), loaded) for case in config.cases}
    motions = {name: list(one.strongest()) for name, one in drawn.items()}
    used = {record.path for one in drawn.values() for record in one.records}
    records = [
        f"  {name}: {provenance(motion.attributes)}" for (name, _), motion in loaded.items() if name in used
    ]
    lines = [f"a study of {count_words(len(config.cases), 'case')} by {', '.join(models)}", *records]
    lines += [_used_line(name, one, motions[name]) for name, one in drawn.items()]
    lines += [_choice_line(name, one) for name, one in drawn.items() if one.intensity.spectrum]
    remarks = [*_level_remarks(drawn), *_study_remarks(config, motions)]
    return _with_remarks(lines, remarks)


def _choice_line(case, drawn):
    """Records that are chosen to a target spectrum, and how near to it."""
    target = drawn.intensity.spectrum
    mean, scatter = mean_and_scatter(target, [drawn.motion(record) for record in drawn.records])
    names = ", ".join(f"{record.name} x {record.scale:.3g}" for record in drawn.records)
    off = np.abs(scatter - (target.deviation or 0.0)).max()
    return (
        f"  {case}: {len(drawn.records)} records are chosen, {names}; their median is within "
        f"{100 * np.expm1(np.abs(mean).max()):.2g} % of the target's at each period, their scatter within {off:.2g}"
    )


def _used_line(case, drawn, motions):
    """Peak acceleration of a case's motions as they are used: corrected and scaled, to the highest level."""
    peaks = [motion_figures(motion)["peak_acceleration"] for motion in motions]
    one = Path(drawn.records[0].path).name if len(motions) == 1 else count_words(len(motions), "record")
    shown = " to ".join(dict.fromkeys(f"{peak:.3g}" for peak in (min(peaks), max(peaks))))
    level = " at the highest level" if drawn.intensity.levels else ""
    return f"  {case}: {one}, PGA as used{level} {shown} m/s2 along x"


def _level_remarks(drawn):
    """Levels that are far below the records' own intensities, as those in g are."""
    for name, motions in drawn.items():
        levels = motions.intensity.levels
        if levels and _LOW * levels[-1] < (own := motions.weakest_own()):
            yield (
                f"{name}: the highest level, {levels[-1]:g}, is far below the records' own {own:.3g} and more: "
                "levels are in m/s2, or m/s, not in g"
            )


def _read_measured(config, source):
    """Read what the study's jobs read of measured tests, open ones of calibrations too, and plan its diagnoses."""
    calibrated = config.calibration.cases.values() if config.calibration else ()
    for index, case in enumerate(config.cases):
        if case.measured is not None:
            with faults_of(source, f"cases.{index}.measured"):
                measured_input(case.model_dump(), case.measured.model_dump())
                if any(case.name in names for names in calibrated):
                    campaign = load_campaign(case.measured.campaign)
                    for name in campaign.open:
                        load_test(campaign, name)
                        planned_motion(campaign, name)
    for folder in config.diagnosis.campaigns:
        with faults_of(source, "diagnosis.campaigns"):
            campaign_lines(folder)
            plan_diagnosis(folder, config.diagnosis.effort)


def _study_remarks(config, motions):
    """Structures whose samples are all alike, and remarks on each structure and motion."""
    structures = {
        case.structure: typical_structure(load_structure(case.structure), config.ensemble)
        for case in config.cases
    }
    for name, structure in structures.items():
        if not any(has_parameter(structure, variable) for variable in config.ensemble.distributions):
            yield f"{name}: no variable of ensemble.distributions is the structure's: all of its samples are alike"
        yield from (f"{name}: {remark}" for remark in structure_remarks(structure))
    for name, variable in config.ensemble.distributions.items():
        if _WIDEST < variable.cov < np.inf:
            yield f"{name} has a cov of {variable.cov:g}: expected a share, 0.1 for 10 %"
    if config.output_rate < _SLOWEST:
        yield f"{config.output_rate:g} rows a second miss the peaks of drifts and forces: 200 is usual"
    shaken = [motion for case in config.cases for motion in motions[case.name]]
    for (name, scale), motion in {
        (one.name, one.attributes.get("scale", 1.0)): one for one in shaken
    }.items():
        yield from (f"{name} at {scale:.4g}: {remark}" for remark in motion_remarks(motion))
    for case in config.cases:
        count = (
            len(motions[case.name]) * max(1, len(case.intensity.levels))
            if case.intensity
            else config.ensemble.size
        )
        if count < config.ensemble.size:
            yield (
                f"{case.name}: {config.ensemble.size} samples draw {count} motions, each several times: limits that "
                "take samples as independent are too narrow"
            )
        length = max(motion.duration for motion in motions[case.name])
        end = max(map(strong_until, motions[case.name]))
        if case.duration > length + _LATE:
            yield f"{case.name}: {case.duration:g} s are simulated of a motion of {length:g} s"
        if case.duration < end:
            yield (
                f"{case.name}: {case.duration:g} s are simulated of a motion that is strong until {end:.3g} s: blocks "
                "that fall later count as standing"
            )


_LINES: dict[type[Strict], Callable[..., str]] = {
    StructureFile: _structure_line,
    StudyConfig: _study_line,
    CampaignFile: lambda source: _campaign_line(Path(source).parent),
    ImportMap: _import_line,
    VirtualCampaign: _virtual_line,
    SyntheticMotion: _motion_line,
}
"""Lines of a file, by the schema that has most of its keys."""
