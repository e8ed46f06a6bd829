"""A campaign with its diagnosis whose results are made up: right in form, never simulated."""

from pathlib import Path

import numpy as np
import xarray as xr
from fake_findings import OPEN, SEALED, departures, gain, made_up_decision, misfit, parity, responses

from blockshake.diagnosis.answer.decision import write_decision
from blockshake.diagnosis.verdict.conclusion import conclude
from blockshake.diagnosis.verdict.verdict import MeasuredGain, write_verdict
from blockshake.files import write_dataset, write_json, write_text
from blockshake.geometry.structure import load_structure

STRUCTURE = "configuration-1"
SIMULATED = "named"  # the fake with a misfit, a gain on the responses, and a track record
_TIME = np.arange(151) / 25.0


class FakeDiagnosis:
    """Writes a campaign of virtual tests and the results of its diagnosis.

    ``findings`` are sensor faults; ``simulated`` is whether there are a misfit and a gain on the responses.
    """

    def __init__(self, folder, kind, findings=(), simulated=False):
        self.folder = Path(folder)
        self.campaign, self.results = self.folder / "campaign", self.folder / "results"
        self.track_record = self.folder / "hidden-effects.json"
        self.effort = "standard" if simulated else "quick"
        self.structure = load_structure(STRUCTURE)
        self._write_campaign()
        blocks = [body.name for body in self.structure.file.bodies if not body.driven]
        joints = [f"{lower}-{upper}" for lower, upper in zip(["slab", *blocks], blocks, strict=False)]
        decision = made_up_decision(kind)
        write_decision(self.results / "decision.json", decision)
        write_dataset(self.results / "evidence.nc", departures(kind, blocks))
        write_json(self.results / "parity.json", parity(self.structure, findings).as_json())
        measured = MeasuredGain(rows=gain() if decision.parts else None)
        if simulated:
            write_dataset(self.results / "misfit.nc", misfit(joints, blocks[-1]))
            write_dataset(self.results / "gain.nc", responses(joints, blocks[-1]))
            measured = measured.model_copy(update={"gain": gain(0.6), "runs": 120})
        write_verdict(self.results / "verdict.json", conclude(decision, findings, {}, (), measured))

    def arguments(self):
        """Content that the report is made from."""
        return self.campaign, self.results, self.effort, self.track_record

    def _write_campaign(self):
        lines = [f"name: made-up\nstructure: {STRUCTURE}\ntests:"]
        markers = [marker.name for marker in self.structure.file.markers]
        displacement = np.zeros((len(_TIME), len(markers), 3))
        displacement[..., 0] = 0.02 * np.sin(3.0 * _TIME)[:, None]
        readings = {"marker_displacement": (("time", "marker", "axis"), displacement, {"units": "m"})}
        coords = {"time": _TIME, "marker": markers, "axis": ["x", "y", "z"]}
        for name in OPEN + SEALED:
            role = "sealed" if name in SEALED else "fit"
            lines.append(f"  - {{name: {name}, file: {name}.nc, motion: alkion, scale: 1.0, role: {role}}}")
            if role == "fit":
                write_dataset(self.campaign / f"{name}.nc", xr.Dataset(readings, coords, {"synthetic": 1}))
            else:
                write_text(self.campaign / f"{name}.nc", "nobody may open this\n")
        write_text(self.campaign / "campaign.yaml", "\n".join(lines) + "\n")
