"""Three blocks on a slab with Yade's level sets, run by Yade itself: ``yade -n -x -j1 THIS TASK RESULT``.

TASK is a JSON text with the numbers of `compare_yade.TASK`, RESULT the JSON file to write. Classes
are those of Yade 2023.02a: one contact a pair, at the deepest node of the smaller body.
"""

import json
import math
import sys
import time

from yade import O
from yade.utils import levelSetBody
from yade.wrapper import (
    Bo1_LevelSet_Aabb,
    ForceResetter,
    FrictMat,
    HarmonicMotionEngine,
    Ig2_LevelSet_LevelSet_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_FrictMat_FrictMat_FrictPhys,
    Law2_ScGeom_FrictPhys_CundallStrack,
    MatchMaker,
    NewtonIntegrator,
)

# thick enough to be the larger body of each pair, so that it is a block's nodes that Yade tries
SLAB = (1.5, 1.5, 0.3)  # m, half edges
SETTLING_DAMPING = 0.4  # Cundall's local damping, only until the stack rests


def build(task, n_blocks, gravity):
    """New scene: a slab with its top at z = 0 and blocks face to face on it."""
    O.reset()
    O.dt = task["time_step"]
    O.materials.append(FrictMat(density=task["density"], frictionAngle=math.atan(task["friction"])))
    grid = {"spacing": task["grid_spacing"], "nSurfNodes": task["nodes"], "nodesPath": 2}
    O.bodies.append(levelSetBody("box", center=(0.0, 0.0, -SLAB[2]), extents=SLAB, dynamic=False, **grid))
    half = tuple(0.5 * edge for edge in task["block"])
    for rank in range(n_blocks):
        O.bodies.append(levelSetBody("box", center=home(task, rank), extents=half, **grid))
    stiffness = {name: MatchMaker(algo="val", val=task[name]) for name in ("kn", "ks")}
    shaking = HarmonicMotionEngine(
        A=(task["acceleration"] / (2.0 * math.pi * task["frequency"]) ** 2, 0.0, 0.0),
        f=(task["frequency"], 0.0, 0.0), fi=(0.0, 0.0, 0.0), ids=[0], dead=True,
    )  # fmt: skip
    newton = NewtonIntegrator(damping=0.0, gravity=(0.0, 0.0, -gravity))
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_LevelSet_Aabb()], verletDist=0),
        InteractionLoop(
            [Ig2_LevelSet_LevelSet_ScGeom()],
            [Ip2_FrictMat_FrictMat_FrictPhys(**stiffness)],
            [Law2_ScGeom_FrictPhys_CundallStrack(sphericalBodies=False)],
        ),
        shaking,
        newton,
    ]
    return newton, shaking


def home(task, rank):
    """Mass centre of a block face to face with what is below it."""
    return (0.0, 0.0, (rank + 0.5) * task["block"][2])


def settled(task):
    """The stack at rest on the resting slab, from then on without damping."""
    newton, shaking = build(task, 3, task["gravity"])
    newton.damping = SETTLING_DAMPING
    O.run(task["settling_steps"], True)
    newton.damping = 0.0
    for body in O.bodies:
        body.state.vel = body.state.angVel = (0.0, 0.0, 0.0)
    return shaking


def time_steps(task):
    """CPU time of a step of the shaken stack [us], and by the clock."""
    shaking = settled(task)
    # the engine's phase counts from the scene's start: the slab's motion begins from rest now
    shaking.fi = (-2.0 * math.pi * task["frequency"] * O.time, 0.0, 0.0)
    shaking.dead = False
    started, clock = time.process_time(), time.perf_counter()
    O.run(task["steps"], True)
    per_step = 1e6 / task["steps"]
    return {
        "cpu_us_per_step": per_step * (time.process_time() - started),
        "clock_us_per_step": per_step * (time.perf_counter() - clock),
        "contacts": sum(1 for contact in O.interactions if contact.isReal),
    }


def rest(task):
    """Sinking of the settled blocks [um]; how far they stray without damping: path [um], turn [rad]."""
    settled(task)
    blocks = [body for body in O.bodies if body.dynamic]
    start = [(tuple(body.state.pos), body.state.ori) for body in blocks]
    sinking = [1e6 * (home(task, rank)[2] - place[2]) for rank, (place, _) in enumerate(start)]
    path = turn = 0.0
    for _ in range(20):
        O.run(task["resting_steps"] // 20, True)
        for body, (place, orientation) in zip(blocks, start, strict=True):
            path = max(path, 1e6 * math.dist(body.state.pos, place))
            turn = max(turn, abs((orientation.inverse() * body.state.ori).toAxisAngle()[1]))
    return {"sinking_um": sinking, "strays_um": path, "turns_rad": turn}


def rebound(task):
    """Speed after over speed before the impact of a block's face on the slab, weightless."""
    build(task, 1, 0.0)
    block = O.bodies[1].state
    block.pos = (0.0, 0.0, home(task, 0)[2] + task["impact_gap"])
    block.vel = (0.0, 0.0, -task["impact_speed"])
    O.run(task["impact_steps"], True)
    return {"rebound": block.vel[2] / task["impact_speed"], "spin_rad_s": block.angVel.norm()}


if __name__ == "__main__":
    asked = json.loads(sys.argv[1])
    result = time_steps(asked)
    nodes = O.bodies[1].shape.surfNodes
    bottom = -0.5 * asked["block"][2]
    result["nodes"] = len(nodes)
    result["nodes_on_bed"] = sum(1 for node in nodes if abs(node[2] - bottom) < 1e-9)
    if asked["physics"]:
        result |= {"rest": rest(asked), "impact": rebound(asked)}
    with open(sys.argv[2], "w") as file:
        json.dump(result, file)
