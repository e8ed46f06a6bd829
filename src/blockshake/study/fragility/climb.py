"""Samples of a case that climb the ladder of intensities, each until its potential collapse."""

import numpy as np
import xarray as xr

from blockshake.dynamics.load_motion import scaled
from blockshake.dynamics.system import FINISHED, Status
from blockshake.geometry.reference_block import half_width
from blockshake.geometry.structure import load_structure
from blockshake.simulation.simulate import simulate
from blockshake.store import structure_digest
from blockshake.study.ensembles.case_input import COMMANDED, driving_motions
from blockshake.study.ensembles.ensemble import describe

_DESCRIBED = {
    "scale": ("factor of the motion", "1"),
    "peak": ("largest displacement of the mass centre of a block relative to the slab along x", "m"),
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
        Of the design, by which samples draw records.

    Returns
    -------
    xarray.Dataset
        ``peak(sample, scale)`` [m] and ``passed(sample, scale)``; ``capacity_lower`` and ``capacity_upper(sample)``, of
        the motion's factor [1]; ``status`` and ``reason(sample)`` of the last run. Attribute ``largest_drift`` [m].

    Notes
    -----
    The motion is the commanded one: no test was measured at every level. A run that ends for a numerical reason tells
    nothing of its level, so that its sample is only known to pass the levels before. A stack may stand a level above
    one that it did not pass; its capacity is the first that it did not.
    """
    structure = load_structure(runs.case["structure"])
    motions = driving_motions(runs.case | {"scale": 1.0, "input": COMMANDED}, None, seed)
    climbs = []
    for sample, row in rows.iterrows():
        rungs = climb(structure, runs, motions(sample, row), runs.parameters(row, structure), ladder, store)
        climbs.append(rungs)
        store.say(f"{structure.file.name} {runs.model} sample {sample}: {_words(rungs)}")
    return gathered(
        rows.index.to_numpy(), climbs, ladder.scales, ladder.largest_drift or half_width(structure)
    )


def climb(structure, runs, motion, parameters, ladder, store):
    """Simulate one structure at growing intensities, each from the restored stack.

    Parameters
    ----------
    structure : Structure
    runs : CaseRuns
        With the duration of the case.
    motion : GroundMotion
        Of the factor 1.
    parameters : dict
        Parameters of the run by dotted name, as `simulate` takes them.
    ladder : Ladder
        First scale, increment, highest scale and the drift that counts as a potential collapse: that of `half_width`
        where it says none.
    store : Store

    Returns
    -------
    list of dict
        By rung: ``scale``, ``status``, ``reason`` and ``peak``, the largest displacement of any
        block relative to the slab along x [m]; and ``passed``. The last rung is the first that did not
        pass: it did not complete, or a block's drift exceeded ``largest_drift``.

    Notes
    -----
    Zhou et al. (2023), section Case Study: first test at 50 %, increments of about 25 %.
    """
    rungs, largest_drift = [], ladder.largest_drift or half_width(structure)
    for scale in ladder.scales.tolist():
        outcome = _rung(structure, runs, scaled(motion, scale, motion.name), parameters, store)
        passed = outcome["status"] == Status.COMPLETED and outcome["peak"] <= largest_drift
        rungs.append({"scale": scale, **outcome, "passed": passed})
        if not passed:
            break
    return rungs


def _rung(structure, runs, motion, parameters, store):
    """How one run ended, and the largest drift in it [m]."""
    time_step, duration = runs.settings["time_step"], runs.case["duration"]

    def simulated(checkpoint):
        run = simulate(
            structure, motion, runs.model, parameters, time_step=time_step, duration=duration, accelerometers=False,
            checkpoint=checkpoint,
        )  # fmt: skip
        moved = run["position"].sel(axis="x") - run["position"].sel(axis="x").isel(time=0)
        drift = np.abs(moved - moved.isel(body=0)).max()
        return {"status": run.attrs["status"], "reason": run.attrs["reason"], "peak": float(drift)}

    given = "rung", runs.model, structure_digest(structure), *motion.table, parameters, time_step, duration
    return store.value(given, simulated)


def _words(rungs):
    last = rungs[-1]
    return f"{'passed' if last['passed'] else 'did not pass'} {last['scale']:g}, {last['status']}"


def gathered(samples, climbs, scales, largest_drift):
    """Dataset of `climb_samples` from the rungs of each sample that `climb` returns."""
    peak, passed = np.full((2, len(samples), len(scales)), np.nan)
    bounds = np.zeros((len(samples), 2))
    for row, rungs in enumerate(climbs):
        known = [rung for rung in rungs if rung["status"] in FINISHED]
        stood = [rung["scale"] for rung in known if rung["passed"]]
        fell = [rung["scale"] for rung in known if not rung["passed"]]
        bounds[row] = max(stood, default=0.0), min(fell, default=np.inf)
        peak[row, : len(known)] = [rung["peak"] for rung in known]
        passed[row, : len(known)] = [rung["passed"] for rung in known]
    result = xr.Dataset(
        {
            "peak": (("sample", "scale"), peak),
            "passed": (("sample", "scale"), passed),
            "capacity_lower": ("sample", bounds[:, 0]),
            "capacity_upper": ("sample", bounds[:, 1]),
            "status": ("sample", [str(rungs[-1]["status"]) for rungs in climbs]),
            "reason": ("sample", [str(rungs[-1]["reason"]) for rungs in climbs]),
        },
        coords={"sample": samples.astype(np.int64), "scale": scales},
    )
    describe(result, _DESCRIBED)
    result["status"].attrs = {"long_name": "how the last run of the sample ended"}
    result["reason"].attrs = {"long_name": "why it ended so"}
    result.attrs = {"title": "levels of intensity that samples pass", "largest_drift": float(largest_drift)}
    return result
