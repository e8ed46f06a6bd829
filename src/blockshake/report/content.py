"""All that the report shows, read from the study's files into one structure."""

import json
import platform
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from blockshake.errors import InputError
from blockshake.files import content_digest, file_digest, read_text, shipped
from blockshake.geometry.structure import Structure, load_structure
from blockshake.measurement.campaign import load_campaign, load_test
from blockshake.report.peer_record import PEER_RECORD, load_peer_record
from blockshake.report.timing import read_timings
from blockshake.study.convergence_table import load_convergence
from blockshake.study.distributions import load_distributions
from blockshake.study.ensemble import RESIDUAL_WINDOW, in_frames
from blockshake.study.sampling import load_design

_PACKAGES = ("numpy", "scipy", "numba", "xarray", "pandas", "snakemake", "matplotlib", "typst")


@dataclass(frozen=True)
class Response:
    """What one model made of one case: its envelope, its samples' figures, its coverage of the measured curves,
    its sensitivity to the random variables."""

    envelope: xr.Dataset
    samples: xr.Dataset
    comparison: xr.Dataset
    sensitivity: xr.Dataset


@dataclass(frozen=True)
class Case:
    """One structure under one motion.

    Attributes
    ----------
    name : str
    settings : dict
        The case's entry in the configuration.
    structure : Structure
    motion : str
        Name of its motion in `Content.motions`.
    measured : xarray.Dataset
        From `measured_curves`.
    test_file : Path
        Where they come from.
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
    measured: xr.Dataset
    test_file: Path
    synthetic: bool
    marker_noise: float
    responses: dict

    @property
    def slab_marker(self):
        """Marker that the frame ``slab`` moves with."""
        return next(iter(self.responses.values())).envelope.attrs["slab_marker"]


@dataclass(frozen=True)
class Content:
    """The study's results.

    Attributes
    ----------
    study : dict
        The configuration.
    cases : dict of str to Case
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


def load_content(study, results, benchmarks):
    """Read a finished study.

    Parameters
    ----------
    study : dict
        Its configuration, checked.
    results, benchmarks : str or path
        Folders of its results and of its jobs' benchmarks.

    Returns
    -------
    Content

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
        motions[Path(named).stem] = _dataset(results / "motions" / f"{Path(named).stem}.nc")
    design, stiffness = results / "design.csv", results / "stiffness.csv"
    inputs = [_definition(kind, case[kind]) for kind in ("structure", "motion") for case in cases.values()]
    tests = [case.test_file for case in loaded.values()]
    return Content(
        study=study,
        cases=loaded,
        motions=motions,
        design=load_design(design),
        stiffness=load_design(stiffness),
        design_summary=json.loads(read_text(results / "design.json")),
        distributions=load_distributions(study["ensemble"].get("distributions"), study["name"]),
        waves=_dataset(results / "waves.nc"),
        definitions=_dataset(results / "stiffness-definitions.nc"),
        friction={
            name: json.loads(read_text(results / "friction" / f"{name}.json"))
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
        versions={
            "blockshake": version("blockshake"),
            "Python": platform.python_version(),
            **{name: version(name) for name in _PACKAGES},
        },
    )  # fmt: skip


def measured_curves(test, slab_marker, duration):
    """Measured displacement along x over the simulated window.

    Parameters
    ----------
    test : xarray.Dataset
        ``marker_displacement(time, marker, axis)`` [m], inertial frame.
    slab_marker : str
        Marker that the frame ``slab`` moves with.
    duration : float
        Length of the window [s].

    Returns
    -------
    xarray.Dataset
        ``displacement(frame, time, marker)``, and by the definitions of `gather_ensemble`
        ``peak`` and ``residual(frame, marker)`` [m], over the window.
    """
    along = test["marker_displacement"].sel(axis="x", drop=True)
    along = along.isel(time=(along["time"] <= duration + 1e-6).to_numpy())
    along = in_frames(along, slab_marker)
    last = along["time"] >= duration - RESIDUAL_WINDOW
    return xr.Dataset(
        {
            "displacement": along,
            "peak": np.abs(along).max("time"),
            "residual": along.isel(time=last.to_numpy()).mean("time"),
        }
    )


def _case(study, results, name, settings):
    responses = {
        model: Response(
            *(
                _dataset(results / kind / model / f"{name}.nc")
                for kind in ("envelopes", "samples", "comparisons", "sensitivities")
            )
        )
        for model in study["models"]
    }
    campaign = load_campaign(settings["measured"]["campaign"])
    test = load_test(campaign, settings["measured"]["test"])
    slab_marker = next(iter(responses.values())).envelope.attrs["slab_marker"]
    return Case(
        name=name,
        settings=settings,
        structure=load_structure(settings["structure"]),
        motion=Path(settings["motion"]).stem,
        measured=measured_curves(test, slab_marker, settings["duration"]),
        test_file=campaign.folder / campaign.tests[settings["measured"]["test"]].file,
        synthetic=bool(test.attrs.get("synthetic", 0)),
        marker_noise=campaign.sensors.marker_noise,
        responses=responses,
    )


def _dataset(path):
    try:
        return xr.load_dataset(path)
    except (OSError, ValueError) as error:
        raise InputError(path, "", f"expected a netCDF file of results; {error}") from None


def _definition(kind, named):
    path = shipped(f"{kind}s", named)
    return path if path.exists() else Path(named)


def _shown(path):
    """Path as a reader of another machine knows it: its last three parts."""
    return "/".join(Path(path).parts[-3:])
