"""Samples of a case that climb the ladder of intensities, each until its potential collapse."""

import time
from dataclasses import dataclass

import numpy as np
import xarray as xr

from blockshake.dynamics.load_motion import scaled
from blockshake.dynamics.motion import GroundMotion
from blockshake.dynamics.system import FINISHED, Status
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import Structure, load_structure
from blockshake.simulation.run_histories import drift_histories, run_histories
from blockshake.simulation.simulate import simulate
from blockshake.store import Unit
from blockshake.study.ensembles.batch import FRAGILITY, part_name
from blockshake.study.ensembles.case_input import COMMANDED, driving_motions
from blockshake.study.ensembles.drift_limits import OF_JOINT, drift_limits, slip_limits
from blockshake.study.ensembles.ensemble import describe

_DESCRIBED = {
    "scale": ("factor of the motion", "1"),
    "drift_ratio": (
        "largest displacement along x of a mass centre relative to the slab, or slip of a joint, over its "
        "largest_drift",
        "1",
    ),
    "largest_drift": (
        "displacement of a block, or slip of a joint, that counts as a potential collapse",
        "m",
    ),
    "passed": ("1 where the stack stood, 0 where it did not, NaN where nobody climbed", "1"),
    "capacity_lower": ("last scale that the sample passed, 0 for none", "1"),
    "capacity_upper": ("first scale that it did not pass, infinity for none", "1"),
}


def climb_samples(runs, rows, ladder, store, seed=0):
    """Levels that each sample of a case passes, from the restored stack each time.

    Parameters
    ----------
    runs : CaseRuns
        With ``motion``, ``baseline`` and ``intensity`` of the case.
    rows : pandas.DataFrame
        Sampled values, index the sample, contact stiffness included.
    ladder : Ladder
    store : Store
    seed : int
        Seed of the design, by which samples draw records.

    Returns
    -------
    xarray.Dataset
        ``drift_ratio`` and ``passed(sample, scale)``; ``capacity_lower`` and ``capacity_upper(sample)``, of
        the motion's factor [1]; ``status`` and ``reason(sample)`` of the last run; ``largest_drift(body)`` of
        `drift_limits`, and of `slip_limits` under names such as ``low/high`` [m].

    Notes
    -----
    The motion is the commanded one: no test was measured at every level. A run that ends for a numerical reason tells
    nothing of its level, so that its sample is only known to pass the levels before. A stack may stand a level above
    one that it did not pass; its capacity is the first that it did not.
    """
    structure = load_structure(runs.case["structure"])
    motions = driving_motions(runs.case | {"scale": 1.0, "input": COMMANDED}, None, seed)
    climbs, name = [], part_name(FRAGILITY, runs.case.get("name", structure.file.name), runs.model)
    for sample, row in rows.iterrows():
        begin = time.monotonic()
        levels = climb(structure, runs, motions(sample, row), runs.parameters(row, structure), ladder, store)
        climbs.append(levels)
        store.say(f"{name}: sample {sample}, {_words(levels)}; took {time.monotonic() - begin:.3g} s")
    joints, limits = _limits(structure, ladder)
    names = [*structure.body_names, *map(OF_JOINT.join, joints)]
    return gathered(
        rows.index.to_numpy(), climbs, ladder.scales, xr.DataArray(limits, {"body": names}, ["body"])
    )


def climb(structure, runs, motion, parameters, ladder, store):
    """Simulate one structure at growing intensities, each from the restored stack.

    Parameters
    ----------
    structure : Structure
    runs : CaseRuns
        With the duration of the case.
    motion : GroundMotion
        The factor 1.
    parameters : dict
        Parameters of the run by dotted name, as `simulate` takes them.
    ladder : Ladder
        First scale, increment, highest scale and what counts as a potential collapse, of `drift_limits` and
        `slip_limits`.
    store : Store

    Returns
    -------
    list of dict
        By level: ``scale``, ``status``, ``reason`` and ``drift_ratio``, the largest displacement along x of a block
        against the slab, or slip of a joint, over its limit [1]; and ``passed``. The last level is the first that did
        not pass: it did not complete, or a displacement or slip exceeded its limit.

    Notes
    -----
    Zhou et al. (2023), section Case Study: first test at 50 %, increments of about 25 %.
    """
    levels, (joints, limits) = [], _limits(structure, ladder)
    for scale in ladder.scales.tolist():
        driven_by = scaled(motion, scale, motion.name)
        step, duration = runs.settings["time_step"], runs.case["duration"]
        outcome = store.value(_Level(structure, driven_by, runs.model, parameters, step, duration, joints))
        ratio = float(np.nanmax(outcome.pop("moved") / limits))
        passed = outcome["status"] == Status.COMPLETED and ratio <= 1.0
        levels.append({"scale": scale, **outcome, "drift_ratio": ratio, "passed": passed})
        if not passed:
            break
    return levels


def _limits(structure, ladder):
    """Joints that have a limit, as pairs of names, and the limits of all bodies and of these joints [m]."""
    slips = slip_limits(structure, ladder.largest_drift)
    return tuple(slips), np.array([*drift_limits(structure, ladder.largest_drift), *slips.values()])


@dataclass(frozen=True)
class _Level(Unit):
    """How one run ended, the largest drift of each body along x and the largest slip of some joints in it [m]."""

    structure: Structure
    motion: GroundMotion
    model: str
    parameters: dict
    time_step: float  # [s]
    duration: float  # [s]
    joints: tuple  # of pairs of names

    def made(self, checkpoint):
        run = simulate(
            self.structure, self.motion, self.model, self.parameters, time_step=self.time_step,
            duration=self.duration, accelerometers=False, checkpoint=checkpoint,
        )  # fmt: skip
        turns = rotation_matrices(run["orientation"].to_numpy())
        moved = drift_histories(self.structure, run["position"].to_numpy(), turns)[..., 0]
        largest = np.nanmax(np.abs(moved), axis=0).tolist() + self._slips(run)
        return {"status": run.attrs["status"], "reason": run.attrs["reason"], "moved": largest}

    def _slips(self, run):
        if not self.joints:
            return []
        slip = run_histories(run, self.structure)["slip"].max("time")
        pairs = zip(slip["lower"].values, slip["upper"].values, slip.to_numpy(), strict=True)
        found = {frozenset((lower, upper)): float(value) for lower, upper, value in pairs}
        return [found[frozenset(pair)] for pair in self.joints]


def _words(levels):
    last = levels[-1]
    return f"{'passed' if last['passed'] else 'did not pass'} {last['scale']:g}, {last['status']}"


def gathered(samples, climbs, scales, largest_drift):
    """Dataset of `climb_samples` from the levels of each sample that `climb` returns."""
    ratio, passed = np.full((2, len(samples), len(scales)), np.nan)
    bounds = np.zeros((len(samples), 2))
    for row, levels in enumerate(climbs):
        known = [level for level in levels if level["status"] in FINISHED]
        stood = [level["scale"] for level in known if level["passed"]]
        fell = [level["scale"] for level in known if not level["passed"]]
        bounds[row] = max(stood, default=0.0), min(fell, default=np.inf)
        ratio[row, : len(known)] = [level["drift_ratio"] for level in known]
        passed[row, : len(known)] = [level["passed"] for level in known]
    result = xr.Dataset(
        {
            "drift_ratio": (("sample", "scale"), ratio),
            "passed": (("sample", "scale"), passed),
            "capacity_lower": ("sample", bounds[:, 0]),
            "capacity_upper": ("sample", bounds[:, 1]),
            "largest_drift": largest_drift,
            "status": ("sample", [str(levels[-1]["status"]) for levels in climbs]),
            "reason": ("sample", [str(levels[-1]["reason"]) for levels in climbs]),
        },
        coords={"sample": samples.astype(np.int64), "scale": scales},
    )
    describe(result, _DESCRIBED)
    result["body"].attrs = {"long_name": "name of the body or joint"}
    result["status"].attrs = {"long_name": "how the last run of the sample ended"}
    result["reason"].attrs = {"long_name": "why it ended so"}
    result.attrs = {"title": "levels of intensity that samples pass"}
    return result
