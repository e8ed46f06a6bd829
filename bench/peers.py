"""Other people's programs, in an environment of their own that ``make peers`` makes: found, requested and read.

A peer runs in its own process under its own Python, which knows nothing of blockshake: it is handed a
JSON file and writes an npz file.
"""

import json
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from blockshake.geometry.rotations import rotation_matrices

PYTHON = Path(__file__).parents[1] / ".venv-peers" / "bin" / "python"
LMGC90, MUJOCO = "compas_lmgc90", "mujoco"  # packages
PROGRAMS = {LMGC90: "lmgc90_blocks.py", MUJOCO: "mujoco_blocks.py"}
MISSING = "there is no {} in the environment of the peers: `make peers` sets it up"
GRAVITY = (0.0, 0.0, -9.81)  # m/s2, fixed in the wheel of LMGC90


def peer_version(peer):
    """Version of a peer's package; None where the environment or the package is missing."""
    if not PYTHON.exists():
        return None
    asked = f"from importlib.metadata import version; import {peer}; print(version('{peer}'))"
    answer = subprocess.run([PYTHON, "-c", asked], capture_output=True, text=True)
    return answer.stdout.strip() if answer.returncode == 0 else None


def block_task(structure, motion, time_step, steps, **options):
    """Description of a structure under a motion, as a peer needs it.

    Parameters
    ----------
    structure : Structure
        Starts at rest, with one coefficient of friction for all pairs, under `GRAVITY`.
    motion : GroundMotion or None
        Translations of the driven bodies.
    time_step : float
        [s]
    steps : int
    **options
        ``record_every`` steps a pose is kept (0: none); ``contact_steps``: steps whose contacts are
        kept; ``timed_from``: step from which CPU time counts; and what else a peer's program understands.
    """
    frictions = np.unique(structure.friction[~np.isnan(structure.friction)])
    if len(frictions) != 1:
        raise ValueError(f"{structure.source}: a peer knows one coefficient of friction, not {frictions}")
    if (
        tuple(structure.file.gravity) != GRAVITY
        or structure.velocity.any()
        or structure.angular_velocity.any()
    ):
        raise ValueError(f"{structure.source}: a peer starts from rest under {GRAVITY} m/s2")
    if structure.mass_offset.any():
        raise ValueError(f"{structure.source}: a peer has every mass centre in the middle")
    file = structure.file
    times = time_step * np.arange(steps + 2)
    velocity, acceleration = (
        np.zeros((len(times), 3)) if motion is None else motion.evaluate(times, derivative=order)[:, :3]
        for order in (1, 2)
    )
    return {
        "shapes": {
            name: {
                "vertices": solid.vertices.tolist(),
                "triangles": solid.triangles.tolist(),
                "box": file.shapes[name].box,
            }
            for name, solid in structure.solids.items()
        },
        "bodies": [
            {
                "shape": body.shape,
                "driven": body.driven,
                "density": body.density or file.materials[body.material].density,
                "position": position.tolist(),
                "rotation": rotation.tolist(),
            }
            for body, position, rotation in zip(
                file.bodies, structure.position, rotation_matrices(structure.orientation), strict=True
            )
        ],
        "friction": float(frictions[0]),
        "time_step": time_step,
        "steps": steps,
        "velocity": velocity.tolist(),
        "acceleration": acceleration.tolist(),
        "record_every": 0,
        "contact_steps": [],
        "timed_from": 0,
        **options,
    }


def ask_peer(peer, task):
    """Run one task in a peer; its arrays by name, as the peer's program describes them."""
    program = Path(__file__).with_name(PROGRAMS[peer])
    one_thread = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryDirectory() as folder:
        asked, answer = Path(folder) / "task.json", Path(folder) / "answer.npz"
        asked.write_text(json.dumps(task))
        run = subprocess.run(
            [PYTHON, program, asked, answer], capture_output=True, text=True, env=one_thread, cwd=folder
        )
        if run.returncode != 0:
            raise RuntimeError(f"{peer} failed: {run.stdout[-500:]}{run.stderr[-500:]}")
        with np.load(answer) as arrays:
            return {name: arrays[name] for name in arrays.files}
