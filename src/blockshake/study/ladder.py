"""The paper's ladder of intensities: 50 %, then 25 % more until a potential collapse."""

import numpy as np

from blockshake.dynamics.load_motion import load_motion
from blockshake.study.simulation import simulate


def climb_ladder(structure, motion, model, time_step, duration, ladder):
    """Simulate one structure at growing intensities, each from the restored stack.

    Parameters
    ----------
    structure, motion, model : str
    time_step, duration : float
        [s]
    ladder : Ladder
        First scale, increment, highest scale and the drift that counts as a potential collapse.

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
    rungs = []
    count = int(np.floor((ladder.highest - ladder.first) / ladder.increment + 1e-9)) + 1
    for scale in ladder.first + ladder.increment * np.arange(count):
        run = simulate(
            structure,
            load_motion(motion, float(scale)),
            model,
            time_step=time_step,
            duration=duration,
            accelerometers=False,
        )
        moved = run["position"].sel(axis="x") - run["position"].sel(axis="x").isel(time=0)
        drift = np.abs(moved - moved.isel(body=0)).max()
        rungs.append(
            {
                "scale": float(scale),
                "status": run.attrs["status"],
                "reason": run.attrs["reason"],
                "peak": float(drift),
                "passed": run.attrs["status"] == "completed" and float(drift) <= ladder.largest_drift,
            }
        )
        if not rungs[-1]["passed"]:
            break
    return rungs
