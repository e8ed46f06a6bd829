"""Boxes on a shaken slab with MuJoCo, run by the peers' Python: ``python mujoco_blocks.py TASK RESULT``.

TASK is a JSON file of `peers.block_task` of boxes; ``solref`` and ``solimp``, if given, are MuJoCo's settings of the
soft contact, ``box_edges`` replaces the edges of a shape by name. RESULT is an npz file:

``time`` (n,) [s], ``position`` (n, n_bodies, 3) [m], ``rotation`` (n, n_bodies, 3, 3) body to world: the poses kept;
``cpu_us_per_step``; ``deepest`` [m]: largest penetration met; ``residual``: largest of the solver's own over the steps
kept.

The slab rests and gravity shakes, ``(-a(t), 0, g)``: the same mechanics in the slab's frame. Poses are turned back into
the inertial frame.
"""

import json
import sys
import time

import mujoco
import numpy as np

# As stiff as a step of 1 ms allows: the time constant of a contact is at least two steps
SOLREF = (2e-3, 1.0)
SOLIMP = (0.99, 0.9999, 1e-4, 0.5, 2.0)
ITERATIONS, TOLERANCE = 100, 1e-10


def build(task):
    """MuJoCo's model of a task."""
    solref, solimp = (
        " ".join(map(str, task.get(*pair))) for pair in (("solref", SOLREF), ("solimp", SOLIMP))
    )
    geometry = []
    for number, body in enumerate(task["bodies"]):
        shape = task["shapes"][body["shape"]]
        half = " ".join(str(0.5 * edge) for edge in shape["box"])
        geom = f'<geom type="box" size="{half}" density="{body["density"]}"/>'
        place = " ".join(map(str, body["position"]))
        joint = "" if body["driven"] else "<freejoint/>"
        geometry.append(f'<body name="{number}" pos="{place}">{joint}{geom}</body>')
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco>
        <option timestep="{task["time_step"]}" cone="elliptic" impratio="100" solver="Newton" integrator="Euler"
         iterations="{ITERATIONS}" tolerance="{TOLERANCE}" gravity="0 0 -9.81"/>
        <default><geom friction="{task["friction"]} 0 0" condim="3" solref="{solref}" solimp="{solimp}"/></default>
        <worldbody>{"".join(geometry)}</worldbody></mujoco>"""
    )


def main(task):
    """Run a task."""
    model = build(task)
    data = mujoco.MjData(model)
    shaking = -np.array(task["acceleration"])
    still = model.opt.gravity.copy()
    # the slab's place in the inertial frame, by the trapezium rule on its velocity
    velocity = np.array(task["velocity"])
    moved = np.zeros_like(velocity)
    moved[1:] = 0.5 * task["time_step"] * np.cumsum(velocity[1:] + velocity[:-1], axis=0)
    every = task["record_every"]
    kept, position, rotation, deepest, residual = [], [], [], 0.0, 0.0
    gravity = model.opt.gravity
    middle = 0.5 * (shaking[1:] + shaking[:-1]) + still
    mujoco.mj_forward(model, data)
    started = time.process_time()
    for step in range(1, task["steps"] + 1):
        if step == task["timed_from"] + 1:
            started = time.process_time()
        gravity[:] = middle[step - 1]
        mujoco.mj_step(model, data)
        if every and step % every == 0:
            kept.append(step * task["time_step"])
            mujoco.mj_kinematics(model, data)
            position.append(data.xpos[1:] + moved[step])
            rotation.append(data.xmat[1:].reshape(-1, 3, 3).copy())
            deepest = max([deepest, *(-contact.dist for contact in data.contact)])
            if data.solver_niter[0]:
                residual = max(residual, data.solver.gradient[data.solver_niter[0] - 1])
    seconds = time.process_time() - started
    cost = 1e6 * seconds / (task["steps"] - task["timed_from"])
    return {
        "cpu_us_per_step": cost, "time": kept, "position": position, "rotation": rotation, "deepest": deepest,
        "residual": residual,
    }  # fmt: skip


if __name__ == "__main__":
    with open(sys.argv[1]) as asked:
        answer = main(json.load(asked))
    np.savez(sys.argv[2], **{name: np.asarray(values) for name, values in answer.items()})
