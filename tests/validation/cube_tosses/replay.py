"""A measured toss once more, by either solver, through the program's own structure file."""

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from unittest import mock

import numpy as np
import yaml
from flight import RATE, initial_state
from tosses import GRAVITY

from blockshake.dynamics.motion import GroundMotion, MotionTable
from blockshake.geometry.rotations import rotation_matrices
from blockshake.simulation import simulate as simulation

# LS-DEM: an acrylic cube is nearer 3e10 N/m3 (E over its side); a tenth of it moves no figure of docs/results/tosses.md
# and allows a larger step. Nodes: three a side of each face, half a percent of it inside; none of the slab's within
# 1.5 m.
SETTINGS = {
    "ls-dem": (
        {
            "ls_dem.normal_stiffness": 2e9,
            "ls_dem.shear_stiffness": 1e9,
            "ls_dem.node_spacing": 10.0,
            "ls_dem.perimeter_inset": 0.005,
        },
        2e-5,
    ),
    "nscd-rigid": ({}, 1e-3),
}
RESTITUTION = {"ls-dem": "restitution", "nscd-rigid": "nscd_restitution"}


@dataclass(frozen=True)
class Cube:
    """Tossed body: ``side`` and ``chamfer`` [m], ``mass`` [kg], and what a uniform body cannot have.

    ``mass_centre`` in the body frame, from the middle [m]; ``inertia`` about any axis through the mass
    centre [kg m2], None for that of the uniform box.
    """

    side: float
    mass: float
    chamfer: float = 0.0
    mass_centre: tuple = (0.0, 0.0, 0.0)
    inertia: float | None = None


@dataclass(frozen=True)
class Replay:
    """Simulated path: ``position`` of the cube's middle [m], ``orientation`` (w, x, y, z), ``rotation``; its end."""

    position: np.ndarray
    orientation: np.ndarray
    rotation: np.ndarray
    status: str
    reason: str
    energy_residual: float


def replay(toss, model, friction, restitution, cube, start=None, time_step=None, parameters=None):
    """Simulate a toss from its fitted start (or another) to its last reading.

    Parameters
    ----------
    toss : Toss
    model : str
        ``ls-dem`` or ``nscd-rigid``.
    friction, restitution : float
        Coulomb's coefficient; C_res or Newton's coefficient [1].
    cube : Cube
    start : InitialState, optional
        Of the mass centre.
    time_step : float, optional
        [s]; that of `SETTINGS` by default.
    parameters : dict, optional
        Numerical ones besides `SETTINGS`.

    Raises
    ------
    ValueError
        A mass centre beside the middle in LS-DEM, whose boxes have their nodes about the mass centre.
    """
    if model == "ls-dem" and any(cube.mass_centre):
        raise ValueError("LS-DEM knows no box whose mass centre is beside its middle")
    start = start or initial_state(toss, cube.mass_centre)
    usual, usual_step = SETTINGS[model]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "toss.yaml"
        path.write_text(yaml.safe_dump(structure_mapping(start, model, friction, restitution, cube)))
        with mock.patch.object(simulation, "load_structure", _loader(cube)):
            run = simulation.simulate(
                path,
                STILL,
                model,
                {**usual, **(parameters or {})},
                time_step or usual_step,
                duration=toss.time[-1],
                output_rate=RATE,
            )
    orientation = run["orientation"].values[:, 1]
    rotation = rotation_matrices(orientation)
    position = run["position"].values[:, 1] - rotation @ np.asarray(cube.mass_centre)
    return Replay(position, orientation, rotation, run.status, run.reason, run.energy_residual)


STILL = GroundMotion("still", MotionTable(np.array([0.0, 1.0]), np.zeros((1, 4, 4))), "displacement")


def structure_mapping(start, model, friction, restitution, cube):
    """Structure file of a slab that stays and the cube at its start."""
    shape = {"box": [cube.side] * 3, "chamfer": cube.chamfer}
    full, cut = cube.side**3, cube.chamfer
    volume = (
        full - 6.0 * cut**2 * cube.side + 8.0 * cut**3
    )  # twelve prisms cut**2 / 2 long, less the corners' overlap
    return {
        "name": "toss",
        "gravity": [0.0, 0.0, -GRAVITY],
        "materials": {
            "acrylic": {"density": cube.mass / volume, "youngs_modulus": 3e9, "poisson_ratio": 0.37}
        },
        "shapes": {"slab": {"box": [8.0, 8.0, 0.2]}, "cube": shape},
        "bodies": [
            # shifted, so that LS-DEM's nodes on the slab are far from the tosses
            {
                "name": "slab",
                "shape": "slab",
                "material": "acrylic",
                "position": [2.0, 2.0, -0.1],
                "driven": True,
            },
            {
                "name": "cube",
                "shape": "cube",
                "material": "acrylic",
                "position": start.position.tolist(),
                "orientation": start.orientation.tolist(),
                "velocity": start.velocity.tolist(),
                "angular_velocity": start.angular_velocity.tolist(),
            },
        ],
        "friction": [{"pair": ["acrylic", "acrylic"], "coefficient": friction}],
        RESTITUTION[model]: restitution,
    }


def _loader(cube):
    """`load_structure`, and after it the mass properties that no uniform body has."""
    load = simulation.load_structure

    def loaded(source, parameters):
        structure = load(source, parameters)
        if not any(cube.mass_centre) and cube.inertia is None:
            return structure
        inertia = structure.inertia.copy()
        if cube.inertia is not None:
            inertia[1] = cube.inertia * np.eye(3)
        solid, shift = structure.solids["cube"], np.asarray(cube.mass_centre)
        polyhedron = solid.polyhedron
        moved = replace(
            solid,
            vertices=solid.vertices - shift,
            polyhedron=replace(
                polyhedron,
                vertices=polyhedron.vertices - shift,
                offsets=polyhedron.offsets - polyhedron.normals @ shift,
            ),
        )
        return replace(structure, solids={**structure.solids, "cube": moved}, inertia=inertia)

    return loaded
