"""Campaigns of scanned rocks that fell or stood on a shake table, for `blockshake diagnose`.

    python examples/measured_rocks.py SP1|SP2 FOLDER CAMPAIGN [SEED]

FOLDER holds the published files: the scans ``SP1.ply`` and ``SP2.ply`` with z up, ``tests.csv`` and
``table_motions_200Hz.npz`` (acceleration [g], counted against the displacement, and displacement [m]). One half of the
ground motions, drawn by the seed, is open with all its tests, the other is sealed.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd
import trimesh
import yaml

G = 9.80665  # m/s2
MASS = 353.0  # kg, of either rock as weighed
RATE = 200.0  # Hz
CROSSOVER = 1.0  # Hz, below which the displacement states more than the accelerometer
MOVES, AROUND = 0.2, 2.0  # m/s2 at which a motion begins and ends to count, and s before and after


def rock(path):
    """Convex hull in its resting pose, about its centroid, and the mass centre of the scan seen from there [m]."""
    scan = trimesh.load(path)
    hull = trimesh.convex.convex_hull(scan.vertices)
    parts = scan.split(only_watertight=True) if hasattr(scan, "faces") else []
    centre = max(parts, key=lambda part: abs(part.volume)).center_mass if len(parts) else hull.center_mass
    # the rock rests on the lowest facet that its mass centre stands above
    feet = [facet for facet in np.flatnonzero(hull.face_normals[:, 2] < -0.9) if _above(hull, facet, centre)]
    foot = min(feet, key=lambda facet: np.dot(hull.triangles[facet][0] - centre, hull.face_normals[facet]))
    turn = trimesh.geometry.align_vectors(hull.face_normals[foot], [0.0, 0.0, -1.0])[:3, :3]
    vertices = (hull.vertices - hull.center_mass) @ turn.T
    return trimesh.Trimesh(vertices, hull.faces), turn @ (centre - hull.center_mass)


def _above(hull, facet, centre):
    normal, corners = hull.face_normals[facet], hull.triangles[facet]
    below = centre + np.dot(corners[0] - centre, normal) * normal
    return bool((trimesh.triangles.points_to_barycentric(corners[None], below[None]) > 0.0).all())


def table_acceleration(acceleration, displacement):
    """Acceleration of the table [m/s2]: of the displacement below the crossover, of the accelerometer above it."""
    pad, count = int(10.0 * RATE), len(displacement)
    moved = displacement - displacement[:40].mean()
    back = 0.5 * moved[-40:].mean() * (1.0 + np.cos(np.pi * np.arange(pad) / pad))
    moved = np.concatenate([np.zeros(pad), moved, back])
    read = np.pad(-G * (acceleration - acceleration[:40].mean()), pad)
    frequency = np.fft.rfftfreq(len(moved), 1.0 / RATE)
    share = (frequency / CROSSOVER) ** 4 / (1.0 + (frequency / CROSSOVER) ** 4)
    slow = -((2.0 * np.pi * frequency) ** 2) * np.fft.rfft(moved)
    return np.fft.irfft(share * np.fft.rfft(read) + (1.0 - share) * slow, len(moved))[pad : pad + count]


def strong_part(acceleration):
    """Rows from 2 s before the first to 2 s after the last of at least 0.2 m/s2; all where none is."""
    strong = np.flatnonzero(np.abs(acceleration) > MOVES)
    if not len(strong):
        return acceleration
    rows = int(AROUND * RATE)
    return acceleration[max(strong[0] - rows, 0) : strong[-1] + rows]


def structure(name, mesh, centre):
    """Structure file of a rock on a wide table; friction and restitution are what nobody measured yet."""
    return {
        "name": name,
        "materials": {
            "granite": {"density": float(MASS / mesh.volume), "youngs_modulus": 5.0e10, "poisson_ratio": 0.25},
            "table": {"density": 7800.0, "youngs_modulus": 2.0e11, "poisson_ratio": 0.3},
        },
        "shapes": {"table": {"box": [4.0, 4.0, 0.2]}, "rock": {"mesh": f"{name}.stl"}},
        "bodies": [
            {"name": "table", "shape": "table", "material": "table", "position": [0.0, 0.0, -0.1], "driven": True},
            {
                "name": "rock", "shape": "rock", "material": "granite",
                "position": [0.0, 0.0, float(-mesh.vertices[:, 2].min())], "mass_offset": centre.tolist(),
            },
        ],
        "friction": [{"pair": ["granite", "table"], "coefficient": 0.6}],
    }  # fmt: skip


def main(name, source, folder, seed):
    """Write the campaign."""
    mesh, centre = rock(source / f"{name}.ply")
    (folder / "motions").mkdir(parents=True)
    mesh.export(folder / f"{name}.stl")
    (folder / "structure.yaml").write_text(yaml.safe_dump(structure(name, mesh, centre), sort_keys=False))
    tests = pd.read_csv(source / "tests.csv")
    tests = tests[tests.has_motion == 1].sort_values("test")
    records = sorted(tests.ground_motion.unique())
    sealed = set(np.random.default_rng(seed).permutation(records)[: len(records) // 2])
    listed = []
    with np.load(source / "table_motions_200Hz.npz") as motions:
        for row in tests.itertuples():
            moved = strong_part(table_acceleration(*motions[f"T{row.test:03d}"]))
            table = pd.DataFrame({"time_s": np.arange(len(moved)) / RATE, "acceleration_x": moved})
            table.to_csv(folder / "motions" / f"{row.test}.csv", index=False, float_format="%.6g")
            listed.append({
                "name": f"test-{row.test}", "motion": f"motions/{row.test}.csv", "scale": 1.0,
                "role": "sealed" if row.ground_motion in sealed else "fit",
                "outcome": "fell" if getattr(row, f"overturned_{name.lower()}") else "stood",
            })  # fmt: skip
    pd.DataFrame(listed).to_csv(folder / "tests.csv", index=False)
    campaign = {"name": f"{name}, seed {seed}", "structure": "structure.yaml", "tests": "tests.csv"}
    (folder / "campaign.yaml").write_text(yaml.safe_dump(campaign, sort_keys=False))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 1)
