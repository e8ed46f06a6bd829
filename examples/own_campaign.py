"""Own tests from spreadsheets to a verdict: two tests as CSV files in mm and g, their map, the import, the diagnosis.

``python examples/own_campaign.py [FOLDER]`` (some minutes). The files stay in FOLDER, ``own-campaign`` by default. The
readings are made up here by a simulation in which a force of -1.5 kN pushes the upper block, and stand for those that
you have. The diagnosis is unknown of the force.
"""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import yaml

import blockshake
from blockshake.measurement.sensors.instruments import Instruments, observe

PUSH = {"body": "block-2", "position": [0.0, 0.0, 0.4], "amplitude": -1500.0, "start": 3.0}
G, MM = 9.80665, 1e-3
BLOCKSHAKE = [sys.executable, "-m", "blockshake"]  # the command line
BLOCKS, WIDTH, HEIGHT = ("block-1", "block-2"), 0.6, 1.0  # m
TESTS = {"t1": 0.34, "t2": 0.36}  # g, amplitude of the table


def structure():
    """The structure file as a mapping: two blocks, two markers and an accelerometer on each body."""
    bodies = [
        {"name": "slab", "shape": "slab", "material": "granite", "position": [0, 0, -0.1], "driven": True}
    ]
    for number, name in enumerate(BLOCKS):
        bodies.append(
            {
                "name": name,
                "shape": "block",
                "material": "granite",
                "position": [0, 0, (number + 0.5) * HEIGHT],
            }
        )
    points = {"slab": [(-1.4, 0.0, 0.0), (1.4, 0.0, 0.0)]}
    points |= {name: [(0.5 * WIDTH, 0.0, -0.4), (0.5 * WIDTH, 0.0, 0.4)] for name in BLOCKS}
    return {
        "name": "own-stack",
        "materials": {"granite": {"density": 2650.0, "youngs_modulus": 5.0e10, "poisson_ratio": 0.25}},
        "shapes": {"slab": {"box": [3.0, 3.0, 0.2]}, "block": {"box": [WIDTH, 1.2, HEIGHT], "chamfer": 0.01}},
        "bodies": bodies,
        "friction": [{"pair": ["granite", "granite"], "coefficient": 0.7}],
        "markers": [
            {"name": f"{body}-{end}", "body": body, "position": list(point)}
            for body, both in points.items()
            for end, point in zip("ab", both, strict=True)
        ],
        "accelerometers": [
            {"name": f"{body}-acc", "body": body, "position": [0.0, 0.0, 0.0], "axes": ["x", "z"]}
            for body in points
        ],
    }


def motion(path, amplitude):
    """A motion file: a burst of sine after a second of rest, acceleration in m/s2."""
    time = np.arange(0.0, 7.0, 0.005)
    burst = np.sin(2.0 * np.pi * 1.2 * (time - 1.0)) * np.exp(-(((time - 2.5) / 1.5) ** 2)) * (time > 1.0)
    pd.DataFrame({"time_s": time, "acceleration_x": G * amplitude * burst}).to_csv(path, index=False)


def write_readings(folder, name, run, stack, seed):
    """Two spreadsheets of a test: markers in mm, accelerometers in g."""
    test = observe(run, stack, Instruments(), seed)
    time = test["time"].to_numpy()
    moved = {"Zeit": time}
    for marker in test["marker"].values:
        for axis in "xyz":
            moved[f"{marker} {axis}"] = (
                test["marker_displacement"].sel(marker=marker, axis=axis).to_numpy() / MM
            )
    pd.DataFrame(moved).to_csv(folder / f"{name}-markers.csv", index=False, sep=";")
    felt = {"Zeit": test["time_acc"].to_numpy()}
    for channel in test["channel"].values:
        felt[str(channel)] = test["accelerometer"].sel(channel=channel).to_numpy() / G
    pd.DataFrame(felt).to_csv(folder / f"{name}-accelerometers.csv", index=False, sep=";")


def columns(stack):
    """The map's entries: MARKER.AXIS or channel by column."""
    markers = {f"{one.name}.{axis}": f"{one.name} {axis}" for one in stack.file.markers for axis in "xyz"}
    channels = {
        f"{one.name}-{axis}": f"{one.name}-{axis}" for one in stack.file.accelerometers for axis in one.axes
    }
    return markers | channels


def example(folder):
    """Make up the spreadsheets, then do what a user does with them."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "own-stack.yaml").write_text(yaml.safe_dump(structure(), sort_keys=False), encoding="utf-8")
    (folder / "pushed.yaml").write_text(
        yaml.safe_dump(structure() | {"external_forces": [PUSH]}, sort_keys=False), encoding="utf-8"
    )
    pushed = blockshake.load_structure(folder / "pushed.yaml")
    for seed, (name, amplitude) in enumerate(TESTS.items()):
        motion(folder / f"{name}-motion.csv", amplitude)
        run = blockshake.simulate(pushed, folder / f"{name}-motion.csv", "nscd-rigid")
        write_readings(folder, name, run, pushed, seed)
    tests = [
        {
            "name": name, "file": f"{name}-markers.csv", "accelerometers": f"{name}-accelerometers.csv",
            "motion": f"{name}-motion.csv", "scale": 1.0, "role": "fit",
        }
        for name in TESTS
    ]  # fmt: skip
    entries = {
        "name": "own-campaign",
        "structure": "own-stack.yaml",
        "time": "Zeit",
        "displacement_unit": "mm",
        "acceleration_unit": "g",
        "columns": columns(pushed),
        "tests": tests,
    }
    (folder / "map.yaml").write_text(yaml.safe_dump(entries, sort_keys=False), encoding="utf-8")
    shutil.rmtree(folder / "campaign", ignore_errors=True)  # of a run before: an import overwrites nothing
    subprocess.run(
        [*BLOCKSHAKE, "import-campaign", str(folder / "map.yaml"), "--output", str(folder / "campaign")],
        check=True,
    )
    campaign, diagnosis = str(folder / "campaign"), str(folder / "diagnosis")
    subprocess.run(
        [*BLOCKSHAKE, "diagnose", campaign, "--output", diagnosis, "--effort", "quick"], check=True
    )


if __name__ == "__main__":
    example(Path(sys.argv[1] if len(sys.argv) > 1 else "own-campaign"))
