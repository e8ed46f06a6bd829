"""LMGC90's core with our nonsmooth contact dynamics: time of a step, and how well each step is solved.

Run it from the project's root as ``python bench/compare_lmgc90.py`` after ``make peers``; without the peer it states it
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
from nscd_step import CONFIGURATIONS, TIME_STEP, nscd_run, step_cost
from recorded_lmgc90 import recorded_comparison
from residuals import law_residual
from walls import wall_mapping

from blockshake.files import write_dataset, write_json
from blockshake.geometry.structure import build_structure, load_structure

FRICTION = 0.75  # of all pairs: the wheel knows one
SHAKEN = (500, 2500)  # steps, first and last of those timed
LANDED = 20  # steps, after which a wall's are timed
WALLS = {100: 100, 1000: 10}  # blocks, steps timed
LOOKS = 5  # steps of a case whose contacts are held against the law
REPEATS = 3
FACTOR, GOAL = 3.0, 10.0  # issue "Nonsmooth contact dynamics", section Speed
CASES = (*CONFIGURATIONS, *(f"wall of {n_blocks}" for n_blocks in WALLS))


def main():
    """Compare, print and write."""
    parser = argparse.ArgumentParser(prog="compare_lmgc90", description=__doc__.partition("\n")[0])
    parser.add_argument("--output", type=Path, default=Path("results/compare_lmgc90.json"))
    parser.add_argument("--record", type=Path, help="netCDF of all of it, histories included")
    parser.add_argument("--only", choices=CASES, action="append", help="compare this case; may be repeated")
    parser.add_argument("--repeats", type=int, default=REPEATS)
    options = parser.parse_args()
    version = peers.peer_version(peers.LMGC90)
    if version is None:
        sys.stdout.write(f"skipped: {peers.MISSING.format(peers.LMGC90)}\n")
        return
    result = {
        "machine": machine.describe_machine(),
        "versions": {**machine.describe_versions(), peers.LMGC90: version},
        "cases": {name: compare(*case(name), options.repeats) for name in options.only or CASES},
    }
    write_json(options.output, result)
    sys.stdout.write(as_text(result))
    if options.record:
        write_dataset(options.record, recorded_comparison(result), decimals={"m": 7})


def case(name):
    """Structure, motion, and first and last step that are timed."""
    if name in CONFIGURATIONS:
        shipped = load_structure(name)
        parameters = {f"friction.{'.'.join(entry.pair)}": FRICTION for entry in shipped.file.friction}
        return load_structure(name, parameters), harmonic(SHAKEN[1] * TIME_STEP), *SHAKEN
    n_blocks = int(name.split()[-1])
    return build_structure(wall_mapping(n_blocks), name, "."), None, LANDED, LANDED + WALLS[n_blocks]


def compare(structure, motion, first, last, repeats):
    """Both in turn over the same steps.

    Returns
    -------
    dict
        ``lmgc90``: ``us_per_step``, ``residual`` (`residuals.law_residual` of some of the steps: the median and the
        worst) and ``deepest`` penetration met in them [m]; ``blockshake``: `nscd_step.step_cost`; ``times_faster``.
    """
    spacing = (last - first) // LOOKS
    looked = list(range(first + spacing, last + 1, spacing))
    task = peers.block_task(structure, motion, TIME_STEP, last)
    answer = peers.ask_peer(
        peers.LMGC90,
        {**task, "record_every": int(np.gcd(first, spacing)), "contact_steps": looked},
    )
    found = np.array([law_residual(structure, answer, step, TIME_STEP) for step in looked])
    run = nscd_run(structure, motion)
    ours = step_cost(run, first, last, 1)
    theirs, own = [], []
    for _ in range(repeats):
        theirs.append(float(peers.ask_peer(peers.LMGC90, {**task, "timed_from": first})["cpu_us_per_step"]))
        own += list(1e6 * seconds_between(run, first, last, 1) / (last - first))
    ours["us_per_step"] = spread(own)
    return {
        "lmgc90": {
            "us_per_step": spread(theirs),
            "residual": {"median": float(np.median(found[:, 0])), "worst": float(found[:, 0].max())},
            "deepest": float(found[:, 1].max()),
        },
        "blockshake": ours,
        "times_faster": float(np.median(theirs) / np.median(own)),
    }


def as_text(result):
    """Table of the cases."""
    machine_, versions = result["machine"], result["versions"]
    lines = [
        f"{machine_['processor']} ({machine_['instruction_set']}), LMGC90 in {peers.LMGC90} "
        f"{versions[peers.LMGC90]}, blockshake {versions['blockshake']}, numba {versions['numba']}",
        "CPU us of a step of 1 ms (median), and relative residual of the contact law (worst)",
        f"{'':<18}{'LMGC90':>10}{'blockshake':>12}{'ratio':>8}   {'residuals':<22}{'iterations':<12}capped",
    ]
    for name, both in result["cases"].items():
        theirs, ours, ratio = both["lmgc90"], both["blockshake"], both["times_faster"]
        verdict = "goal" if ratio >= GOAL else "met" if ratio >= FACTOR else "NOT met"
        lines.append(
            f"{name:<18}{theirs['us_per_step']['median']:>10.0f}{ours['us_per_step']['median']:>12.0f}{ratio:>8.2f}   "
            f"{theirs['residual']['worst']:.0e}, {ours['max_residual']:.0e}{'':<8}{ours['iterations']:<12.1f}"
            f"{100 * ours['capped']:.0f} %  {verdict}"
        )
    lines.append(f"Target: {FACTOR:g} times faster everywhere, {GOAL:g} as the goal.")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
