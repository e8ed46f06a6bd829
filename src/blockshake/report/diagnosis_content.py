"""All that the report of a diagnosis shows, read from the campaign's results into one structure."""

import json
import platform
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np
import xarray as xr

from blockshake.diagnosis.candidates import candidates
from blockshake.diagnosis.licence import Licence, load_licence
from blockshake.diagnosis.plan import EFFORTS
from blockshake.diagnosis.verdict import Verdict, load_verdict
from blockshake.errors import InputError
from blockshake.files import file_digest, read_text
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaign import Campaign, load_campaign, load_test
from blockshake.measurement.commanded_motion import commanded_motion

_PACKAGES = ("numpy", "scipy", "numba", "scikit-learn", "xarray", "snakemake", "matplotlib", "typst")
_RESULTS = (
    "parity.json",
    "measured.nc",
    "decision.json",
    "misfit.nc",
    "evidence.nc",
    "verdict.json",
)
_OF_GAIN = ("gain.json", "gain.nc", "consequences.nc")
_OF_SIZE = "size.json"


@dataclass(frozen=True)
class Diagnosed:
    """A campaign's diagnosis.

    Attributes
    ----------
    campaign : Campaign
    effort : str
        One of `plan.EFFORTS`.
    synthetic : bool
        Any test that was judged by is a virtual one.
    verdict : Verdict
    decision, parity, frozen : dict
        From `decision_as_json`, `Parity.as_json`, `freeze`.
    gain_caveats : list of str
    readings, misfit, evidence : xarray.Dataset
        From `measured_readings`, `misfit` and `deciding_features`.
    gain, consequences : xarray.Dataset or None
        From `campaign_gain`; None where no physical cause's gain was measured.
    size : dict or None
        From `size_of_cause`; None where the effort has no further draws, or there is no physical cause.
    sensor_gain : xarray.Dataset or None
        From `sensor_gain`; None where a sensor's fault is not the only cause.
    horizon : dict of str to float
        By test: time for which it can be predicted [s]; empty where that was not measured.
    structure : str
        Its name.
    motions : dict of str to dict
        By name of a commanded motion: its provenance.
    places : dict of str to dict
        By key of a candidate: where in the structure it is.
    licence : Licence or None
        None while the procedure has none.
    digests, versions : dict of str to str
        Of the files that the report rests on, and of the software that made it.
    """

    campaign: Campaign
    effort: str
    synthetic: bool
    verdict: Verdict
    decision: dict
    parity: dict
    frozen: dict
    gain_caveats: list
    readings: xr.Dataset
    misfit: xr.Dataset
    evidence: xr.Dataset
    gain: xr.Dataset | None
    consequences: xr.Dataset | None
    size: dict | None
    sensor_gain: xr.Dataset | None
    horizon: dict
    structure: str
    motions: dict
    places: dict
    licence: Licence | None
    digests: dict
    versions: dict

    @property
    def tests(self):
        """Names of the tests that were judged by, as in `readings`."""
        return [str(name) for name in self.readings["test"].values]

    @property
    def top(self):
        """The highest body whose motion was read."""
        read = self.readings["drift"].notnull().any(("test", "time")).to_numpy()
        height = np.where(read, self.readings["height"].to_numpy(), -np.inf)
        return str(self.readings["body"].values[int(np.argmax(height))])

    @property
    def measured_word(self):
        """What a curve of a test is called."""
        return "virtual test (synthetic)" if self.synthetic else "measured"

    @property
    def sensor_causes(self):
        """Causes of the verdict that the sensors' checks found."""
        return [name for name in self.verdict.causes if name not in self.decision["causes"]]

    @property
    def shown_candidates(self):
        """Keys of the candidates that the tests speak for: of the causes, or of the strongest effect."""
        found = [self.decision["places"][name] for name in self.decision["causes"]]
        return found or [self.decision["candidates"][0]["key"]]

    def candidate(self, key):
        """Row of a candidate in the decision's table."""
        return next(row for row in self.decision["candidates"] if row["key"] == key)


def load_diagnosed(campaign, results, effort, licence, horizons=()):
    """Read the results of a diagnosis; no sealed test's file is opened.

    Parameters
    ----------
    campaign : str or path
        Its folder.
    results : str or path
        Folder with ``verdict.json`` and what it rests on.
    effort : str
    licence : str or path
        The procedure's licence, or where it will be.
    horizons : sequence of str or path, optional
        Files of the tests' predictability, in the order of the readings.

    Returns
    -------
    Diagnosed

    Raises
    ------
    InputError
        A file is missing or holds something else.
    """
    results, campaign, licence = Path(results), load_campaign(campaign), Path(licence)
    structure = load_structure(campaign.structure)
    readings = _dataset(results / "measured.nc")
    names = [str(name) for name in readings["test"].values]
    files = [campaign.folder / "campaign.yaml"]
    files += [campaign.folder / campaign.tests[name].file for name in names]
    verdict = load_verdict(results / "verdict.json")
    decision = _json(results / "decision.json")
    physical = bool(decision["causes"])
    sized = physical and bool(EFFORTS[effort].further_draws)
    measured = verdict.gain is not None  # files of an earlier gain may still lie there
    files += [results / name for name in (*_RESULTS, *(_OF_GAIN if measured else ()))]
    files += [results / _OF_SIZE] if sized else []
    return Diagnosed(
        campaign=campaign,
        effort=effort,
        synthetic=any(_synthetic(load_test(campaign, name).attrs) for name in names),
        verdict=verdict,
        decision=decision,
        parity=_json(results / "parity.json"),
        frozen=_json(results / "frozen.json"),
        gain_caveats=_json(results / "gain.json")["caveats"]
        if measured
        else [caveat for caveat in verdict.caveats if "no gain was measured" in caveat],
        readings=readings,
        misfit=_dataset(results / "misfit.nc"),
        evidence=_dataset(results / "evidence.nc"),
        gain=_dataset(results / "gain.nc") if measured and physical else None,
        consequences=_dataset(results / "consequences.nc") if measured and physical else None,
        size=_json(results / _OF_SIZE) if sized else None,
        sensor_gain=_dataset(results / "gain.nc") if measured and not physical else None,
        horizon={
            name: float(_dataset(path)["horizon"].min()) for name, path in zip(names, horizons, strict=False)
        },
        structure=structure.file.name,
        motions=_motions(campaign),
        places={one.key: one.place for one in candidates(structure)},
        licence=load_licence(licence) if licence.exists() else None,
        digests={"/".join(path.parts[-2:]): file_digest(path) for path in files},
        versions={
            "blockshake": version("blockshake"),
            "Python": platform.python_version(),
            **{name: version(name) for name in _PACKAGES},
        },
    )


def _synthetic(attributes):
    """Whether a test file says of itself that it is synthetic: by this program's mark, its title or its source."""
    words = f"{attributes.get('title', '')} {attributes.get('source', '')}".lower()
    return bool(attributes.get("synthetic", 0)) or "synthetic" in words


def _motions(campaign):
    """Provenance of the motions that were commanded; nothing of one that is not at hand."""
    tests = {test.motion: test for test in campaign.tests.values()}
    found = {name: commanded_motion(campaign, test) for name, test in tests.items()}
    return {name: motion.attributes for name, motion in found.items() if motion is not None}


def _json(path):
    try:
        return json.loads(read_text(path))
    except json.JSONDecodeError as error:
        raise InputError(path, "", f"expected JSON; {error}") from None


def _dataset(path):
    try:
        return xr.load_dataset(path)
    except (OSError, ValueError) as error:
        raise InputError(path, "", f"expected a netCDF file of results; {error}") from None
