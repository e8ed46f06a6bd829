"""Bonded walls of precast blocks: how the cost of a step grows with the number of blocks."""

import json
import sys
import time

import numpy as np
from machine import peak_memory
from measuring import seconds_between, spread

from blockshake.geometry.structure import build_structure
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters

LENGTH, THICKNESS, HEIGHT = 1.6, 0.8, 0.8  # m, a usual precast concrete block
CHAMFER = 0.02  # m
HEAD_JOINT = 1e-3  # m; blocks are laid dry, and their ends do not touch
# m; the wall starts this far above its foundation. What would move by more than 0.1 mm starts as it is
# given, so that no set-up time goes into an equilibrium, and all joints close as the wall lands.
DROP = 1.1e-4
TIME_STEP = 1e-5  # s
LANDED = 600  # steps; the fall lasts 474
FEWEST_STEPS, BLOCK_STEPS = 1000, 1_000_000  # a repeat lasts so many steps, and longer in small walls
LINEAR_WITHIN = 0.25  # of the cheapest size, the target of both solvers


def courses_and_length(n_blocks):
    """Courses and whole blocks in a course of the wall that has exactly so many free blocks.

    Among the walls that have, the one whose length is nearest to twice the courses.
    """
    sizes = [
        (courses, (n_blocks - (courses + 1) // 2) // courses)
        for courses in range(1, n_blocks + 1)
        if (n_blocks - (courses + 1) // 2) % courses == 0 and n_blocks > (courses + 1) // 2
    ]
    return min(sizes, key=lambda size: abs(np.log(size[1] / size[0] / 2.0)))


def wall_mapping(n_blocks):
    """Structure file of a wall in running bond above a driven course of the same blocks.

    Every second course has half blocks at both its ends.
    """
    courses, length = courses_and_length(n_blocks)
    pitch, half = LENGTH + HEAD_JOINT, 0.5 * (LENGTH - HEAD_JOINT)
    whole_course = [("whole", (i + 0.5) * pitch) for i in range(length)]
    halved_course = [
        ("half", 0.5 * (HEAD_JOINT + half)),
        *[("whole", (i + 1.0) * pitch) for i in range(length - 1)],
        ("half", length * pitch - 0.5 * (HEAD_JOINT + half)),
    ]
    bodies = []
    for course in range(courses + 1):
        z = (course - 0.5) * HEIGHT + (DROP if course else 0.0)
        for rank, (shape, x) in enumerate(halved_course if course % 2 else whole_course):
            bodies.append(
                {
                    "name": f"block-{course}-{rank}", "shape": shape, "material": "concrete",
                    "position": [x, 0.0, z], "driven": course == 0,
                }
            )  # fmt: skip
    return {
        "name": f"wall of {n_blocks} blocks",
        "materials": {"concrete": {"density": 2400.0, "youngs_modulus": 3.45e10, "poisson_ratio": 0.2}},
        "shapes": {
            "whole": {"box": [LENGTH, THICKNESS, HEIGHT], "chamfer": CHAMFER},
            "half": {"box": [half, THICKNESS, HEIGHT], "chamfer": CHAMFER},
        },
        "bodies": bodies,
        "friction": [{"pair": ["concrete", "concrete"], "coefficient": 0.75}],
    }


def measure_wall(n_blocks, repeats, fewest_steps=FEWEST_STEPS, block_steps=BLOCK_STEPS):
    """Cost of one wall in this process.

    Returns
    -------
    dict
        ``load_s`` CPU time to check the structure [s]; ``us_per_step_and_block``: median and
        quartiles [us]; ``peak_memory_mib``: of this process so far [MiB].
    """
    started = time.process_time()
    structure = build_structure(wall_mapping(n_blocks), "wall", ".")
    load = time.process_time() - started

    def run(steps):
        times = np.array([0.0, steps * TIME_STEP])
        trajectory = simulate_ls_dem(structure, None, LsDemParameters(), times, TIME_STEP)
        if trajectory.status != "completed":
            raise RuntimeError(f"the wall of {n_blocks} blocks {trajectory.status}: {trajectory.reason}")
        return trajectory

    steps = max(fewest_steps, block_steps // n_blocks)
    run(1)  # compiles, or loads what was compiled
    seconds = seconds_between(run, LANDED, LANDED + steps, repeats)
    trajectory = run(LANDED)
    return {
        "blocks": n_blocks,
        "courses": courses_and_length(n_blocks)[0],
        "joints": len(trajectory.joints),
        "load_s": load,
        "us_per_step_and_block": spread(1e6 * seconds / steps / n_blocks),
        "peak_memory_mib": peak_memory(),
    }


def summary(sizes):
    """How cost and memory grow over walls of rising size.

    Returns
    -------
    dict
        ``sizes`` as given; ``spread_by_block``, ``spread_by_joint``: cost of a step for a block and
        for a bed joint, dearest over cheapest size less 1 [1]; ``exponent`` of the cost of a step
        over the number of blocks, 1 where it is linear; ``memory_kib_per_block``: difference of the
        last and the first wall's peaks over that of their blocks [KiB].

    Notes
    -----
    The ends of a wall have fewer joints, so that a block of a small wall has less to do; all bed
    joints of a running bond are alike.
    """
    blocks = np.array([wall["blocks"] for wall in sizes])
    joints = np.array([wall["joints"] for wall in sizes])
    step = blocks * np.array([wall["us_per_step_and_block"]["median"] for wall in sizes])
    memory = sizes[-1]["peak_memory_mib"] - sizes[0]["peak_memory_mib"]
    return {
        "sizes": sizes,
        "spread_by_block": float(np.max(step / blocks) / np.min(step / blocks) - 1.0),
        "spread_by_joint": float(np.max(step / joints) / np.min(step / joints) - 1.0),
        "exponent": float(np.polyfit(np.log(blocks), np.log(step), 1)[0]),
        "memory_kib_per_block": float(1024.0 * memory / (blocks[-1] - blocks[0])),
    }


if __name__ == "__main__":
    sys.stdout.write(json.dumps(measure_wall(*map(int, sys.argv[1:]))))
