"""A campaign with its diagnosis whose results are made up: right in form, never simulated."""

from pathlib import Path

import numpy as np
import xarray as xr
from fake_findings import (
    DRAWS,
    MODELS,
    OPEN,
    SEALED,
    evidence,
    informed,
    made_up_decision,
    made_up_forces,
    parity,
    sealed_tests,
)

from blockshake.diagnosis.features.reading import HISTORIES
from blockshake.diagnosis.gain.consequence import consequence
from blockshake.diagnosis.gain.gain import gain_of_verdict, gain_on
from blockshake.diagnosis.gain.law_gain import law_contrast
from blockshake.diagnosis.inference.decision import CauseSize, write_result
from blockshake.diagnosis.laws.findings import LawFindings
from blockshake.diagnosis.misfit.misfit import misfit, where
from blockshake.diagnosis.verdict.conclusion import Judged, conclude
from blockshake.diagnosis.verdict.frozen import freeze
from blockshake.diagnosis.verdict.verdict import MeasuredGain, Verdict, write_verdict
from blockshake.files import write_dataset, write_json, write_text
from blockshake.geometry.structure import load_structure

STRUCTURE = "configuration-1"
_TIME = np.arange(151) / 25.0
_PEAKS = ("top.displacement.peak+", "top.displacement.peak-")


def gain_on_laws():
    """A law that one sealed test breaks before the extension and keeps after it, as from `law_gain`."""
    kinds = ["nominal", "recalibrated", "extended"]
    return xr.Dataset(
        {
            "law_distance": (("law_kind", "law_cell"), [[-9.1], [-8.7], [0.6]]),
            "law_gain": ("law_rival", [0.99, 0.98]),
            "law_gain_lower": ("law_rival", [0.9, 0.88]),
            "law_gain_upper": ("law_rival", [1.0, 1.0]),
        },
        {
            "law_kind": kinds,
            "law_rival": kinds[:2],
            "cell_test": ("law_cell", ["sealed-1"]),
            "cell_law": ("law_cell", ["table.pitch"]),
        },
    )


class FakeDiagnosis:
    """Writes a campaign of virtual tests and the results of its diagnosis.

    ``extended`` is whether the sealed tests were opened; ``findings`` are sensor faults; ``gaining`` whether the
    extended model scores better than its rivals; ``force`` from outside that an unknown cause is described by.
    """

    def __init__(
        self, folder, decision, extended=True, findings=(), effort="standard", gaining=True, force=None
    ):
        self.folder, self.effort = Path(folder), effort
        self.campaign, self.results = self.folder / "campaign", self.folder / "results"
        self.track_record = self.folder / "hidden-effects.json"
        self.structure = load_structure(STRUCTURE)
        self.tests = {name: 0.5 + 0.5 * place for place, name in enumerate(OPEN + SEALED)}
        self._write_campaign()
        readings = xr.concat(
            [self.reading(strength, shift=0.35) for name, strength in self.tests.items() if name in OPEN], dim="test"
        ).assign_coords(test=list(OPEN))  # fmt: skip
        write_dataset(self.results / "measured.nc", readings)
        blocks = [body.name for body in self.structure.file.bodies if not body.driven]
        write_dataset(self.results / "forces.nc", made_up_forces(OPEN, blocks))
        ensembles = {
            name: [self.members(self.tests[name], 1.0, model)[list(HISTORIES)] for model in MODELS] for name in OPEN
        }  # fmt: skip
        found = misfit(readings, ensembles)
        write_dataset(self.results / "misfit.nc", found)
        write_json(self.results / "parity.json", parity(self.structure, findings).as_json())
        self.decision = made_up_decision(decision, self.structure)
        if force:
            laws = LawFindings(laws=(), isolated=(), outside=force, shares={}, p=1e-6)
            self.decision = self.decision.model_copy(update={"laws": laws})
        write_result(self.results / "decision.json", self.decision)
        freeze(self.results / "frozen.json", self.results / "decision.json", OPEN)
        best = self.decision.candidates[0]
        if self.decision.causes:
            size = CauseSize(
                key=self.decision.first_key, sizes=(), posterior=(), error=0.3, draws=18, parameters={}
            )
            write_result(self.results / "size.json", size)
        write_dataset(self.results / "evidence.nc", evidence(best, readings))
        gained = bool(self.decision.causes or self.decision.described) and extended
        caveats = [] if extended else ["no gain was measured: there is no sealed test"]
        summary = MeasuredGain(gain=None, caveats=caveats, runs=1260)
        gain = consequences = xr.Dataset()
        if gained:
            gain, laws = gain_on(sealed_tests(0.9 if gaining else 0.0)), gain_on_laws()
            summary = gain_of_verdict(gain, 1260).model_copy(update={"laws": law_contrast(laws)})
            gain = gain.merge(laws).merge(informed())
            consequences = self._consequences()
        write_dataset(self.results / "gain.nc", gain)
        write_dataset(self.results / "consequences.nc", consequences)
        write_result(self.results / "gain.json", summary)
        self.verdict = conclude(
            self.decision, findings, {}, Judged(where(found), len(OPEN)), 1260, summary.caveats, effort,
            measured=summary, scores=gain,
        )  # fmt: skip
        assert isinstance(self.verdict, Verdict)
        write_verdict(self.results / "verdict.json", self.verdict)

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
        for name in self.tests:
            role = "sealed" if name in SEALED else "fit"
            lines.append(f"  - {{name: {name}, file: {name}.nc, motion: alkion, scale: 1.0, role: {role}}}")
            if role == "fit":
                write_dataset(self.campaign / f"{name}.nc", xr.Dataset(readings, coords, {"synthetic": 1}))
            else:
                write_text(self.campaign / f"{name}.nc", "nobody may open this\n")
        write_text(self.campaign / "campaign.yaml", "\n".join(lines) + "\n")

    def reading(self, strength, shift=0.0, seed=0):
        """Readings of a test: joints and blocks that sway, the more the higher; ``shift`` adds to one side."""
        generator = np.random.default_rng([seed, round(1e6 * strength)])
        joints = [f"{lower}-{upper}" for lower, upper in self.pairs]
        envelope = np.minimum(_TIME / 2.0, 1.0) * np.exp(-np.maximum(_TIME - 4.0, 0.0))
        sway = strength * envelope * (np.sin(8.0 * _TIME) + shift * np.maximum(np.sin(8.0 * _TIME), 0.0))
        shape = (len(_TIME), len(joints))
        share = np.arange(1, len(joints) + 1) / len(joints)
        bodies = list(self.structure.body_names)
        drift = 0.05 * sway[:, None] * np.arange(len(bodies)) / (len(bodies) - 1)
        curves = {
            "slip": 3e-3 * sway[:, None] * share + 1e-4 * generator.normal(size=shape),
            "rotation": 8e-3 * sway[:, None] * share + 1e-4 * generator.normal(size=shape),
            "opening": 2e-3 * np.abs(sway)[:, None] * share + 1e-4 * generator.normal(size=shape),
        }
        phase = np.where(_TIME < 0.5, 0, np.where(_TIME < 4.5, 1, 2)).astype(np.int8)
        return xr.Dataset(
            {
                **{name: (("time", "joint"), values.astype(np.float32)) for name, values in curves.items()},
                "drift": (("time", "body"), drift.astype(np.float32)),
                "acceleration": ("time", (strength * envelope * np.cos(8.0 * _TIME)).astype(np.float32)),
                "phase": ("time", phase),
                "value": ("feature", np.array([drift.max(), drift.min()])),
                "censored": ("feature", np.zeros(2, dtype=bool)),
            },
            {
                "time": _TIME, "joint": joints, "body": bodies, "feature": list(_PEAKS),
                "unit": ("feature", ["m", "m"]), "height": ("body", self.structure.position[:, 2]),
            },
        )  # fmt: skip

    @property
    def pairs(self):
        """Bodies of each joint, the lower first."""
        return list(zip(self.structure.body_names[:-1], self.structure.body_names[1:], strict=True))

    def members(self, strength, factor, model):
        """Readings of a solver's members, which scatter by 15 %."""
        spread = 1.0 + 0.15 * np.random.default_rng(list(model.encode())).normal(size=DRAWS)
        runs = [self.reading(strength * factor * one, seed=number) for number, one in enumerate(spread)]
        return xr.concat(
            [run.drop_vars(["phase", "acceleration"]) for run in runs], dim="draw", data_vars="all", coords="minimal"
        ).assign_coords(draw=np.arange(DRAWS))  # fmt: skip

    def _consequences(self):
        parts = []
        factors = {"nominal": 0.9, "recalibrated": 1.0, "extended": 1.3}
        for name in SEALED:
            measured = self.reading(self.tests[name], shift=0.35)
            runs = {
                kind: {model: self.members(self.tests[name], factor, model) for model in MODELS}
                for kind, factor in factors.items()
            }
            history = [
                xr.concat([one["drift"] for one in own.values()], dim="draw").quantile(
                    (0.05, 0.5, 0.95), dim="draw"
                )
                for own in runs.values()
            ]
            part = consequence(measured, {
                kind: {model: one.rename(draw="run") for model, one in own.items()} for kind, own in runs.items()
            })  # fmt: skip
            parts.append(
                part.assign(
                    drift_history=xr.concat(history, dim="kind").assign_coords(kind=list(factors)),
                    drift_measured=measured["drift"],
                )
            )
        return xr.concat(parts, dim="test", join="outer").assign_coords(test=list(SEALED))
