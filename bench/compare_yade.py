"""Yade's level sets with LS-DEM on the same three blocks; needs ``yade`` (Debian 12: 2023.02a).

Run it from the project's root as ``python bench/compare_yade.py``; without Yade it states it and ends well.
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import machine
import numpy as np
from measuring import seconds_between, spread
from motions import ACCELERATION, FREQUENCY, harmonic

from blockshake.files import write_json
from blockshake.geometry.structure import build_structure, load_structure
from blockshake.geometry.surface_nodes import box_nodes
from blockshake.solvers.ls_dem.driver import simulate_ls_dem
from blockshake.solvers.ls_dem.parameters import LsDemParameters

REPEATS = 5
STRUCTURE = "configuration-1"
PARAMETERS = LsDemParameters()
TIME_STEP = 1e-5  # s
STEPS = {"yade": 20_000, "blockshake": 50_000}  # of a repeat, about a second and half of one
RESTING = 0.5  # s
IMPACT_SPEED, IMPACT_GAP, IMPACT_TIME = 0.1, 1e-5, 5e-3  # m/s, m, s
FACTOR = 20.0  # issue "LS-DEM: faithful to the paper", section Speed, for Yade 2023.02a


def main():
    """Compare, print and write."""
    parser = argparse.ArgumentParser(prog="compare_yade", description=__doc__.partition("\n")[0])
    parser.add_argument("--output", type=Path, default=Path("results/compare_yade.json"))
    output = parser.parse_args().output
    if shutil.which("yade") is None:
        sys.stdout.write("skipped: there is no yade on this machine\n")
        return
    result = compare()
    write_json(output, result)
    sys.stdout.write(as_text(result))


def compare():
    """Time both in turn, then what each makes of rest and of an impact."""
    structure = load_structure(STRUCTURE)
    run = _shaken(structure)
    run(TIME_STEP)
    yade, ours = [], []
    for repeat in range(REPEATS):
        yade.append(_yade({**yade_task(structure), "physics": repeat == 0}))
        ours += list(seconds_between(run, TIME_STEP, (STEPS["blockshake"] + 1) * TIME_STEP, 1))
    yade_cost = spread([one["cpu_us_per_step"] for one in yade])
    our_cost = spread(1e6 * np.array(ours) / STEPS["blockshake"])
    nodes, _ = _block_nodes(structure)
    return {
        "machine": machine.describe_machine(),
        "versions": {**machine.describe_versions(), "yade": _yade_version()},
        "yade": {
            "cpu_us_per_step": yade_cost,
            "clock_us_per_step": spread([one["clock_us_per_step"] for one in yade]),
            **{key: yade[0][key] for key in ("nodes", "nodes_on_bed", "contacts", "rest", "impact")},
        },
        "blockshake": {
            "cpu_us_per_step": our_cost,
            "nodes": len(nodes),
            "rest": _rest(),
            "impact": _impacts(),
        },
        "times_faster": yade_cost["median"] / our_cost["median"],
    }


def yade_task(structure):
    """Numbers that Yade needs for the same problem."""
    block = structure.file.shapes["block"]
    nodes, flat = _block_nodes(structure)
    return {
        "block": block.box,
        "density": float(structure.mass[-1] / np.prod(block.box)),  # Yade's box has no chamfer
        "friction": float(structure.friction[-1, -2]),
        "kn": PARAMETERS.normal_stiffness * flat,
        "ks": PARAMETERS.shear_stiffness * flat,
        "gravity": -structure.file.gravity[2],
        "nodes": len(nodes),
        "grid_spacing": 0.02,
        "time_step": TIME_STEP,
        "settling_steps": 20_000,
        "steps": STEPS["yade"],
        "resting_steps": round(RESTING / TIME_STEP),
        "acceleration": ACCELERATION,
        "frequency": FREQUENCY,
        "impact_speed": IMPACT_SPEED,
        "impact_gap": IMPACT_GAP,
        "impact_steps": round(IMPACT_TIME / TIME_STEP),
    }


def _block_nodes(structure):
    """Nodes of a block, and the area of the flat that it stands on [m2]."""
    block = structure.file.shapes["block"]
    points, areas = box_nodes(
        block.box, block.chamfer, block.hollow, PARAMETERS.node_spacing, PARAMETERS.perimeter_inset
    )
    return points, float(areas[points[:, 2] == -0.5 * block.box[2]].sum())


def _yade(task):
    script = Path(__file__).with_name("yade_three_blocks.py")
    with tempfile.TemporaryDirectory() as folder:
        result = Path(folder) / "result.json"
        command = ["yade", "-n", "-x", "-j1", str(script), json.dumps(task), str(result)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return json.loads(result.read_text())


def _yade_version():
    text = subprocess.run(["yade", "--version"], capture_output=True, text=True).stdout
    return text.split()[-1] if text.split() else "unknown"


def _shaken(structure):
    motion = harmonic((STEPS["blockshake"] + 1) * TIME_STEP)

    def run(until):
        return simulate_ls_dem(structure, motion, PARAMETERS, np.array([0.0, until]), TIME_STEP)

    return run


def _rest():
    """Sinking and straying of our stack without damping, as `yade_three_blocks.rest`."""
    structure = load_structure(STRUCTURE, {"restitution": 1.0})
    run = simulate_ls_dem(structure, None, PARAMETERS, np.linspace(0.0, RESTING, 21), TIME_STEP)
    free = ~structure.driven
    moved = np.linalg.norm(run.position[:, free] - run.position[0, free], axis=2)
    dot = np.abs((run.orientation[:, free] * run.orientation[0, free]).sum(axis=2))
    return {
        "sinking_um": [float(1e6 * z) for z in (structure.position - run.position[0])[free, 2]],
        "strays_um": float(1e6 * moved.max()),
        "turns_rad": float(2.0 * np.arccos(np.minimum(dot, 1.0)).max()),
    }


def _impacts():
    """Rebound of a block's face for restitutions of 1 and 0.5, as `yade_three_blocks.rebound`."""
    return {f"C_res {restitution:g}": _rebound(restitution) for restitution in (1.0, 0.5)}


def _rebound(restitution):
    mapping = load_structure(STRUCTURE).file.model_dump()
    slab, block = mapping["bodies"][:2]
    block["position"] = (0.0, 0.0, block["position"][2] + IMPACT_GAP)
    block["velocity"] = (0.0, 0.0, -IMPACT_SPEED)
    mapping |= {
        "bodies": [slab, block], "markers": [], "accelerometers": [],
        "gravity": (0.0, 0.0, 0.0), "restitution": restitution,
    }  # fmt: skip
    structure = build_structure(mapping, "impact", ".")
    run = simulate_ls_dem(structure, None, PARAMETERS, np.array([0.0, IMPACT_TIME]), TIME_STEP)
    return {
        "rebound": float(run.velocity[-1, 1, 2] / IMPACT_SPEED),
        "spin_rad_s": float(np.linalg.norm(run.angular_velocity[-1, 1])),
    }


def as_text(result):
    """Both side by side."""
    sides = result["yade"], result["blockshake"]
    costs = [side["cpu_us_per_step"] for side in sides]
    rests = [side["rest"] for side in sides]
    # without damping in both
    impacts = [result["yade"]["impact"], result["blockshake"]["impact"]["C_res 1"]]
    damped = result["blockshake"]["impact"]["C_res 0.5"]
    rows = [
        ("", *(f"{name} {result['versions'][name]}" for name in ("yade", "blockshake"))),
        ("CPU time of a step, median [us]", *(f"{cost['median']:.2f}" for cost in costs)),
        (
            "quartiles [us]",
            *(f"{cost['lower_quartile']:.2f}, {cost['upper_quartile']:.2f}" for cost in costs),
        ),
        ("nodes of a block", *(side["nodes"] for side in sides)),
        ("sinking at rest [um]", *(", ".join(f"{z:.3f}" for z in rest["sinking_um"]) for rest in rests)),
        (f"strays in {RESTING} s undamped [um]", *(f"{rest['strays_um']:.2g}" for rest in rests)),
        ("turns meanwhile [rad]", *(f"{rest['turns_rad']:.2g}" for rest in rests)),
        ("rebound of a face, undamped", *(f"{impact['rebound']:.4f}" for impact in impacts)),
        ("spin after it [rad/s]", *(f"{impact['spin_rad_s']:.2g}" for impact in impacts)),
        ("rebound for C_res 0.5", "no such law", f"{damped['rebound']:.4f}"),
    ]
    lines = [f"{label:<36}{left!s:<28}{right}" for label, left, right in rows]
    lines.append(f"{result['times_faster']:.1f} times faster; target {FACTOR:g}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
