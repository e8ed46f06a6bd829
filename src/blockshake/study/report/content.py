"""Content of the report of a study, read from its files into one structure."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

import pandas as pd
import xarray as xr

from blockshake.dynamics.record_set import record_files
from blockshake.files import content_digest, file_digest, load_json, named_file
from blockshake.geometry.structure import Structure, load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.measurement.sensors import markers
from blockshake.pages.origin import software_versions
from blockshake.pages.wording import SQUARED, given, listed
from blockshake.store import load_made
from blockshake.study.analyses import ANALYSES, OF_THE_PAPER
from blockshake.study.ensembles.case_input import measured_on_clock
from blockshake.study.ensembles.ensemble import measured_curves
from blockshake.study.ensembles.envelope import single_figures
from blockshake.study.ensembles.levels import at_level, levels_of
from blockshake.study.growth import FILE
from blockshake.study.sampling.distributions import load_distributions
from blockshake.study.sampling.sample_parameters import has_parameter
from blockshake.study.sampling.sample_table import load_design


@dataclass(frozen=True)
class Response:
    """Results of one case by one model: envelope, figures of the samples, motion of those that are shown, coverage of
    the measured curves where there are any, sensitivity to the random variables, and fragility over the intensity of
    the motions where the samples draw these."""

    envelope: xr.Dataset
    samples: xr.Dataset
    shown: xr.Dataset | None  # none while the study runs, as the others
    comparison: xr.Dataset | None
    sensitivity: xr.Dataset | None
    cloud: xr.Dataset | None = None
    indices: xr.Dataset | None = None  # from `indices_of_case`
    limits: xr.Dataset | None = None  # from `limit_states_of_case`, where the study has limit states

    def at(self, levels, level):
        """The samples of one level, and their statistics without histories; ``levels``: by sample."""
        samples = at_level(self.samples, levels, level)
        drift = self.envelope["largest_drift"].to_numpy()
        # whether a block still moves is known of all levels together alone
        envelope = single_figures(samples, drift).assign(still_moving=self.envelope["still_moving"])
        limits = self.limits
        if limits is not None:
            limits = limits[["value", "exceeded"]].sel(sample=samples["sample"].values)
        known = {name: one for name in ("sensitivity", "indices") if (one := getattr(self, name)) is not None}
        of_level = {name: one.sel(level=level) for name, one in known.items()}
        return replace(self, envelope=envelope, samples=samples, limits=limits, **of_level)


class Stripe(NamedTuple):
    """A case, or its samples of one level: one unit of the report, since levels are never pooled."""

    name: str  # of the case, with the level in words
    case: "ReportedCase"
    level: float | None  # in the unit of the measure of intensity
    responses: dict  # str to Response; by model, those of the level

    @property
    def key(self):
        """Name as an anchor of a page."""
        return self.case.name if self.level is None else f"{self.case.name}-{self.level:g}"

    @property
    def differences(self):
        """Result of `compare_models`, of the level."""
        found = self.case.differences
        return found if self.level is None else found.sel(level=self.level)


@dataclass(frozen=True)
class ReportedCase:
    """One structure under one motion."""

    name: str
    settings: dict  # the case's entry in the configuration
    structure: Structure
    motion: str  # name of its motion in `Content.motions`
    # the slab's measured motion, from `measured_input`; none where the case is compared with no test
    base: xr.Dataset | None
    measured: xr.Dataset | None  # from `measured_curves`; none likewise
    test: xr.Dataset | None  # the measured test, from `measured_on_clock`
    test_file: Path | None  # its file
    synthetic: bool  # the measured test is a virtual one
    marker_noise: float  # standard deviation of the measured markers, or of the optical system's [m]
    responses: dict  # str to Response; by model
    differences: xr.Dataset | None  # from `compare_models`; none while the study runs
    levels: dict = field(default_factory=dict)  # level by sample, where the samples are scaled to some

    @property
    def stripes(self):
        """`Stripe` of every level, the lowest first; one of the whole case where it has no levels."""
        if not self.levels:
            return (Stripe(self.name, self, None, self.responses),)
        return tuple(
            Stripe(
                self.at_levels([level]), self, level,
                {model: one.at(self.levels, level) for model, one in self.responses.items()},
            )
            for level in sorted(set(self.levels.values()))
        )  # fmt: skip

    def at_levels(self, levels):
        """Name of the case with some of its levels: ``stack at 3 and 6 m/s2``."""
        return f"{self.name} at {listed([*map(given, levels)])} {self.level_unit}"

    @property
    def level_unit(self):
        """Unit of the levels."""
        return "m/s" if self.settings["intensity"]["measure"] == "pgv" else f"m/s{SQUARED}"

    @property
    def curve_word(self):
        """Name of the measured curve."""
        return "virtual test (synthetic)" if self.synthetic else "measured"

    @property
    def title(self):
        """Name and description."""
        return f"{self.name}: {self.structure.file.description}"

    @property
    def is_shipped(self):
        """Whether the structure is one of the paper's, by its name."""
        return self.settings["structure"] in OF_THE_PAPER


@dataclass(frozen=True)
class Calibrated:
    """Contact stiffness of the samples, one row each, and wave tests behind it, of cases whose blocks are alike."""

    cases: tuple
    stiffness: pd.DataFrame
    waves: xr.Dataset


@dataclass(frozen=True)
class Content:
    """The study's results."""

    study: dict  # the configuration
    only: str | None  # name of the case that is reported alone; none where all are
    cases: dict  # str to ReportedCase
    motions: dict  # str to xarray.Dataset; from `describe_motion`, by name
    design: pd.DataFrame  # pandas.DataFrame; one row a sample
    design_summary: dict
    growth: str  # why a study that grows stopped; empty of others
    distributions: dict  # str to Lognormal
    # of Calibrated; every case in one of them; empty where the study tells of no contact stiffness
    calibrated: tuple
    calibration: dict | None  # from `calibrate`, where the study asks for one; a case alone has none
    fragility: dict  # str to xarray.Dataset; from `fragility`, by case; empty where the study asks for none
    # str to xarray.Dataset; from `changes`, by the case with the cause; empty where the study has none
    changes: dict
    digests: dict  # str to str; of input files and of tables that all samples come from, by path
    versions: dict  # str to str; of the software that made the report

    @property
    def stripes(self):
        """`Stripe` of every case and level, in order."""
        return [stripe for case in self.cases.values() for stripe in case.stripes]

    def places(self, names):
        """Names of some stripes, those of one case together: ``block at 3 m/s2``, ``stack at 3 and 6 m/s2``."""
        chosen = {}
        for one in self.stripes:
            if one.name in names:
                chosen.setdefault(one.case.name, []).append(one.level)
        return [
            name if levels == [None] else self.cases[name].at_levels(levels)
            for name, levels in chosen.items()
        ]

    def peak_acceleration(self, case):
        """Peak ground acceleration of a case's scaled motion, or the median of those that its samples draw [m/s2]."""
        clouds = [one.cloud for one in case.responses.values() if one.cloud is not None]
        if clouds:
            largest = max(clouds, key=lambda cloud: cloud.sizes["sample"])
            return float(largest["peak_acceleration"].median())
        return case.settings["scale"] * self.motions[case.motion].attrs["peak_acceleration"]

    def users(self, variable):
        """Names of the cases whose structure has what a random variable describes."""
        return [case.name for case in self.cases.values() if has_parameter(case.structure, variable)]


def load_content(study, results, only=None):
    """Read the `Content` of a finished study, or of one of its cases.

    Parameters
    ----------
    study : dict
        Its configuration, checked.
    results : str or path
        Folder of its results.
    only : str, optional
        Name of the case that is reported alone: nothing of the others is read.

    Raises
    ------
    InputError
        A file is missing or holds something else.
    """
    results = Path(results)
    every = {case["name"]: case for case in study["cases"]}
    cases = {only: every[only]} if only else every
    read = {one.name: one.results(study, results, only) for one in ANALYSES}
    loaded = {name: _case(study, read, name, settings) for name, settings in cases.items()}
    motions = {}
    for name in dict.fromkeys(Path(case["motion"]).stem for case in cases.values()):
        motions[name] = load_made(results / "motions" / f"{name}.nc")
    design = results / "design.csv"
    stiffness = [results / "stiffness" / f"{name}.csv" for name, _ in read["stiffness"]]
    inputs = [named_file("structures", case["structure"]) for case in cases.values()]
    inputs += [path for case in cases.values() for path in record_files(case["motion"])]
    tests = [case.test_file for case in loaded.values() if case.test_file]
    return Content(
        study=study,
        only=only,
        cases=loaded,
        motions=motions,
        design=load_design(design),
        design_summary=load_json(results / "design.json"),
        growth=load_json(results / FILE)["stopped"] if (results / FILE).is_file() else "",
        distributions=load_distributions(study["ensemble"].get("distributions"), study["name"]),
        calibrated=_calibrated(read["stiffness"], read["waves"]),
        calibration=next(iter(read["calibration"].values()), None),
        fragility={case: made for (case, _), made in read["fragility"].items()},
        changes={case: made for (case, _), made in read["changes"].items()},
        digests={
            "configuration of the study": content_digest(study),
            **{_shown(path): file_digest(path) for path in [*inputs, *tests, design, *stiffness]},
        },
        versions=software_versions(),
    )  # fmt: skip


def cases_so_far(study, results):
    """`ReportedCase` by name, of the cases that a model has done, with those models alone; of a study that runs.

    ``study`` and ``results`` as of `load_content`; only envelopes, samples and measured inputs are read.
    """
    read = {one.name: {} for one in ANALYSES}
    for one in ANALYSES:
        if one.name in ("envelopes", "samples", "inputs"):
            paths = {key: Path(results, file) for key, file in one.files(study).items()}
            read[one.name] = {key: one.load(path) for key, path in paths.items() if path.is_file()}
    done = {case for case, _ in read["envelopes"].keys() & read["samples"].keys()}
    return {
        case["name"]: _case(study, read, case["name"], case)
        for case in study["cases"]
        if case["name"] in done
    }


def _case(study, read, name, settings):
    named = settings.get("measured")
    responses = {
        model: Response(
            envelope=read["envelopes"][name, model],
            samples=read["samples"][name, model],
            shown=read["shown"].get((name, model)),
            comparison=read["comparisons"].get((name, model)),
            sensitivity=read["sensitivities"].get((name, model)),
            cloud=read["clouds"].get((name, model)),
            indices=read["indices"].get((name, model)),
            limits=read["limits"].get((name, model)),
        )
        for model in study["models"]
        if {(name, model)} <= read["envelopes"].keys() & read["samples"].keys()
    }
    base = campaign = test = None
    marker_noise = markers.NOISE
    if named:
        campaign = load_campaign(named["campaign"])
        base = read["inputs"][name, None]
        test, marker_noise = measured_on_clock(named, base)
    return ReportedCase(
        name=name,
        settings=settings,
        structure=load_structure(settings["structure"]),
        motion=Path(settings["motion"]).stem,
        base=base,
        measured=measured_curves(test, test.attrs["slab_marker"], settings["duration"]) if named else None,
        test=test,
        test_file=campaign.folder / campaign.tests[named["test"]].file if named else None,
        synthetic=bool(test.attrs.get("synthetic", 0)) if named else False,
        marker_noise=marker_noise,
        responses=responses,
        differences=read["differences"].get((name, None)),
        levels=levels_of(settings, study["ensemble"]["seed"], study["ensemble"]["size"]),
    )


def _calibrated(stiffness_of, waves_of):
    """Stiffness of the cases, those of equal tables and waves together."""
    groups = []
    for (name, _), stiffness in stiffness_of.items():
        waves = waves_of[name, None]
        alike = [one for one in groups if one[1].equals(stiffness) and one[2].equals(waves)]
        if alike:
            alike[0][0].append(name)
        else:
            groups.append(([name], stiffness, waves))
    return tuple(Calibrated(tuple(cases), stiffness, waves) for cases, stiffness, waves in groups)


def _shown(path):
    """Path as a reader of another machine knows it: its last three parts."""
    return "/".join(Path(path).parts[-3:])
