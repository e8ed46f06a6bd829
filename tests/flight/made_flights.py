"""Campaigns of a tossed box, simulated with something hidden in them and filmed as poses."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from blockshake.dynamics.motion import GroundMotion, rest_table
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import build_structure
from blockshake.simulation.simulate import simulate
from blockshake_flight.tracked_test import TrackedCampaign, TrackedTest

RATE = 200.0  # Hz
NOISE, TURN_NOISE = 5e-5, 1e-3  # m, rad
SIDE, DENSITY = 0.1, 600.0  # m, kg/m3
MASS = DENSITY * SIDE**3


def mapping(size=(SIDE, SIDE, SIDE), **changes):
    """Structure file of a box over a wide ground."""
    return {
        "name": "tossed box",
        "materials": {"wood": {"density": DENSITY, "youngs_modulus": 1e10, "poisson_ratio": 0.3}},
        "shapes": {"ground": {"box": [20.0, 20.0, 0.2]}, "box": {"box": list(size)}},
        "bodies": [
            {"name": "ground", "shape": "ground", "material": "wood", "position": [0.0, 0.0, -0.1], "driven": True},
            {"name": "box", "shape": "box", "material": "wood", "position": [0.0, 0.0, 1.0], **changes.pop("body", {})},
        ],
        "friction": [{"pair": ["wood", "wood"], "coefficient": 0.2}],
        "nscd_restitution": 0.4,
        **changes,
    }  # fmt: skip


def drag(damping):
    """External forces of a viscous drag [N s/m]."""
    return [{"body": "box", "axis": axis, "damping": damping} for axis in "xyz"]


def toss(number, hidden, duration=0.8):
    """A `TrackedTest` of a toss drawn by its number, with what is hidden in its structure file."""
    random = np.random.default_rng([7, number])
    quaternion = random.standard_normal(4)
    start = {
        "position": [0.0, 0.0, float(random.uniform(0.35, 0.6))],
        "velocity": [*random.uniform(-1.5, 1.5, 2).tolist(), float(random.uniform(0.0, 2.0))],
        "orientation": (quaternion / np.linalg.norm(quaternion)).tolist(),
        "angular_velocity": random.uniform(-6.0, 6.0, 3).tolist(),
    }
    given = mapping(**hidden)
    given["bodies"][1] |= start
    structure = build_structure(given, "made", Path())
    ground = GroundMotion("ground at rest", rest_table(), "displacement")
    run = simulate(structure, ground, "nscd-rigid", duration=duration, output_rate=RATE, accelerometers=False)
    rotation = rotation_matrices(run["orientation"].to_numpy()[:, 1])
    centroid = run["position"].to_numpy()[:, 1] - rotation @ structure.mass_offset[1]
    time = run["time"].to_numpy()
    noisy = centroid + NOISE * random.standard_normal(centroid.shape)
    return TrackedTest(f"toss-{number}", time, noisy, _turned(rotation, random), planar=False)


def _turned(rotation, random):
    small = TURN_NOISE * random.standard_normal((len(rotation), 3))
    x, y, z = small.T
    zero = np.zeros_like(x)
    skew = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    nearly = rotation + skew @ rotation
    left, _, right = np.linalg.svd(nearly)
    return left @ right


def campaign(numbers, hidden=(), scale=1.0, size=(SIDE, SIDE, SIDE)):
    """`TrackedCampaign` of some tosses, lengths read ``scale`` times too long, judged by a box with nothing hidden."""
    structure = build_structure(mapping(size), "made", Path())
    tests = [toss(number, {"size": size, **dict(hidden)}) for number in numbers]
    tests = [replace(test, position=scale * test.position) for test in tests]
    return TrackedCampaign(structure, tests, 1, structure.solids["box"].polyhedron.vertices, 0.0)
