import numpy as np
import pytest

from blockshake.dynamics.motion import ground_motion

G = 9.81
K = 1.0e6  # N/m
GAP = 0.01  # m
SQUAT = {"squat": {"box": [1.0, 1.0, 0.5]}, "slab": {"box": [8.0, 3.0, 0.2]}}
MASS = 0.5 * 2400.0
STEP = 5e-5


def _stopper(axis="+x", position=(0.5, 0.0, -0.25), gap=GAP):
    return {"body": "b", "position": list(position), "axis": axis, "gap": gap, "stiffness": K}


@pytest.mark.parametrize(("axis", "sign"), [("+x", 1.0), ("-x", -1.0)])
def test_a_block_pushed_against_a_stopper_swings_about_the_static_deflection(
    axis, sign, make_structure, run_ls_dem
):
    """A constant pull of g/10 on a frictionless block: gap + f/k is the middle of a harmonic motion."""
    pull = 0.1 * G
    structure = make_structure(
        [{"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}],
        friction=0.0, gravity=[sign * pull, 0.0, -G], shapes=SQUAT, stoppers=[_stopper(axis, (0.0, 0.0, 0.0))],
    )  # fmt: skip
    run = run_ls_dem(structure, 0.6, rate=1000)
    moved = sign * (run.position[:, 1, 0] - structure.position[1, 0])
    # m g/10 (GAP + d) = k d^2 / 2 at the turning point
    static = MASS * pull / K
    turn = static + np.sqrt(static**2 + 2.0 * static * GAP)
    # read every 1 ms: off the turn by half of it at most, pull/2 (0.5 ms)^2 times the ratio of forces
    assert moved.max() == pytest.approx(GAP + turn, abs=2e-6)
    balance = run.energy[:, :3].sum(axis=1) + run.energy[:, 3:6].sum(axis=1) - run.energy[:, 6]
    in_play = MASS * pull * moved.max()
    # velocity Verlet: (omega dt)^2 / 8 of the energy for omega = sqrt(k / m), twice the stopper's onset
    assert np.ptp(balance) < (STEP**2 * K / MASS) * in_play + 1e-5
    assert run.energy[:, 2].max() == pytest.approx(
        run.energy[0, 2] + 0.5 * K * turn**2, abs=1e-3 * 0.5 * K * turn**2
    )


def test_a_stopper_within_its_gap_does_nothing(make_structure, run_ls_dem):
    bodies = [{"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25], "velocity": [0.02, 0.0, 0.0]}]
    with_stop = run_ls_dem(make_structure(bodies, friction=0.0, shapes=SQUAT, stoppers=[_stopper()]), 0.4)
    without = run_ls_dem(make_structure(bodies, friction=0.0, shapes=SQUAT), 0.4)
    np.testing.assert_array_equal(with_stop.position, without.position)


def test_a_stopper_travels_with_the_driven_body(make_structure, run_ls_dem):
    """Smooth slab moving at V takes the block along through the stop: an elastic stop throws it at 2 V."""
    speed = 0.1
    time = np.linspace(0.0, 1.0, 11)
    motion = ground_motion("v", time, {"x": np.full(11, speed)}, "velocity")
    structure = make_structure(
        [{"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}],
        friction=0.0, shapes=SQUAT, stoppers=[_stopper("-x", (0.0, 0.0, 0.0))],
    )  # fmt: skip
    run = run_ls_dem(structure, 0.4, motion=motion)
    assert run.velocity[-1, 1, 0] == pytest.approx(2.0 * speed, rel=1e-5)
    # the slab's work is the block's energy: Newton's third law on the driven body
    assert run.energy[-1, 6] == pytest.approx(0.5 * MASS * (2.0 * speed) ** 2, rel=1e-4)


def test_a_stopper_turns_with_the_driven_body(make_structure, run_ls_dem):
    """A stop is fixed to the driven body: a slow pitch of the whole closes none high up (docs/guide/contracts.md)."""
    time = np.linspace(0.0, 1.0, 201)
    pitch = 0.02 * np.sin(np.pi * time) ** 2
    motion = ground_motion("p", time, {"pitch_y": pitch}, "displacement")
    stops = [_stopper(axis, (x, 0.0, 0.25), gap=1e-3) for axis, x in (("+x", 0.5), ("-x", -0.5))]
    structure = make_structure(
        [{"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}],
        friction=0.9,
        shapes=SQUAT,
        stoppers=stops,
    )
    free = make_structure(
        [{"name": "b", "shape": "squat", "position": [0.0, 0.0, 0.25]}], friction=0.9, shapes=SQUAT
    )
    run = run_ls_dem(structure, 1.0, motion=motion)
    # the block's top moves by 0.6 m * 0.02 = 12 mm, twelve gaps
    assert np.ptp(run.position[:, 1, 0]) > 5e-3
    np.testing.assert_array_equal(run.position, run_ls_dem(free, 1.0, motion=motion).position)
