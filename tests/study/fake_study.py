"""A small study whose results are made up: right in form, never simulated."""

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from fake_inputs import calibrated, motion, waves

from blockshake.files import write_dataset, write_json, write_text
from blockshake.geometry.structure import load_structure
from blockshake.measurement.motion.joints import find_joints
from blockshake.measurement.sensors.markers import noisy_reading
from blockshake.statistics.intervals import SURE_FROM
from blockshake.study.comparison.comparison import compare_models
from blockshake.study.ensembles.case_input import measured_input
from blockshake.study.ensembles.coverage import coverage
from blockshake.study.ensembles.ensemble import as_sample, join_batches, run_alone, sample_figures
from blockshake.study.ensembles.envelope import envelope
from blockshake.study.ensembles.shown_samples import shown_samples
from blockshake.study.fragility.climb import gathered
from blockshake.study.fragility.fragility import fragility
from blockshake.study.sampling.distributions import TABLE_2
from blockshake.study.sampling.latin_hypercube import draw_samples
from blockshake.study.sensitivity.indices import indices_of_case
from blockshake.study.sensitivity.sensitivity import sensitivity

MODELS = {
    "ls-dem": {"time_step": 5e-5},
    "nscd-rigid": {"time_step": 1e-3},
    "nscd-elastic": {"time_step": 1e-3},
    "nscd-viscoelastic": {"time_step": 1e-3},
}
FEWER = {
    "configuration-1": {"nscd-elastic": 4, "nscd-viscoelastic": 4},
    "configuration-4": {"nscd-rigid": 6, "nscd-elastic": 1, "nscd-viscoelastic": 3},
}
COLLAPSE_REASON = "wall-b-4 tipped over or dropped by 1.000 s"
CPU_TIME = 43.21  # s, of every job
# of the first sample
STRENGTH = {"ls-dem": 0.8, "nscd-rigid": 0.82, "nscd-elastic": 0.6, "nscd-viscoelastic": 0.79}


def climbed_and_fitted():
    """Five samples that pass two, three or four of six levels, the last of them without an end."""
    scales = 0.5 + 0.25 * np.arange(6)
    climbs = []
    for stands in (2, 3, 3, 4, 3):
        levels = [
            {
                "scale": scale,
                "passed": place < stands,
                "status": "completed",
                "reason": "",
                "drift_ratio": 0.25 * scale,
            }
            for place, scale in enumerate(scales[: stands + 1])
        ]
        climbs.append(levels)
    climbs[-1][-1]["status"] = "not-converged"
    return fragility(
        gathered(np.arange(5), climbs, scales, xr.DataArray([np.nan, 0.4], {"body": ["slab", "block-1"]}))
    )


def ensemble_of(runs, design):
    """Ensemble of runs as the first samples of a design, by row."""
    rows = zip(runs, design.iterrows(), strict=False)
    return join_batches([as_sample(run_alone(run, "slab-face"), sample, row) for run, (sample, row) in rows])


class FakeStudy:
    """Writes the files of a study: configuration-1 complete, configuration-4 with fewer samples by rigid NSCD, two of
    which collapsed or failed; few by deformable NSCD, and one only by elastic NSCD of configuration-4."""

    def __init__(self, folder, size=10, duration=2.0, rate=50.0):
        self.folder, self.size = Path(folder), size
        self.results, self.logs = self.folder / "results", self.folder / "logs" / "fake"
        self.time = np.arange(round(duration * rate) + 1) / rate
        names = ("configuration-1", "configuration-4")
        self.study = {
            "name": "fake",
            "description": "made-up results\n",
            "author": "A. <Nobody>",
            "date": "2026-11-23",
            "models": MODELS,
            "cases": [
                {
                    "name": name,
                    "structure": name,
                    "motion": "basso-tirreno",
                    "scale": 2.0,
                    "baseline": "auto",
                    "duration": duration,
                    "samples": FEWER[name],
                    "measured": {"campaign": str(self.folder / "campaigns" / name), "test": "virtual"},
                    "input": "measured",
                }
                for name in names
            ],
            "ensemble": {
                "size": size,
                "seed": 77,
                "distributions": {name: one.model_dump() for name, one in TABLE_2.items()},
            },
            "output_rate": 200.0,
            "ladder": {
                "first": 0.5,
                "increment": 0.25,
                "largest_drift": 0.4,
            },
            "fragility": {"model": "nscd-rigid", "cases": ["configuration-1"], "size": 5},
            "calibration": {
                "cases": {"ls-dem": ["configuration-1"], "nscd-rigid": ["configuration-1"]},
                "size": 24,
            },
        }
        write_json(self.results / "calibration.json", calibrated(self.study))
        write_dataset(self.results / "fragility" / "configuration-1.nc", climbed_and_fitted())
        write_dataset(self.results / "motions" / "basso-tirreno.nc", motion("basso-tirreno", 0))
        self._write_design()
        for case in self.study["cases"]:
            self._write_case(case)

    def _write_design(self):
        design = draw_samples(self.size, 77, effort=1)
        self.design = design.values
        stiffness = pd.DataFrame(
            {
                "ls_dem.normal_stiffness": np.linspace(1.5e10, 2.2e10, self.size),
                "ls_dem.shear_stiffness": np.linspace(0.8e10, 1.1e10, self.size),
            }
        )
        write_text(self.results / "design.csv", self.design.to_csv(index=False))
        write_json(self.results / "design.json", design.summary())
        for case in self.study["cases"]:
            self.write_stiffness(case["name"], stiffness)

    def write_stiffness(self, case, stiffness):
        write_text(self.results / "stiffness" / f"{case}.csv", stiffness.to_csv(index=False))
        write_dataset(self.results / "waves" / f"{case}.nc", waves())

    def _write_case(self, case):
        name = case["structure"]
        structure = load_structure(name)
        folder = Path(case["measured"]["campaign"])
        test = self.run(structure, "ls-dem", 1.1)[["marker_displacement"]]
        test["marker_displacement"].values = noisy_reading(
            test["marker_displacement"].to_numpy(), 1e-4, np.random.default_rng(3)
        )
        test.attrs = {"synthetic": 1}
        write_dataset(folder / "virtual.nc", test)
        write_text(
            folder / "campaign.yaml",
            f"name: fake\nstructure: {name}\n"
            "tests:\n  - {name: virtual, file: virtual.nc, motion: basso-tirreno, scale: 2.0, role: fit}\n",
        )
        write_dataset(self.results / "inputs" / f"{name}.nc", measured_input(case, case["measured"]))
        ensembles, replicates = {}, {}
        for model in MODELS:
            count = case["samples"].get(model, self.size)
            runs = [
                self.run(structure, model, STRENGTH[model] + 0.4 * sample / count) for sample in range(count)
            ]
            if count == 6:
                end(runs[2], "collapsed", COLLAPSE_REASON, 1.0)
                end(runs[4], "not-converged", "2.0 % of the steps ended above a residual", self.time[-1])
            ensemble = ensembles[model] = ensemble_of(runs, self.design)
            if count >= SURE_FROM:
                replicate = self.run(structure, model, 1.05 * STRENGTH[model])
                replicates[model] = ensemble_of([replicate], self.design)
            for kind, result in (
                ("envelopes", envelope(ensemble, 0.4)),
                ("samples", sample_figures(ensemble)),
                ("shown", shown_samples(ensemble)),
                ("comparisons", coverage(test, ensemble, 1e-4)),
                ("sensitivities", sensitivity(ensemble, self.design)),
            ):
                write_dataset(self.results / kind / model / f"{name}.nc", result)
            made = [
                self.results / kind / model / f"{name}.nc" for kind in ("samples", "sensitivities", "indices")
            ]
            write_dataset(made[2], indices_of_case(*made[:2], None, 77, {}))
            log = self.logs / "simulate_batch" / model / name / f"000-{count - 1:03d}.log"
            write_text(log, f"Took 50.0 s, {CPU_TIME} CPU s.\n")

        differences = compare_models(ensembles, replicates, (test, 1e-4))
        write_dataset(self.results / "differences" / f"{name}.nc", differences)

    def run(self, structure, model, strength):
        """A run whose blocks sway the more the higher they stand; peaks are ``strength`` times the height in cm."""
        bodies = structure.body_names
        height = dict(zip(bodies, np.maximum(structure.position[:, 2], 0.0), strict=True))
        sway = 0.01 * strength * np.sin(2.0 * np.pi * self.time) * np.minimum(self.time, 1.0)
        slab = 0.02 * np.sin(3.0 * self.time)
        markers = structure.file.markers
        displacement = np.zeros((len(self.time), len(markers), 3))
        for place, marker in enumerate(markers):
            displacement[:, place, 0] = slab + height[marker.body] * sway
        still = np.zeros((len(self.time), len(bodies), 4))
        still[..., 0] = 1.0
        joints = find_joints(structure)[0]
        return xr.Dataset(
            {
                "marker_displacement": (("time", "marker", "axis"), displacement, {"units": "m"}),
                "position": (("time", "body", "axis"), np.zeros((len(self.time), len(bodies), 3))),
                "orientation": (("time", "body", "quaternion"), still),
                "joint_compression": (
                    "joint",
                    1e5 * strength * np.arange(len(joints), 0, -1),
                    {"units": "N"},
                ),
                "joint_uplift": ("joint", 1e-3 * strength * np.arange(1, len(joints) + 1), {"units": "m"}),
                "joint_slip": ("joint", 2e-4 * strength * np.arange(len(joints), 0, -1), {"units": "m"}),
                "joint_margin": (
                    "joint",
                    1.0 - 0.5 * strength / np.arange(1, len(joints) + 1),
                    {"units": "1"},
                ),
                "joint_spin_kept": ("joint", np.full(len(joints), 0.9 - 0.2 * strength), {"units": "1"}),
                "blows": ((), 0.0, {"units": "1"}),
                "blow_velocity": ((), 0.0, {"units": "m s-1"}),
                "blow_pair": ((), ""),
            },
            coords={
                "time": self.time,
                "joint": [f"{bodies[lower]}-{bodies[upper]}" for lower, upper in joints],
                "marker": [marker.name for marker in markers],
                "marker_body": ("marker", [marker.body for marker in markers]),
                "body": bodies,
                "axis": ["x", "y", "z"],
                "quaternion": ["w", "x", "y", "z"],
            },
            attrs={
                "model": model,
                "structure": structure.file.name,
                "motion": "basso-tirreno",
                "status": "completed",
                "reason": "",
                "end_time": float(self.time[-1]),
                "energy_residual": 1.25e-4 * strength,
                "numerics_steps": 2000,
                "blockshake_version": "0.0.7",
                "source_digest": "0123456789ab",
                **(
                    {"numerics_capped_steps": 17, "numerics_max_residual": 3.5e-6}
                    if model != "ls-dem"
                    else {}
                ),
            },
        )


def end(run, status, reason, time):
    """Let a run end at a time."""
    after = run["time"].to_numpy() > time
    run["marker_displacement"][after] = np.nan
    run.attrs |= {"status": status, "reason": reason, "end_time": float(time)}
