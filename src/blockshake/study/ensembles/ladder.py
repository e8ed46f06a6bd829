"""The paper's ladder of intensities: 50 %, then 25 % more until a potential collapse."""

import numpy as np

from blockshake.dynamics.load_motion import load_motion, scaled
from blockshake.dynamics.system import Status
from blockshake.geometry.reference_block import half_width
from blockshake.geometry.structure import load_structure
from blockshake.simulation.simulate import simulate
from blockshake.store import structure_digest
from blockshake.study.ensembles.batch import CaseRuns


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


def climb_ladders(cases, motions, time_step, ladder, store):
    """Climb the ladder of every case with every motion by LS-DEM, nominal parameters: rungs by structure and motion.

    ``cases``: ``structure`` and ``duration`` [s] of the configuration's; ``motions``: baselines by name or file;
    ``time_step`` [s]; ``store``: `Store` of the runs, which says a line after each ladder. A structure of several cases
    is climbed with the longest duration of these.
    """
    durations = {}
    for case in cases:
        durations[case["structure"]] = max(case["duration"], durations.get(case["structure"], 0.0))
    climbed = {name: {} for name in durations}
    for name, duration in durations.items():
        structure = load_structure(name)
        for motion, baseline in motions.items():
            runs = CaseRuns({"duration": duration}, "ls-dem", {"time_step": time_step}, {})
            rungs = climb(structure, runs, load_motion(motion, baseline=baseline), {}, ladder, store)
            climbed[name][motion] = rungs
            passed = [rung["scale"] for rung in rungs if rung["passed"]]
            store.say(f"{name} {motion}: passed {passed}")
    return climbed
