"""Content of the report of a diagnosis, read from the results of the campaign into one structure."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from blockshake.diagnosis.inference.decision import CauseSize, Decision, load_result
from blockshake.diagnosis.libraries.candidates import candidates
from blockshake.diagnosis.libraries.efforts import EFFORTS
from blockshake.diagnosis.verdict.track_record import TrackRecord, load_track_record
from blockshake.diagnosis.verdict.verdict import MeasuredGain, Verdict, load_verdict
from blockshake.files import file_digest, load_json
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Campaign, load_campaign, load_test
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.parity.parity import Parity, load_parity
from blockshake.report.document.origin import software_versions
from blockshake.store import load_made

_PACKAGES = ("numpy", "scipy", "numba", "scikit-learn", "xarray", "snakemake", "matplotlib", "typst")
_RESULTS = (
    "parity.json",
    "measured.nc",
    "forces.nc",
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
    decision : Decision
    parity : Parity
    frozen : dict
        From `freeze`.
    gain_caveats : list of str
    readings, misfit, evidence : xarray.Dataset
        From `measured_readings`, `misfit` and `deciding_features`.
    gain, consequences : xarray.Dataset or None
        From `campaign_gain`; None where the gain of no physical cause or described force was measured.
    size : CauseSize or None
        None where the effort has no further draws, or there is no physical cause.
    sensor_gain : xarray.Dataset or None
        From `sensor_gain`; None where a physical cause or a described force extends the model.
    horizon : dict of str to float
        By test: time for which it can be predicted [s]; empty where that was not measured.
    structure : str
        Its name.
    motions : dict of str to dict
        By name of a commanded motion: its provenance.
    places : dict of str to dict
        By key of a candidate: where in the structure it is.
    track_record : TrackRecord or None
        None while the procedure has none.
    digests, versions : dict of str to str
        Of the files that the report rests on, and of the software that made it.
    """

    campaign: Campaign
    effort: str
    synthetic: bool
    verdict: Verdict
    decision: Decision
    parity: Parity
    frozen: dict
    gain_caveats: list
    readings: xr.Dataset
    forces: xr.Dataset
    misfit: xr.Dataset
    evidence: xr.Dataset
    gain: xr.Dataset | None
    consequences: xr.Dataset | None
    size: CauseSize | None
    sensor_gain: xr.Dataset | None
    horizon: dict
    structure: str
    motions: dict
    places: dict
    track_record: TrackRecord | None
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
        """Name of a test's curves."""
        return "virtual test (synthetic)" if self.synthetic else "measured"

    @property
    def sensor_causes(self):
        """Causes of the verdict that the sensors' checks found."""
        return [name for name in self.verdict.causes if name not in self.decision.causes]

    @property
    def shown_candidates(self):
        """Keys of the candidates that the tests speak for: of the causes, or of the strongest effect."""
        found = [self.decision.places[name] for name in self.decision.causes]
        return found or [self.decision.candidates[0].key]


def load_diagnosed(campaign, results, effort, track_record, horizons=()):
    """Read a `Diagnosed` campaign from its results; no sealed test's file is opened.

    Parameters
    ----------
    campaign : str or path
        Its folder.
    results : str or path
        Folder with ``verdict.json`` and what it rests on.
    effort : str
    track_record : str or path
        The procedure's track record, or where it will be.
    horizons : sequence of str or path, optional
        Files of the tests' predictability, in the order of the readings.

    Raises
    ------
    InputError
        A file is missing or holds something else.
    """
    results, campaign, track_record = Path(results), load_campaign(campaign), Path(track_record)
    structure = load_structure(campaign.structure)
    readings = load_made(results / "measured.nc")
    names = [str(name) for name in readings["test"].values]
    files = [campaign.folder / "campaign.yaml"]
    files += [campaign.folder / campaign.tests[name].file for name in names]
    verdict = load_verdict(results / "verdict.json")
    decision = load_result(Decision, results / "decision.json")
    physical = bool(decision.causes)
    extended = physical or decision.described is not None
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
        parity=load_parity(results / "parity.json"),
        frozen=load_json(results / "frozen.json"),
        gain_caveats=load_result(MeasuredGain, results / "gain.json").caveats
        if measured
        else [caveat for caveat in verdict.caveats if "no gain was measured" in caveat],
        readings=readings,
        forces=load_made(results / "forces.nc"),
        misfit=load_made(results / "misfit.nc"),
        evidence=load_made(results / "evidence.nc"),
        gain=load_made(results / "gain.nc") if measured and extended else None,
        consequences=load_made(results / "consequences.nc") if measured and extended else None,
        size=load_result(CauseSize, results / _OF_SIZE) if sized else None,
        sensor_gain=load_made(results / "gain.nc") if measured and not extended else None,
        horizon={
            name: float(load_made(path)["horizon"].min()) for name, path in zip(names, horizons, strict=False)
        },
        structure=structure.file.name,
        motions=_motions(campaign),
        places={one.key: one.place for one in candidates(structure)},
        track_record=load_track_record(track_record) if track_record.exists() else None,
        digests={"/".join(path.parts[-2:]): file_digest(path) for path in files},
        versions=software_versions(_PACKAGES),
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
