"""Campaigns of measured drops and tosses from the files of their authors, for `blockshake diagnose`.

    python examples/measured_flights.py square-drops FOLDER CAMPAIGN [SEED]
    python examples/measured_flights.py cube-tosses FOLDER CAMPAIGN [SEED]

FOLDER holds the published arrays: ``square_drops.npz`` (Fazeli and others, drops of a square between guides), or
``cube_tosses.npz`` and ``experiment.json`` (Pfrommer, Halm and Posa 2020). One half of the tests, drawn by the seed, is
open, the other is sealed.
"""

import json
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import yaml

GROUND = {
    "name": "ground",
    "shape": "ground",
    "material": "body",
    "position": [0.0, 0.0, -0.1],
    "driven": True,
}
FAR = 20.0  # m, width of the ground


def square_drops(folder):
    """Tables of all drops by name, and what fell: the angle of the file is positive about -y."""
    with np.load(folder / "square_drops.npz") as file:
        numbers, rate, drops = file["number"], float(file["rate"]), file["drops"]
    tests = {}
    for number, rows in zip(numbers, drops, strict=True):
        tests[f"drop-{number}"] = pd.DataFrame(
            {"time_s": np.arange(len(rows)) / rate, "square.x": rows[:, 0], "square.z": rows[:, 1]}
        ).assign(**{"square.angle_y": -rows[:, 2]})
    # neither mass nor depth was published: a damping goes with the mass, the rate of a drag does not
    return tests, structure("square", [0.06, 0.06, 0.06], 1200.0)


def cube_tosses(folder):
    """Tables of all tosses by name, and what was thrown; lengths of the file are in half-widths."""
    about = json.loads((folder / "experiment.json").read_text())
    half = 9.81 / about["g"]
    tests = {}
    with np.load(folder / "cube_tosses.npz") as file:
        for name in sorted(file):
            rows = file[name].astype(float)
            names = ["cube.x", "cube.y", "cube.z", "cube.qw", "cube.qx", "cube.qy", "cube.qz"]
            table = pd.DataFrame(rows[:, :7] * ([half] * 3 + [1.0] * 4), columns=names)
            table.insert(0, "time_s", np.arange(len(rows)) * about["dt"])
            tests[name] = table
    side = 2.0 * half
    return tests, structure("cube", [side] * 3, about["mass"] / side**3)


def structure(name, size, density):
    """Structure file of one box over a wide ground; friction and restitution are what nobody measured yet."""
    return {
        "name": name,
        "materials": {"body": {"density": density, "youngs_modulus": 3.0e9, "poisson_ratio": 0.37}},
        "shapes": {"ground": {"box": [FAR, FAR, 0.2]}, name: {"box": size}},
        "bodies": [GROUND, {"name": name, "shape": name, "material": "body", "position": [0.0, 0.0, 1.0]}],
        "friction": [{"pair": ["body", "body"], "coefficient": 0.3}],
    }


def write(tests, described, folder, seed):
    """Write the campaign: a table a test, half of them sealed."""
    folder.mkdir(parents=True)
    sealed = set(np.random.default_rng(seed).permutation(sorted(tests))[: len(tests) // 2])
    for name, table in tests.items():
        table.to_csv(folder / f"{name}.csv", index=False)
    (folder / "structure.yaml").write_text(yaml.safe_dump(described, sort_keys=False))
    listed = [
        {"name": name, "file": f"{name}.csv", "role": "sealed" if name in sealed else "fit"} for name in tests
    ]
    campaign = {"name": f"{described['name']}, seed {seed}", "structure": "structure.yaml", "tests": listed}
    (folder / "campaign.yaml").write_text(yaml.safe_dump(campaign, sort_keys=False))


if __name__ == "__main__":
    kind, source, target, *seed = sys.argv[1:]
    read = {"square-drops": square_drops, "cube-tosses": cube_tosses}[kind]
    write(*read(Path(source)), Path(target), int(seed[0]) if seed else 1)
