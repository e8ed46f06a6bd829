"""Rigid blocks with LMGC90's core, run by the peers' Python: ``python lmgc90_blocks.py TASK RESULT``.

TASK is a JSON file of `peers.block_task`; ``alert`` [m], if given, is the distance within which contacts are
looked for. RESULT is an npz file:

``time`` (n,) [s], ``position`` (n, n_bodies, 3) [m], ``rotation`` (n, n_bodies, 3, 3) body to world: the poses kept.
``cpu_us_per_step``: with the wheel's own copying of each step's contacts. For each step K of ``contact_steps``,
``K_bodies`` (m, 2), ``K_point`` (m, 3) [m], ``K_basis`` (m, 3, 3) with rows normal and two tangents, ``K_force`` (m,
3) [N] and ``K_velocity`` (m, 3) [m/s] of the first body relative to the second along the basis, ``K_gap`` (m,) [m].

One process holds one simulation. Fixed in the wheel: gravity, one law of contact, Gauss-Seidel in rounds of 50 sweeps,
500 rounds at most, its tolerance of 1.666e-4 (its own norm) and relaxation, and the detection.
"""

import json
import sys
import time

import numpy as np
from compas_lmgc90._lmgc90 import LMGC90Solver

THETA = 0.5
ALERT = 1e-3  # m, the wheel's own default


def build(task):
    """The scene, and rotations that turn the wheel's inertial frames into ours."""
    bodies = task["bodies"]
    solver = LMGC90Solver()
    solver.initialize(task["time_step"], THETA, False)
    solver.add_one_tact_behav("iqsc0", "IQS_CLB", [task["friction"]])
    densities = sorted({body["density"] for body in bodies})
    solver.set_materials(densities)
    solver.set_see_tables(task.get("alert", ALERT))
    solver.set_nb_bodies(len(bodies))
    velocity = np.array(task["velocity"])
    times = task["time_step"] * np.arange(len(velocity))
    for number, body in enumerate(bodies, start=1):
        shape = task["shapes"][body["shape"]]
        vertices = np.array(shape["vertices"]) @ np.array(body["rotation"]).T
        material = f"s{densities.index(body['density']) + 1:04}"
        triangles = (np.array(shape["triangles"]) + 1).ravel().tolist()
        imposed = 6 if body["driven"] else 0
        solver.set_one_polyr(material, body["position"], triangles, vertices.ravel().tolist(), imposed, 0)
        for axis in range(imposed):
            if axis < 3:
                history = np.concatenate([times, velocity[:, axis]]).tolist()
                solver.set_drvdof(number, axis + 1, history, True, True)
            else:
                solver.set_drvdof(number, axis + 1, [0.0] * 6, True, False)
    solver.close_before_computing()
    start = solver.get_initial_state()
    frames = np.array(start.init_body_frames).reshape(-1, 3, 3)
    return solver, frames @ np.array([body["rotation"] for body in bodies])


def contacts(step):
    """Contacts of a step as the module describes them."""
    tangent, normal, other = (np.array(step.interaction_uc).reshape(-1, 3, 3)[:, row] for row in range(3))
    order = [1, 0, 2]  # the wheel counts tangent, normal, tangent
    return {
        "bodies": np.array(step.interaction_bodies).reshape(-1, 2) - 1,
        "point": np.array(step.interaction_coords).reshape(-1, 3),
        "basis": np.stack([normal, tangent, other], axis=1),
        "force": np.array(step.interaction_rloc).reshape(-1, 3)[:, order],
        "velocity": np.array(step.interaction_vloc).reshape(-1, 3)[:, order],
        "gap": np.array(step.interaction_gap),
    }


def main(task):
    """Run a task."""
    solver, to_body = build(task)
    keep, every = set(task["contact_steps"]), task["record_every"]
    kept, position, rotation, result = [], [], [], {}
    started = time.process_time()
    for step in range(1, task["steps"] + 1):
        if step == task["timed_from"] + 1:
            started = time.process_time()
        state = solver.compute_one_step()
        if every and step % every == 0:
            kept.append(step * task["time_step"])
            position.append(state.bodies)
            frames = np.array(state.body_frames).reshape(-1, 3, 3)
            rotation.append(frames.transpose(0, 2, 1) @ to_body)
        if step in keep:
            result |= {f"{step}_{name}": values for name, values in contacts(state).items()}
    seconds = time.process_time() - started
    result["cpu_us_per_step"] = 1e6 * seconds / (task["steps"] - task["timed_from"])
    return {**result, "time": kept, "position": position, "rotation": rotation}


if __name__ == "__main__":
    with open(sys.argv[1]) as asked:
        answer = main(json.load(asked))
    np.savez(sys.argv[2], **{name: np.asarray(values) for name, values in answer.items()})
