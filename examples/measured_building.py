"""Campaign of a base-isolated building on a shake table, for `blockshake diagnose`.

    python examples/measured_building.py FOLDER CAMPAIGN

FOLDER holds the published readings as ``isolated_building.npz``: accelerations of the table and of six floors [m/s2],
and their displacements [m], those of the floors relative to the table, along one horizontal axis. Bearings, masses and
sizes were not published. The building is described as one stiff body that stands on a slippery slab, and the mean of
its floors is taken as the motion of that body, which neither turns nor lifts: nothing here describes the bearings.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import yaml

ROLES = {"ICA50": "fit", "ICA100": "fit", "SP100": "select", "ICA140": "sealed"}
MOVES, BEFORE, LENGTH = 0.2, 2.0, 50.0  # m/s2 at which a motion begins to count; s before it, and s in all
STRUCTURE = {  # size, density and friction of the building are guesses
    "name": "building",
    "materials": {
        "table": {"density": 7800.0, "youngs_modulus": 2.0e11, "poisson_ratio": 0.3},
        "building": {"density": 300.0, "youngs_modulus": 3.0e10, "poisson_ratio": 0.2},
    },
    "shapes": {"table": {"box": [20.0, 20.0, 0.5]}, "building": {"box": [10.0, 10.0, 16.0]}},
    "bodies": [
        {"name": "table", "shape": "table", "material": "table", "position": [0.0, 0.0, -0.25], "driven": True},
        {"name": "building", "shape": "building", "material": "building", "position": [0.0, 0.0, 8.0]},
    ],
    "friction": [{"pair": ["table", "building"], "coefficient": 0.05}],
    "markers": [
        {"name": "table-face", "body": "table", "position": [9.0, 0.0, 0.25]},
        {"name": "low", "body": "building", "position": [5.0, 0.0, -6.0]},
        {"name": "high", "body": "building", "position": [5.0, 0.0, 6.0]},
    ],
    "accelerometers": [
        {"name": "table-acc", "body": "table", "position": [9.0, 0.0, 0.25], "axes": ["x"]},
        {"name": "building-acc", "body": "building", "position": [0.0, 0.0, 0.0], "axes": ["x"]},
    ],
}  # fmt: skip


def write_test(name, readings, folder):
    """Write the table of readings of a test, and its table's acceleration as the motion."""
    rate = float(readings["rate"])
    acceleration, displacement = readings[f"{name}_table"].astype(float)
    start = int(np.argmax(np.abs(acceleration) > MOVES) - BEFORE * rate)
    rows = slice(start, start + int(LENGTH * rate) + 1)
    times = np.arange(rows.stop - rows.start) / rate
    drift = readings[f"{name}_displacement"].astype(float).mean(axis=0)
    table, building = displacement[rows], (displacement + drift)[rows]
    optical = {f"{marker}.{axis}": 0.0 for marker in ("table-face", "low", "high") for axis in "xyz"}
    optical["table-face.x"] = table - table[0]
    optical["low.x"] = optical["high.x"] = building - building[0]
    pd.DataFrame({"time_s": times} | optical).to_csv(folder / f"{name}.csv", index=False, float_format="%.9g")
    floors = readings[f"{name}_acceleration"].astype(float).mean(axis=0)
    channels = {"table-acc-x": acceleration[rows], "building-acc-x": floors[rows]}
    pd.DataFrame({"time_s": times} | channels).to_csv(
        folder / f"{name}-acc.csv", index=False, float_format="%.9g"
    )
    motion = pd.DataFrame({"time_s": times, "acceleration_x": acceleration[rows]})
    motion.to_csv(folder / f"{name}-motion.csv", index=False, float_format="%.9g")


def main(source, folder):
    """Write the campaign."""
    folder.mkdir(parents=True)
    with np.load(source / "isolated_building.npz") as readings:
        for name in ROLES:
            write_test(name, readings, folder)
    listed = [
        {"name": name, "file": f"{name}.csv", "motion": f"{name}-motion.csv", "scale": 1.0, "role": role}
        for name, role in ROLES.items()
    ]
    campaign = {
        "name": "isolated building",
        "structure": "structure.yaml",
        "sensors": {"marker_noise": 1.0e-4, "accelerometer_noise": 0.02},
        "tests": listed,
    }
    (folder / "structure.yaml").write_text(yaml.safe_dump(STRUCTURE, sort_keys=False))
    (folder / "campaign.yaml").write_text(yaml.safe_dump(campaign, sort_keys=False))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
