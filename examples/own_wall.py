"""An own wall under an own record: structure and record as files, both models, a table and a picture.

``python examples/own_wall.py [FOLDER]`` (a minute; the first time more, kernels compile). The files stay in FOLDER,
``own-wall`` by default. The record is made up here, and stands for one that you have: any record that PEER writes.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
import yaml

LENGTH, WIDTH, HEIGHT = 1.0, 0.5, 0.8  # m, of a block along the wall, across it, and up
COURSES, LOWEST_COURSE = 3, 4  # blocks
STEP = 0.005  # s, of the record
BLOCKSHAKE = [sys.executable, "-m", "blockshake"]  # the command line


def wall():
    """The structure file as a mapping: every course has a block less than the one below, and is shifted by half."""
    bodies = [
        {"name": "slab", "shape": "slab", "material": "granite", "position": [0, 0, -0.1], "driven": True}
    ]
    for course in range(COURSES):
        count = LOWEST_COURSE - course
        for place in range(count):
            along = (place - 0.5 * (count - 1)) * LENGTH
            position = [0.0, along, (course + 0.5) * HEIGHT]
            name = f"course-{course + 1}-block-{place + 1}"
            bodies.append({"name": name, "shape": "block", "material": "granite", "position": position})
    top = f"course-{COURSES}-block-1"
    return {
        "name": "own-wall",
        "materials": {"granite": {"density": 2650.0, "youngs_modulus": 5.0e10, "poisson_ratio": 0.25}},
        "shapes": {
            "slab": {"box": [4.0, 6.0, 0.2]},
            "block": {"box": [WIDTH, LENGTH, HEIGHT], "chamfer": 0.01},
        },
        "bodies": bodies,
        "friction": [{"pair": ["granite", "granite"], "coefficient": 0.6}],
        "markers": [
            {"name": "slab", "body": "slab", "position": [2.0, 0.0, 0.0]},
            {"name": "top", "body": top, "position": [0.5 * WIDTH, 0.0, 0.3]},
        ],
    }


def record():
    """A record as PEER writes it, AT2: four lines, then accelerations in g."""
    time = np.arange(0.0, 5.0, STEP)
    acceleration = 0.3 * np.sin(2.0 * np.pi * 2.0 * time) * np.exp(-((time - 2.5) ** 2))
    head = ["PEER NGA STRONG MOTION DATABASE RECORD", "Made up", "ACCELERATION TIME SERIES IN UNITS OF G"]
    head.append(f"NPTS= {len(time)}, DT= {STEP} SEC")
    lines = [" ".join(f"{one: .7E}" for one in row) for row in acceleration.reshape(-1, 5)]
    return "\n".join([*head, *lines]) + "\n"


def top_drift(path):
    """Displacement of the top marker relative to the slab's along x, from a run file [m]."""
    with xr.open_dataset(path) as run:
        along = run["marker_displacement"].sel(axis="x").load()
    return (along.sel(marker="top") - along.sel(marker="slab")).to_numpy()


def example(folder):
    """Write the files, check them, simulate by both models and show the runs."""
    folder.mkdir(parents=True, exist_ok=True)
    structure, motion = folder / "own-wall.yaml", folder / "own.at2"
    structure.write_text(yaml.safe_dump(wall(), sort_keys=False), encoding="utf-8")
    motion.write_text(record(), encoding="utf-8")
    subprocess.run([*BLOCKSHAKE, "check", str(structure), "--picture", str(folder / "wall.png")], check=True)
    rows = []
    for model in ("nscd-rigid", "ls-dem"):
        run = folder / f"{model}.nc"
        files = ["--structure", str(structure), "--motion", str(motion), "--output", str(run)]
        subprocess.run([*BLOCKSHAKE, "simulate", "--model", model, *files], check=True)
        subprocess.run([*BLOCKSHAKE, "plot", str(run)], check=True)
        drift = 1e3 * top_drift(run)
        rows.append((model, np.abs(drift).max(), drift[-1]))
    heads = ["model", "peak drift of the top [mm]", "at the end [mm]"]
    print(pd.DataFrame(rows, columns=heads).to_string(index=False, float_format="%.1f"))


if __name__ == "__main__":
    example(Path(sys.argv[1] if len(sys.argv) > 1 else "own-wall"))
