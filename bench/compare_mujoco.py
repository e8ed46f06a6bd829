"""MuJoCo's soft contacts with our rigid ones on three shaken blocks: time of a step, and what softness costs.

Run it from the project's root as ``python bench/compare_mujoco.py`` after ``make peers``; without the peer it states it
and ends well.
"""

import argparse
import sys
from pathlib import Path

import machine
import numpy as np
import peers
from measuring import seconds_between, spread
from motions import harmonic
from nscd_step import TIME_STEP, nscd_run

from blockshake.files import write_json
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

ACCELERATION = 3.0  # m/s2: the stack rocks
DURATION = 3.0  # s
REFERENCE_STEP = 1e-4  # s, of our run that all others are held against
TIMED = (500, 3000)  # steps
REPEATS = 5
TOLERANCE = 1e-6  # of our timed runs; issue "Nonsmooth contact dynamics", section Speed
# time constant [s] and damping ratio, impedances and width: MuJoCo's defaults, the stiffest time constant that a
# step of 1 ms allows, and that with impedances near one, as `mujoco_blocks` takes them if unknown
SETTINGS = {
    "defaults": {"solref": (0.02, 1.0), "solimp": (0.9, 0.95, 1e-3, 0.5, 2.0)},
    "stiff time constant": {"solref": (2e-3, 1.0), "solimp": (0.9, 0.95, 1e-3, 0.5, 2.0)},
    "stiff": {},
}


def main():
    """Compare, print and write."""
    parser = argparse.ArgumentParser(prog="compare_mujoco", description=__doc__.partition("\n")[0])
    parser.add_argument("--output", type=Path, default=Path("results/compare_mujoco.json"))
    output = parser.parse_args().output
    version = peers.peer_version(peers.MUJOCO)
    if version is None:
        sys.stdout.write(f"skipped: {peers.MISSING.format(peers.MUJOCO)}\n")
        return
    structure, motion = sharp_stack(), harmonic(DURATION + 0.1, ACCELERATION)
    result = {
        "machine": machine.describe_machine(),
        "versions": {**machine.describe_versions(), peers.MUJOCO: version},
        **times(structure, motion),
        "accuracy": accuracy(structure, motion),
    }
    write_json(output, result)
    sys.stdout.write(as_text(result))


def sharp_stack():
    """Configuration 1 without chamfers: MuJoCo's quick shape is a box."""
    mapping = load_structure("configuration-1").file.model_dump()
    mapping["shapes"]["block"]["chamfer"] = 0.0
    return build_structure(mapping, "sharp configuration-1", ".")


def times(structure, motion):
    """CPU time of a step, both in turn, nothing recorded: MuJoCo stepped from Python, as its users do."""
    first, last = TIMED
    task = peers.block_task(structure, motion, TIME_STEP, last, timed_from=first)
    run = nscd_run(structure, motion, tolerance=TOLERANCE)
    run(first)
    theirs, ours = [], []
    for _ in range(REPEATS):
        theirs.append(float(peers.ask_peer(peers.MUJOCO, task)["cpu_us_per_step"]))
        ours += list(1e6 * seconds_between(run, first, last, 1) / (last - first))
    numerics = run(last).numerics
    return {
        "mujoco": {"us_per_step": spread(theirs)},
        "blockshake": {
            "us_per_step": spread(ours),
            "iterations": numerics["mean_iterations"],
            "max_residual": numerics["max_residual"],
        },
        "times_faster": float(np.median(theirs) / np.median(ours)),
    }


def accuracy(structure, motion):
    """How far runs of 1 ms are from ours of 0.1 ms, as shares of the top block's peak over the slab.

    Returns
    -------
    dict of str to dict
        For each of `SETTINGS` and for ours: ``peak`` (error of the peak), ``two_seconds`` and ``whole`` (largest
        difference of histories) [1]; ``deepest`` penetration [m].
    """
    record = 5 * TIME_STEP * np.arange(round(DURATION / TIME_STEP / 5) + 1)
    ground = motion.evaluate(record[1:])[:, 0] - motion.evaluate(np.zeros(1))[0, 0]
    half = record[1:] <= 2.0

    def ours(time_step):
        run = simulate_nscd(structure, motion, NscdParameters(), record, time_step)
        return run.position[1:, -1, 0] - ground, run.numerics["max_penetration"]

    exact, _ = ours(REFERENCE_STEP)
    runs = {"blockshake": ours(TIME_STEP)}
    for name, setting in SETTINGS.items():
        task = peers.block_task(
            structure, motion, TIME_STEP, round(DURATION / TIME_STEP), record_every=5, **setting
        )
        answer = peers.ask_peer(peers.MUJOCO, task)
        runs[f"MuJoCo, {name}"] = answer["position"][:, -1, 0] - ground, float(answer["deepest"])
    peak = np.abs(exact).max()
    return {
        name: {
            "peak": float(np.abs(moved).max() / peak - 1.0),
            "two_seconds": float(np.abs(moved - exact)[half].max() / peak),
            "whole": float(np.abs(moved - exact).max() / peak),
            "deepest": deepest,
        }
        for name, (moved, deepest) in runs.items()
    }


def as_text(result):
    """Times and accuracy."""
    theirs, ours = result["mujoco"]["us_per_step"], result["blockshake"]["us_per_step"]
    lines = [
        f"{result['machine']['processor']}, MuJoCo {result['versions'][peers.MUJOCO]}, "
        f"blockshake {result['versions']['blockshake']}",
        f"CPU of a step, three blocks, 1 Hz, {ACCELERATION:g} m/s2: MuJoCo {theirs['median']:.1f} us, blockshake "
        f"{ours['median']:.1f} us ({result['times_faster']:.2f} times as fast) at a residual of "
        f"{result['blockshake']['max_residual']:.0e}",
        f"{'against 0.1 ms of ours':<34}{'peak':>9}{'2 s':>9}{f'{DURATION:g} s':>9}{'deepest':>12}",
    ]
    for name, errors in result["accuracy"].items():
        shares = "".join(f"{100 * errors[key]:>7.2f} %" for key in ("peak", "two_seconds", "whole"))
        lines.append(f"{name:<34}{shares}{1e6 * errors['deepest']:>9.2g} um")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
