"""Content of the report of a diagnosis, read from the results of the campaign into one structure."""

from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.answer.decision import Decision, load_decision
from blockshake.diagnosis.verdict.track_record import TrackRecord, load_track_record
from blockshake.diagnosis.verdict.verdict import Verdict, load_verdict
from blockshake.files import file_digest
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Campaign, load_campaign, load_test
from blockshake.measurement.campaigns.commanded_motion import commanded_motion
from blockshake.pages.origin import software_versions
from blockshake.parity.parity import Parity, load_parity
from blockshake.store import load_made

_RESULTS = ("parity.json", "decision.json", "evidence.nc", "verdict.json")
_GAIN, _MISFIT = "gain.nc", "misfit.nc"


@dataclass(frozen=True)
class Diagnosed:
    """A campaign's diagnosis."""

    campaign: Campaign
    effort: str
    synthetic: bool  # any test that was judged by is a virtual one
    verdict: Verdict
    decision: Decision
    parity: Parity
    departures: xr.Dataset  # xarray.Dataset; from `departures`
    # of the responses or of a sensor, from the step that measures the skill score; None where none was measured
    gain: xr.Dataset | None
    misfit: xr.Dataset | None  # from `misfit`; None where nothing was simulated
    structure: str  # its name
    bodies: tuple
    motions: dict  # str to dict; by name of a commanded motion that is at hand: its provenance
    track_record: TrackRecord | None  # None while the procedure has none
    # digests, versions: str to str; of the files that the report rests on, and of the software that made it
    digests: dict
    versions: dict

    @property
    def measured_word(self):
        """Name of a test's curves."""
        return "virtual test (synthetic)" if self.synthetic else "measured"


def load_diagnosed(campaign, results, effort, track_record):
    """Read a `Diagnosed` campaign from its results; no sealed test's file is opened.

    Arguments and errors are those of `make_diagnosis_report`.
    """
    results, campaign, track_record = Path(results), load_campaign(campaign), Path(track_record)
    verdict = load_verdict(results / "verdict.json")
    decision = load_decision(results / "decision.json")
    structure = load_structure(campaign.structure)
    files = [campaign.folder / "campaign.yaml"]
    files += [campaign.folder / campaign.tests[name].file for name in decision.tests]
    files += [results / name for name in _RESULTS]
    gain = results / _GAIN if verdict.gain else None  # an earlier file may still lie there
    misfit = results / _MISFIT if effort != "quick" and (results / _MISFIT).exists() else None
    files += [path for path in (gain, misfit) if path]
    tests = {test.motion: test for test in campaign.tests.values()}
    motions = {name: commanded_motion(campaign, test) for name, test in tests.items()}
    return Diagnosed(
        campaign=campaign,
        effort=effort,
        synthetic=any(_synthetic(load_test(campaign, name).attrs) for name in decision.tests),
        verdict=verdict,
        decision=decision,
        parity=load_parity(results / "parity.json"),
        departures=load_made(results / "evidence.nc"),
        gain=load_made(gain) if gain else None,
        misfit=load_made(misfit) if misfit else None,
        structure=structure.file.name,
        bodies=tuple(structure.body_names),
        motions={name: one.attributes for name, one in motions.items() if one is not None},
        track_record=load_track_record(track_record) if track_record.exists() else None,
        digests={"/".join(path.parts[-2:]): file_digest(path) for path in files},
        versions=software_versions(),
    )


def _synthetic(attributes):
    """Whether a test file states of itself that it is synthetic: by this program's mark, its title or its source."""
    words = f"{attributes.get('title', '')} {attributes.get('source', '')}".lower()
    return bool(attributes.get("synthetic", 0)) or "synthetic" in words
