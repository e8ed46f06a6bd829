"""Bonded walls in nonsmooth contact dynamics: cost and iterations of a step against the number of blocks."""

import json
import sys

import numpy as np
from machine import peak_memory
from nscd_step import nscd_run, step_cost
from walls import wall_mapping

from blockshake.geometry.structure import build_structure

LANDED = 20  # steps of 1 ms; the wall falls for 5
FEWEST_STEPS, BLOCK_STEPS = 10, 10_000  # as in `walls`


def measure_wall(n_blocks, repeats, fewest_steps=FEWEST_STEPS, block_steps=BLOCK_STEPS):
    """`step_cost` of one landed wall in this process, with its ``blocks`` and ``peak_memory_mib``."""
    structure = build_structure(wall_mapping(n_blocks), f"wall of {n_blocks} blocks", ".")
    steps = max(fewest_steps, block_steps // n_blocks)
    cost = step_cost(nscd_run(structure, None), LANDED, LANDED + steps, repeats)
    return {"blocks": n_blocks, **cost, "peak_memory_mib": peak_memory()}


def summary(sizes):
    """``sizes``, ``spread_by_block`` and ``exponent`` as of the walls of LS-DEM (`walls.summary`)."""
    blocks = np.array([wall["blocks"] for wall in sizes])
    step = np.array([wall["us_per_step"]["median"] for wall in sizes])
    return {
        "sizes": sizes,
        "spread_by_block": float(np.max(step / blocks) / np.min(step / blocks) - 1.0),
        "exponent": float(np.polyfit(np.log(blocks), np.log(step), 1)[0]),
    }


if __name__ == "__main__":
    sys.stdout.write(json.dumps(measure_wall(*map(int, sys.argv[1:]))))
