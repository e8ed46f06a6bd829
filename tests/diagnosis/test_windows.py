"""Windows restarted from the known states of a simulated run say what that run did."""

from dataclasses import dataclass

import numpy as np
import pytest

from blockshake.diagnosis.smoothed_state import SmoothedStates
from blockshake.diagnosis.windows import N_END, simulate_window, window_model
from blockshake.dynamics.load_motion import load_motion
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import load_structure
from blockshake.measurement.base_motion import BaseMotion
from blockshake.measurement.joint_coordinates import joint_coordinates
from blockshake.study.simulation import simulate

DURATION, N_STEPS = 5.5, 40
RUNS = {
    "ls-dem": ({}, 5e-5),
    "nscd-rigid": ({"nscd.impact_parts": 20}, 5e-4),
}
STOP = {
    "name": "stopper-contact",
    "values": {"stiffness": 2e7, "gap": 0.004},
    "place": {"body": "block-2", "axis": "+x"},
}
HEAVY = {"name": "eccentricity", "values": {"offset": 0.06}, "place": {"body": "block-1"}}


@dataclass
class Known:
    """A run, its states against the base, and its base motion without error."""

    structure: object
    run: object
    states: SmoothedStates
    base: BaseMotion


def _known(source, solver, effects=()):
    motion = load_motion("alkion", 2.5)
    time = np.arange(round(DURATION * 200) + 1) / 200.0
    base = BaseMotion(
        time,
        *(motion.evaluate(time, order)[:, 0] for order in range(3)),
        np.zeros(len(time)),
        np.zeros(len(time)),
        np.nan,
    )
    parameters, step = RUNS[solver]
    model = window_model(solver, source, base, parameters, step, effects)
    given = {
        f"bodies.{body.name}.mass_offset": list(body.mass_offset) for body in model.structure.file.bodies[1:]
    }
    given["stoppers"] = [stop.model_dump() for stop in model.structure.file.stoppers]
    run = simulate(
        source,
        model.motion,
        solver,
        given | parameters,
        time_step=step,
        duration=DURATION,
        accelerometers=False,
    )
    structure = load_structure(source)
    offset = structure.mass_offset - model.structure.mass_offset
    rotation = rotation_matrices(run["orientation"].to_numpy())
    lever = np.einsum("tbij,bj->tbi", rotation, offset)
    spin = run["angular_velocity"].to_numpy()
    position = run["position"].to_numpy() + lever
    velocity = run["velocity"].to_numpy() + np.cross(spin, lever)
    moved, rate = np.zeros((len(time), 3, 6)), np.zeros((len(time), 3, 6))
    moved[..., :3] = position - position[:, :1] - (structure.position - structure.position[0])
    for body in range(3):
        # the stack rocks about y alone: the skew part is the sine of its angle
        moved[:, body, 4] = np.arcsin(0.5 * (rotation[:, body, 0, 2] - rotation[:, body, 2, 0]))
    rate[..., :3], rate[..., 3:] = velocity - velocity[:, :1], spin
    nothing = np.zeros_like(moved)
    return Known(
        structure, (position, rotation), SmoothedStates(time, moved, rate, nothing, nothing, 0), base
    ), model


def _true_ends(known, place):
    position, rotation = known.run
    histories = joint_coordinates(known.structure, position, rotation)
    rows = slice(place + N_STEPS - N_END + 1, place + N_STEPS + 1)
    parts = histories["slip"].sel(tangent="x"), histories["rotation"].sel(axis="y")
    return np.concatenate([part.to_numpy()[rows].mean(axis=0) for part in parts])


def _errors(known, model, places):
    return np.array(
        [
            simulate_window(model, known.structure, known.states, place, N_STEPS)[:4]
            - _true_ends(known, place)
            for place in places
        ]
    )


@pytest.mark.parametrize("solver", RUNS)
def test_a_window_goes_on_as_the_run_did(two_blocks, solver):
    known, model = _known(two_blocks, solver)
    places = np.arange(300, 1060, 40)
    moved = np.array([_true_ends(known, place)[2] for place in places])
    assert np.abs(moved).max() > 3e-3
    errors = _errors(known, model, places)
    # what a window gets wrong is small beside what moves: contacts start without their history
    assert np.sqrt(np.mean(errors[:, 2] ** 2)) < 0.03 * np.sqrt(np.mean(moved**2))
    assert np.abs(errors[:, :2]).max() < 3e-4


@pytest.mark.parametrize("effect", [STOP, HEAVY])
def test_effects_act_in_a_window_as_they_do_in_the_whole_test(two_blocks, effect):
    known, model = _known(two_blocks, "nscd-rigid", [effect])
    _, without = _known(two_blocks, "nscd-rigid")
    places = np.arange(300, 1060, 20)
    errors = _errors(known, model, places)[:, 2]
    other = _errors(known, without, places)[:, 2]
    assert np.sqrt(np.mean(errors**2)) < 0.1 * np.sqrt(np.mean(other**2))


def test_a_base_that_pitches_carries_its_blocks_along(two_blocks):
    pitch = {"name": "table-pitch", "values": {"coefficient": 1e-4, "frequency": 15.0}, "place": {}}
    known, model = _known(two_blocks, "nscd-rigid")
    _, pitching = _known(two_blocks, "nscd-rigid", [pitch])
    place = 200
    ends = simulate_window(pitching, known.structure, known.states, place, N_STEPS)
    rows = known.states.time[place + N_STEPS - N_END + 1 : place + N_STEPS + 1]
    expected = pitching.motion.evaluate(rows)[:, 3].mean()
    assert abs(expected) > 1e-6
    assert ends[4] == pytest.approx(expected, rel=1e-9)
    # blocks stood on it before and stand on it still
    np.testing.assert_allclose(ends[:4], 0.0, atol=2e-5)
    assert simulate_window(model, known.structure, known.states, place, N_STEPS)[4] == 0.0
