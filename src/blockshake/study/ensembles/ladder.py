"""The paper's ladder of intensities: 50 %, then 25 % more until a potential collapse."""

from functools import partial
from pathlib import Path

import numpy as np

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.system import Status
from blockshake.files import content_digest
from blockshake.geometry.reference_block import half_width
from blockshake.geometry.structure import load_structure
from blockshake.simulation.simulate import simulate
from blockshake.simulation.structure_digest import structure_digest
from blockshake.store import kept_value


def climb(structure, motion_at, model, parameters, time_step, duration, ladder, store, source):
    """Simulate one structure at growing intensities, each from the restored stack.

    Parameters
    ----------
    structure : Structure
    motion_at : callable
        Gives the `GroundMotion` of a scale.
    model : str
    parameters : dict
        As of `simulate`.
    time_step, duration : float
        [s]
    ladder : Ladder
        First scale, increment, highest scale and the drift that counts as a potential collapse: that of `half_width`
        where it says none.
    store : str or path
        Folder of finished rungs: one that is there is not simulated again, and one that was cut short goes on from its
        checkpoint there.
    source : str
        Digest of the sources that compute.

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
    for scale in ladder.scales:
        outcome = _rung(
            structure, motion_at(float(scale)), model, parameters, time_step, duration, store, source
        )
        passed = outcome["status"] == Status.COMPLETED and outcome["peak"] <= largest_drift
        rungs.append({"scale": float(scale), **outcome, "passed": passed})
        if not passed:
            break
    return rungs


def _rung(structure, motion, model, parameters, time_step, duration, store, source):
    """How one run ended, and the largest drift in it [m]; from the store if it was simulated before."""
    key = content_digest(
        source, "rung", model, structure_digest(structure), *(part.tobytes() for part in motion.table),
        parameters, time_step, duration,
    )  # fmt: skip

    def simulated():
        run = simulate(
            structure, motion, model, parameters, time_step=time_step, duration=duration, accelerometers=False,
            checkpoint=Path(store) / f"{key}.checkpoint",
        )  # fmt: skip
        moved = run["position"].sel(axis="x") - run["position"].sel(axis="x").isel(time=0)
        drift = np.abs(moved - moved.isel(body=0)).max()
        return {"status": run.attrs["status"], "reason": run.attrs["reason"], "peak": float(drift)}

    return kept_value(store, key, simulated)


def climb_ladders(cases, motions, time_step, ladder, store, source, progress):
    """Climb the ladder of every case with every motion by LS-DEM, nominal parameters: rungs by structure and motion.

    ``cases``: ``structure`` and ``duration`` [s] of the configuration's; ``motions``: baselines by name or file;
    ``time_step`` [s]; ``store`` and ``source`` as of `climb`; ``progress`` is called with a line of text after each
    ladder. A structure of several cases is climbed with the longest duration of these.
    """
    durations = {}
    for case in cases:
        durations[case["structure"]] = max(case["duration"], durations.get(case["structure"], 0.0))
    found = {name: {} for name in durations}
    for name, duration in durations.items():
        structure = load_structure(name)
        for motion, baseline in motions.items():
            run = "ls-dem", {}, time_step, duration, ladder, store, source
            rungs = climb(structure, partial(load_motion, motion, baseline=baseline), *run)
            found[name][motion] = rungs
            passed = [rung["scale"] for rung in rungs if rung["passed"]]
            progress(f"{name} {motion}: passed {passed}")
    return found
