"""Contacts that appear and vanish: a fall, a collision of two walls, a collapse, a heap."""

import numpy as np

from blockshake.dynamics.motion import ground_motion

G = 9.81
SHAPES = {"block": {"box": [0.8, 2.4, 1.6], "chamfer": 0.02}, "brick": {"box": [0.4, 0.3, 0.2]}}


def tower(name, x, n, **top):
    bodies = [{"name": f"{name}{i}", "shape": "block", "position": [x, 0, 0.8 + 1.6 * i]} for i in range(n)]
    bodies[-1] |= top
    return bodies


def balance(run):
    return run.energy[:, :3].sum(axis=1) + run.energy[:, 3:6].sum(axis=1) - run.energy[:, 6]


def test_a_falling_block_touches_only_while_it_is_there(scene, simulate):
    # slides off a table 0.5 m high and falls on the floor: Coulomb's and Galilei's times; it starts 0.2 mm up, as
    # what stood on something and sinks has collapsed
    table = {"name": "table", "shape": "table", "position": [0, 0, 0.25], "driven": True}
    brick = {"name": "brick", "shape": "brick", "position": [0.3, 0, 0.6002], "velocity": [2.0, 0, 0]}
    shapes = {**SHAPES, "table": {"box": [1.0, 1.0, 0.5]}}
    run = simulate(scene(shapes, [table, brick], friction=0.2), 1.0, output_step=1e-3)
    assert run.status == "completed"
    pairs = run.joints.tolist()
    assert sorted(pairs) == [[0, 2], [1, 2]]
    carried = np.abs(run.joint_force).max(axis=2) > 0.0
    on_table, on_floor = carried[:, pairs.index([1, 2])], carried[:, pairs.index([0, 2])]
    left, landed = run.time[on_table][-1], run.time[on_floor][0]
    assert not on_floor[run.time <= left].any()
    # the centre passes the edge after 0.2 m at 2 m/s, and then it tips and falls; flat it would take 0.32 s
    assert 0.1 < left < 0.3
    assert 0.15 < landed - left < 0.35
    # it lands turning at some 10 rad/s: the levers of a step miss w^2 r dt^2 / 2 of a gap
    assert abs(run.position[-1, 2, 2] - 0.1) < 2e-5
    assert np.abs(balance(run) - balance(run)[0]).max() < 1e-3 * run.energy[0, 0]


def test_two_walls_collide(scene, simulate):
    # a tower of two slides across a gap of 0.1 m into another; flush faces, so that neither turns
    friction, speed, gap = 0.1, 1.5, 0.1
    bodies = tower("l", -0.4 - gap / 2, 2) + tower("r", 0.4 + gap / 2, 2)
    for body in bodies[:2]:
        body["velocity"] = [speed, 0.0, 0.0]
    structure = scene(SHAPES, bodies, friction=friction)
    run = simulate(structure, 1.2, output_step=1e-3)
    assert run.status == "completed"
    # Coulomb until they meet; restitution 0, so both then have half of the speed that is left
    at_impact = np.sqrt(speed**2 - 2.0 * friction * G * gap)
    meeting = (speed - at_impact) / (friction * G)
    after = np.searchsorted(run.time, meeting + 0.004)
    np.testing.assert_allclose(
        run.velocity[after, 1:, 0], 0.5 * at_impact - friction * G * (run.time[after] - meeting), atol=2e-3
    )
    level = [run.joints.tolist().index(pair) for pair in ([1, 3], [2, 4])]
    assert (run.joint_force[run.time < meeting - 2e-3][:, level] == 0.0).all()
    # the force of the step in which they meet is all of the impulse
    impulse = run.joint_force[:, level, 0].sum() * 1e-3
    assert abs(impulse - 2.0 * structure.mass[1] * 0.5 * at_impact) < 0.01 * impulse
    # both slide on, and stop without a force between them
    stop = (0.5 * at_impact) ** 2 / (2.0 * friction * G)
    np.testing.assert_allclose(run.position[-1, [3, 4], 0] - run.position[0, [3, 4], 0], stop, rtol=5e-3)
    np.testing.assert_allclose(run.velocity[-1, 1:], 0.0, atol=1e-6)
    assert (run.position[:, [3, 4], 0] - run.position[:, [1, 2], 0]).min() > 0.8 - 1e-6
    assert run.numerics["fraction_unconverged"] == 0.0


def test_a_tower_shaken_hard_collapses(scene, simulate):
    time = np.linspace(0.0, 4.0, 801)
    motion = ground_motion("sine", time, {"x": 9.0 * np.sin(5.0 * time)}, "acceleration")
    run = simulate(scene(SHAPES, tower("t", 0.0, 4), friction=0.6), 4.0, motion=motion)
    assert run.status == "collapsed"
    done = np.isfinite(run.position[:, 1, 0])
    energy = balance(run)[done]
    assert np.abs(energy - energy[0]).max() < 2e-3 * np.abs(run.energy[done][:, 6]).max()


def test_a_heap_of_bricks_comes_to_rest(scene, simulate):
    """Twelve bricks dropped anyhow: corners, edges and faces meet, and all end in a heap that carries itself."""
    rng = np.random.default_rng(4)
    bodies = []
    for index in range(12):
        q = rng.normal(size=4)
        bodies.append(
            {
                "name": f"b{index}", "shape": "brick", "orientation": (q / np.linalg.norm(q)).tolist(),
                "position": [*rng.uniform(-0.2, 0.2, 2), 0.5 + 0.55 * index],
            }
        )  # fmt: skip
    structure = scene(SHAPES, bodies, friction=0.6)
    run = simulate(structure, 5.0)
    assert run.numerics["fraction_unconverged"] < 0.01
    weight = structure.mass[1:].sum() * G
    on_floor = (run.joints == 0).any(axis=1)
    # sliding hardly stops in a heap; its last motion is less than what a step of gravity gives
    assert np.abs(run.velocity[-1, 1:]).max() < G * 1e-3
    np.testing.assert_allclose(run.joint_force[-1, on_floor, 2].sum(), weight, rtol=1e-2)
    # a pair has one common plane: where it turns from one step to the next, a corner is met up to a step late,
    # v dt for the 11 m/s of the last brick; penetration is not pushed out
    assert run.numerics["max_penetration"] < np.sqrt(2.0 * G * 6.5) * 1e-3
