"""The program behind ``make bench``: measures how fast the solvers are, prints a table, writes JSON.

Times are CPU seconds of one process, medians and quartiles of repeats; compiling is left out.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import accepted
import arithmetic
import force_evaluation
import machine
import nscd_step
import nscd_walls
import simulated_second
import still_stack
import tables
import walls

from blockshake.files import write_json

REPEATS = 5
BLOCKS = (10, 30, 100, 300, 1000, 2000)
NSCD_BLOCKS = (10, 30, 100, 300, 1000)
PARTS = (
    "force_evaluation", "arithmetic", "simulated_second", "walls", "nscd_step", "nscd_walls", "still_stack",
)  # fmt: skip


def main(arguments=None):
    """Run the parts requested."""
    parser = argparse.ArgumentParser(prog="bench", description=__doc__.partition("\n")[0])
    parser.add_argument("--only", choices=PARTS, action="append", help="measure this part; may be repeated")
    parser.add_argument("--blocks", type=int, nargs="+", help="sizes of the walls")
    parser.add_argument("--quick", action="store_true", help="smallest runs, to see that the program works")
    parser.add_argument(
        "--accept",
        action="store_true",
        help="keep the table in docs/results/bench.md, the operations in bench/accepted.json",
    )
    parser.add_argument("--output", type=Path, default=Path("results/bench.json"))
    options = parser.parse_args(arguments)
    result = measure(options.only or PARTS, options.blocks, options.quick)
    write_json(options.output, result)
    sys.stdout.write(tables.as_text(result))
    if options.accept:
        accepted.accept(result, tables.as_text(result))


def measure(parts, blocks, quick):
    """Results by part, with what they were measured on."""
    repeats = 1 if quick else REPEATS
    result = {
        "machine": {**machine.describe_machine(), "clock_ghz": machine.measure_clock(repeats)},
        "versions": machine.describe_versions(),
    }
    if "force_evaluation" in parts or "arithmetic" in parts:
        evaluations = 100 if quick else force_evaluation.EVALUATIONS
        result["force_evaluation"] = force_evaluation.measure_force_evaluation(repeats, evaluations)
    if "arithmetic" in parts:
        exact = result["force_evaluation"]["exact distance"]["ns_per_node"]["median"]
        result["arithmetic"] = arithmetic.measure_arithmetic(repeats, exact)
    if "simulated_second" in parts:
        result["simulated_second"] = (
            simulated_second.measure_simulated_second(repeats, 0.01, ("configuration-1",))
            if quick
            else simulated_second.measure_simulated_second(repeats)
        )
    if "walls" in parts:
        sizes, steps = ((10, 30), ("100", "1000")) if quick else (blocks or BLOCKS, ())
        result["walls"] = walls.summary([_wall(walls, n_blocks, repeats, *steps) for n_blocks in sizes])
    if "nscd_step" in parts:
        result["nscd_step"] = (
            nscd_step.measure_nscd_step(repeats, 0.02, ("configuration-1",), ())
            if quick
            else nscd_step.measure_nscd_step(repeats)
        )
    if "nscd_walls" in parts:
        sizes, steps = ((10, 30), ("2", "20")) if quick else (blocks or NSCD_BLOCKS, ())
        result["nscd_walls"] = nscd_walls.summary(
            [_wall(nscd_walls, n_blocks, repeats, *steps) for n_blocks in sizes]
        )
    if "still_stack" in parts:
        result["still_stack"] = (
            still_stack.measure_still_stack(1.0, ("eight equal cubes",), ("nscd-rigid",))
            if quick
            else still_stack.measure_still_stack()
        )
    return result


def _wall(program, n_blocks, repeats, *steps):
    """One wall in a process of its own, so that its memory is its own."""
    command = [sys.executable, program.__file__, str(n_blocks), str(repeats), *steps]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)


if __name__ == "__main__":
    main()
