"""Content of the report of a study, read from its files into one structure."""

from dataclasses import dataclass
from pathlib import Path

import pandas as pd
import xarray as xr

from blockshake.files import content_digest, file_digest, load_json, named_file
from blockshake.geometry.structure import Structure, load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.report.document.origin import software_versions
from blockshake.report.document.results import load_results
from blockshake.study.convergence.table import load_convergence
from blockshake.study.ensembles.case_input import measured_on_clock
from blockshake.study.ensembles.measured import measured_curves
from blockshake.study.ensembles.timing import read_timings
from blockshake.study.peer_record import PEER_RECORD, load_peer_record
from blockshake.study.sampling.distributions import load_distributions
from blockshake.study.sampling.latin_hypercube import load_design
from blockshake.study.sampling.sample_parameters import has_parameter

_PACKAGES = ("numpy", "scipy", "numba", "xarray", "pandas", "snakemake", "matplotlib", "typst")


@dataclass(frozen=True)
class Response:
    """Results of one case by one model: envelope, figures of the samples, coverage of the measured curves, and
    sensitivity to the random variables."""

    envelope: xr.Dataset
    samples: xr.Dataset
    comparison: xr.Dataset
    sensitivity: xr.Dataset


@dataclass(frozen=True)
class ReportedCase:
    """One structure under one motion.

    Attributes
    ----------
    name : str
    settings : dict
        The case's entry in the configuration.
    structure : Structure
    motion : str
        Name of its motion in `Content.motions`.
    base : xarray.Dataset
        The slab's measured motion, from `measured_input`.
    measured : xarray.Dataset
        From `measured_curves`.
    test_file : Path
        File of the measured test.
    synthetic : bool
        The measured test is a virtual one.
    marker_noise : float
        Standard deviation of the measured markers [m].
    responses : dict of str to Response
        By model.
    """

    name: str
    settings: dict
    structure: Structure
    motion: str
    base: xr.Dataset
    measured: xr.Dataset
    test_file: Path
    synthetic: bool
    marker_noise: float
    responses: dict

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
        return self.settings["structure"].startswith("configuration-")


@dataclass(frozen=True)
class Content:
    """The study's results.

    Attributes
    ----------
    study : dict
        The configuration.
    cases : dict of str to ReportedCase
    motions : dict of str to xarray.Dataset
        From `describe_motion`, by name.
    design, stiffness : pandas.DataFrame
        One row a sample.
    design_summary : dict
    distributions : dict of str to Lognormal
    waves, definitions : xarray.Dataset
    friction : dict of str to dict
        Friction calibrations by case; empty where the study asks for none.
    convergence : pandas.DataFrame or None
        From `study_convergence`, where the study has one.
    peer : xarray.Dataset
        From `load_peer_record`.
    timings : tuple of Timing
    digests : dict of str to str
        Of input files and of tables that all samples come from, by path.
    versions : dict of str to str
        Of the software that made the report.
    """

    study: dict
    cases: dict
    motions: dict
    design: pd.DataFrame
    stiffness: pd.DataFrame
    design_summary: dict
    distributions: dict
    waves: xr.Dataset
    definitions: xr.Dataset
    friction: dict
    convergence: pd.DataFrame | None
    peer: xr.Dataset
    timings: tuple
    digests: dict
    versions: dict

    def peak_acceleration(self, case):
        """Peak ground acceleration of a case's scaled motion [m/s2]."""
        return case.settings["scale"] * self.motions[case.motion].attrs["peak_acceleration"]

    def users(self, variable):
        """Names of the cases whose structure has what a random variable describes."""
        return [case.name for case in self.cases.values() if has_parameter(case.structure, variable)]


def load_content(study, results, benchmarks):
    """Read the `Content` of a finished study.

    Parameters
    ----------
    study : dict
        Its configuration, checked.
    results, benchmarks : str or path
        Folders of its results and of its jobs' benchmarks.

    Raises
    ------
    InputError
        A file is missing or holds something else.
    """
    results = Path(results)
    cases = {Path(case["structure"]).stem: case for case in study["cases"]}
    loaded = {name: _case(study, results, name, settings) for name, settings in cases.items()}
    motions = {}
    for named in [*(case["motion"] for case in cases.values()), *study["ladder"]["motions"]]:
        motions[Path(named).stem] = load_results(results / "motions" / f"{Path(named).stem}.nc")
    design, stiffness = results / "design.csv", results / "stiffness.csv"
    inputs = [
        named_file(f"{kind}s", case[kind]) for kind in ("structure", "motion") for case in cases.values()
    ]
    tests = [case.test_file for case in loaded.values()]
    return Content(
        study=study,
        cases=loaded,
        motions=motions,
        design=load_design(design),
        stiffness=load_design(stiffness),
        design_summary=load_json(results / "design.json"),
        distributions=load_distributions(study["ensemble"].get("distributions"), study["name"]),
        waves=load_results(results / "waves.nc"),
        definitions=load_results(results / "stiffness-definitions.nc"),
        friction={
            name: load_json(results / "friction" / f"{name}.json")
            for name in (study.get("friction_calibration") or {}).get("cases", ())
        },
        convergence=load_convergence(results / "convergence.csv") if study.get("convergence") else None,
        peer=load_peer_record(),
        timings=read_timings(
            benchmarks,
            {(model, case.name): one.samples for case in loaded.values() for model, one in case.responses.items()},
        ),
        digests={
            "configuration of the study": content_digest(study),
            **{_shown(path): file_digest(path) for path in [*inputs, *tests, design, stiffness, PEER_RECORD]},
        },
        versions=software_versions(_PACKAGES),
    )  # fmt: skip


def _case(study, results, name, settings):
    responses = {
        model: Response(
            *(
                load_results(results / kind / model / f"{name}.nc")
                for kind in ("envelopes", "samples", "comparisons", "sensitivities")
            )
        )
        for model in study["models"]
    }
    campaign = load_campaign(settings["measured"]["campaign"])
    base = load_results(results / "inputs" / f"{name}.nc")
    test, marker_noise = measured_on_clock(settings["measured"], base)
    slab_marker = next(iter(responses.values())).envelope.attrs["slab_marker"]
    return ReportedCase(
        name=name,
        settings=settings,
        structure=load_structure(settings["structure"]),
        motion=Path(settings["motion"]).stem,
        base=base,
        measured=measured_curves(test, slab_marker, settings["duration"]),
        test_file=campaign.folder / campaign.tests[settings["measured"]["test"]].file,
        synthetic=bool(test.attrs.get("synthetic", 0)),
        marker_noise=marker_noise,
        responses=responses,
    )


def _shown(path):
    """Path as a reader of another machine knows it: its last three parts."""
    return "/".join(Path(path).parts[-3:])
