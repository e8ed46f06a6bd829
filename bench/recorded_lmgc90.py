"""Record of LMGC90 with blockshake, kept in a file because few have the program."""

import datetime
import json
import platform
from pathlib import Path

import numpy as np
import peers
import xarray as xr
from motions import FREQUENCY, harmonic
from nscd_step import TIME_STEP

from blockshake.geometry.structure import load_structure
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

RECORD = Path(__file__).parents[1] / "data" / "peers" / "lmgc90.nc"
PROGRAMS = ("LMGC90", "blockshake")
SPEED_HEADER = (
    "case", "LMGC90 [us]", "blockshake [us]", "times faster", "residual, LMGC90", "residual, blockshake",
)  # fmt: skip
EVERY = 5  # steps of 1 ms between points
# structure, acceleration [m/s2], duration [s]: those of tests/validation
HISTORIES = {
    "three blocks": ("configuration-1", 3.0, 2.0),
    "nine blocks": ("configuration-3", 1.5, 10.0),
}


def recorded_comparison(result):
    """Histories of both programs, and the costs and residuals of a comparison.

    Parameters
    ----------
    result : dict
        ``machine``, ``versions`` and ``cases`` of `compare_lmgc90`.

    Returns
    -------
    xarray.Dataset
        ``displacement(history, program, time)`` of the top block along x with respect to the slab [m], NaN after
        a history's end; ``largest_difference(history)`` of any block [m]; ``step_time(case, program)`` CPU time
        of a step [s]; ``residual(case, program)`` of the contact law, worst of the steps looked at [1];
        ``times_faster(case)``. Attributes: date, machine, versions.
    """
    runs = {name: _both(*history) for name, history in HISTORIES.items()}
    times = EVERY * TIME_STEP * np.arange(1, max(len(ours) for _, ours in runs.values()) + 1)
    displacement = np.full((len(runs), len(PROGRAMS), len(times)), np.nan)
    for row, (theirs, ours) in enumerate(runs.values()):
        displacement[row, :, : len(ours)] = theirs[:, -1], ours[:, -1]
    cases = result["cases"].values()
    structures, accelerations, _ = zip(*HISTORIES.values(), strict=True)
    recorded = xr.Dataset(
        {
            "displacement": (("history", "program", "time"), displacement, {"units": "m"}),
            "largest_difference": (
                "history", [np.abs(theirs - ours).max() for theirs, ours in runs.values()], {"units": "m"}
            ),
            "acceleration": ("history", list(accelerations), {"units": "m s-2"}),
            "step_time": (
                ("case", "program"),
                [[1e-6 * case[name.lower()]["us_per_step"]["median"] for name in PROGRAMS] for case in cases],
                {"units": "s"},
            ),
            "residual": (
                ("case", "program"),
                [[case["lmgc90"]["residual"]["worst"], case["blockshake"]["max_residual"]] for case in cases],
                {"units": "1"},
            ),
            "times_faster": ("case", [case["times_faster"] for case in cases], {"units": "1"}),
        },
        coords={
            "history": list(HISTORIES),
            "structure": ("history", list(structures)),
            "program": list(PROGRAMS),
            "time": ("time", times, {"units": "s"}),
            "case": list(result["cases"]),
        },
        attrs={
            "title": "LMGC90 and blockshake, both run and timed on one machine",
            "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
            "machine": f"{result['machine']['processor']} ({result['machine']['instruction_set']}), "
            f"{result['machine']['cores']} cores, {platform.system()}",
            "versions": json.dumps(result["versions"]),
            "lmgc90": f"{peers.LMGC90} {result['versions'][peers.LMGC90]}",
            "time_step": TIME_STEP,
            "frequency": FREQUENCY,
            "history_of_this_file": "made by bench/compare_lmgc90.py --record",
        },
    )  # fmt: skip
    return recorded


def speed_rows():
    """Rows of the page's table of speed, from `RECORD`: CPU time of a step and residual, by case."""
    record, rows = xr.load_dataset(RECORD), []
    for name in record["case"].values:
        one = record.sel(case=name)
        theirs, ours = (one.sel(program=program) for program in PROGRAMS)
        times = (f"{1e6 * float(program['step_time']):,.0f}" for program in (theirs, ours))
        residuals = (f"{float(program['residual']):.0e}" for program in (theirs, ours))
        rows.append((name, *times, f"{float(one['times_faster']):.1f}", *residuals))
    return rows


def _both(name, acceleration, duration):
    """Displacement of the free bodies along x over the slab [m], theirs and ours, shape (n_times, n_free)."""
    structure, motion = load_structure(name), harmonic(duration + 0.1, acceleration)
    steps = round(duration / TIME_STEP)
    task = peers.block_task(structure, motion, TIME_STEP, steps, record_every=EVERY)
    times = EVERY * TIME_STEP * np.arange(steps // EVERY + 1)
    ours = simulate_nscd(structure, motion, NscdParameters(), times, TIME_STEP).position[1:]
    theirs = peers.ask_peer(peers.LMGC90, task)["position"]
    return tuple(over_slab(structure, position) for position in (theirs, ours))


def over_slab(structure, position):
    """Displacement of the free bodies along x with respect to the slab [m], shape (n_times, n_free)."""
    free = ~structure.driven
    slab = position[:, np.flatnonzero(structure.driven)[0], 0] - structure.position[structure.driven, 0][0]
    return position[:, free, 0] - structure.position[free, 0] - slab[:, None]
