"""Limit states of a user's own: measures against made-up motions, outcomes that are not known, fragilities."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from blockshake.errors import InputError
from blockshake.files import write_dataset, write_text
from blockshake.geometry.rotations import rotation_matrices
from blockshake.geometry.structure import load_structure
from blockshake.statistics.intervals import share_interval
from blockshake.store import Store
from blockshake.study.ensembles.batch import CaseRuns, samples_of, simulate_samples
from blockshake.study.ensembles.case_input import driving_motions
from blockshake.study.ensembles.ensemble import sample_figures
from blockshake.study.limit_states.limit_states import limit_states_of_case
from blockshake.study.limit_states.measures import SeenRun, value_of
from blockshake.study.limit_states.response_table import response_table
from blockshake.study.limit_states.section import sentence
from blockshake.study.limit_states.settings import LimitState

HALF_WIDTH, HALF_HEIGHT = 0.2, 1.0  # m
BLOCK = {
    "name": "block",
    "materials": {"stone": {"density": 2400.0, "youngs_modulus": 3e10, "poisson_ratio": 0.2}},
    "shapes": {"slab": {"box": [4.0, 4.0, 0.4]}, "block": {"box": [2 * HALF_WIDTH, 0.6, 2 * HALF_HEIGHT]}},
    "bodies": [
        {"name": "slab", "shape": "slab", "material": "stone", "position": [0.0, 0.0, -0.2], "driven": True},
        {"name": "block", "shape": "block", "material": "stone", "on": "slab"},
        {"name": "other", "shape": "block", "material": "stone", "on": "slab", "offset": [1.0, 0.0, 0.0]},
    ],
    "friction": [{"pair": ["stone", "stone"], "coefficient": 2.0}],
    "markers": [
        {"name": "slab", "body": "slab", "position": [0.0, 0.0, 0.2]},
        {"name": "top", "body": "block", "position": [0.0, 0.0, 1.0]},
    ],
}
TIME = np.linspace(0.0, 1.0, 201)


@pytest.fixture
def structure():
    return load_structure(BLOCK)


def run_of(structure, angle=0.0, shift=0.0, whole=True):
    """The block turned about its corner at +x, and then shifted along x, over `TIME`; the slab swings along."""
    position = np.repeat(structure.position[None], len(TIME), axis=0)
    turns = np.repeat(rotation_matrices(structure.orientation)[None], len(TIME), axis=0)
    lean = np.broadcast_to(angle, TIME.shape)
    turns[:, 1] = Rotation.from_rotvec(np.outer(lean, [0.0, 1.0, 0.0])).as_matrix()
    corner = np.array([HALF_WIDTH, 0.0, -HALF_HEIGHT])
    position[:, 1] += (
        corner - turns[:, 1] @ corner + np.outer(np.broadcast_to(shift, TIME.shape), [1.0, 0.0, 0.0])
    )
    position += np.outer(0.3 * np.sin(9.0 * TIME), [1.0, 0.0, 0.0])[:, None]
    return SeenRun(structure, TIME, position, turns, whole)


def value(run, **state):
    return value_of(run, LimitState(**state))


def test_measures_of_a_rocking_block_are_those_of_its_geometry(structure):
    lean = 0.05
    run = run_of(structure, lean * np.sin(np.pi * TIME))
    assert value(run, body="block", tilt="5 deg") == pytest.approx(lean, rel=1e-9)
    # the lifted edge is a whole width away from the corner, the middle half of it
    assert value(run, body="block", opening=0.1) == pytest.approx(2 * HALF_WIDTH * np.sin(lean), rel=1e-9)
    assert value(run, joint=["block", "slab"], uplift=0.1) == pytest.approx(
        HALF_WIDTH * np.sin(lean), rel=1e-9
    )
    middle = HALF_HEIGHT * np.sin(lean) + HALF_WIDTH * (1.0 - np.cos(lean))
    assert value(run, body="block", drift=0.1) == pytest.approx(middle, rel=1e-6)
    assert value(run, body="block", slip=0.1) == pytest.approx(HALF_WIDTH * (1.0 - np.cos(lean)), rel=1e-6)
    assert value(run, body="other", tilt=0.1) == 0.0


def test_a_block_comes_down_at_its_velocity(structure):
    rate = 0.4  # rad/s
    run = run_of(structure, np.maximum(rate * (0.5 - TIME), 0.0) * (TIME > 0.0))
    struck = value(run, joint=["slab", "block"], impact_velocity="0.3 m/s")
    assert struck == pytest.approx(2 * HALF_WIDTH * rate, rel=0.02)


def test_blocks_beside_each_other_strike_at_their_velocity(structure):
    run = run_of(structure, shift=np.minimum(1.5 * TIME, 0.6))
    assert value(run, joint=["block", "other"], impact_velocity=0.1) == pytest.approx(1.5, rel=0.02)
    assert value(run, body="other", impact_velocity=0.1) == pytest.approx(1.5, rel=0.02)


def test_a_residual_is_that_of_the_end_of_a_whole_run(structure):
    moved = np.where(TIME < 0.4, 0.2, 0.03) * (TIME > 0.0)
    assert value(run_of(structure, shift=moved), body="block", residual=0.1) == pytest.approx(0.03, rel=1e-9)
    assert np.isnan(value(run_of(structure, shift=moved, whole=False), body="block", residual=0.1))


@pytest.mark.parametrize(
    ("state", "line"),
    [
        ({"body": "block"}, "expected one of tilt"),
        ({"tilt": 0.1}, "expected either body or joint"),
        ({"body": "block", "tilt": 0.1, "drift": 0.1}, "expected one of tilt"),
        ({"joint": ["a", "b"], "tilt": 0.1}, "expected a body, which tilt is of"),
        ({"body": "block", "tilt": "5 mm"}, "expected a unit of rotation"),
        ({"body": "block", "tilt": "five"}, "expected a number in rad, or with its unit"),
        ({"body": "block", "tilt": -0.1}, "greater than 0"),
        ({"body": "block", "tilt": "60 deg"}, "expected at most 40 deg"),
    ],
)
def test_a_wrong_limit_state_is_refused(state, line):
    with pytest.raises((InputError, ValueError), match=line):
        LimitState.model_validate(state)


def test_units_are_read():
    states = [{"tilt": "5 deg"}, {"drift": "20mm"}, {"impact velocity": "0.3 m/s"}, {"residual": 0.01}]
    limits = [LimitState(body="b", **one).limit for one in states]
    assert limits == pytest.approx([np.radians(5.0), 0.02, 0.3, 0.01], rel=1e-12)


def pulse_of(amplitude, period=0.8):
    time = np.arange(0.0, 3.0, 0.005)
    return time, amplitude * np.sin(2.0 * np.pi * time / period) * (time <= period)


def overturns(scale):
    """Whether a rigid block rocks over under the pulse: Housner (1963) integrated directly."""
    alpha, radius = np.arctan2(HALF_WIDTH, HALF_HEIGHT), np.hypot(HALF_WIDTH, HALF_HEIGHT)
    time, ground = pulse_of(scale)
    kept = 1.0 - 1.5 * np.sin(alpha) ** 2
    p2 = 3.0 * 9.81 / (4.0 * radius)

    def rate(t, state, side):
        lean, spin = state
        pushed = np.interp(t, time, ground) / 9.81
        return [spin, -p2 * (np.sin(side * alpha - lean) + pushed * np.cos(side * alpha - lean))]

    def lands(t, state, side):
        return side * state[0]

    def falls(t, state, side):
        return abs(state[0]) - 1.4

    lands.terminal, lands.direction, falls.terminal = True, -1, True
    start = int(np.argmax(np.abs(ground) > 9.81 * np.tan(alpha)))
    if not abs(ground[start]) > 9.81 * np.tan(alpha):
        return False
    # the ground's push to +x leans the block to -x
    now, side, state = time[start], -np.sign(ground[start]), [0.0, 0.0]
    state[0] = side * 1e-9
    while now < 3.0:
        found = solve_ivp(
            rate, (now, 3.0), state, args=(side,), events=(lands, falls), rtol=1e-8, atol=1e-10, max_step=0.01
        )
        if found.t_events[1].size:
            return True
        if not found.t_events[0].size or found.t[-1] >= 3.0:
            break
        now, side = found.t[-1], -side
        state = [side * 1e-9, kept * found.y[1, -1]]
        if abs(state[1]) < 1e-3:
            break
    return bool(abs(found.y[0, -1]) > alpha)


def test_the_chance_to_overturn_is_that_of_direct_integration(tmp_path):
    """Amplitudes drawn evenly; samples within 3 % of the threshold of the integration may go either way."""
    alone = {**BLOCK, "bodies": BLOCK["bodies"][:2]}
    (tmp_path / "block.yaml").write_text(yaml.safe_dump(alone), encoding="utf-8")
    time, ground = pulse_of(1.0)
    rows = "".join(f"{t:.3f},{a:.9g}\n" for t, a in zip(time, ground, strict=True))
    write_text(tmp_path / "pulse.csv", f"time_s,acceleration_x\n{rows}")
    scales = np.linspace(2.0, 6.0, 17)
    case = {
        "name": "block", "structure": str(tmp_path / "block.yaml"), "motion": str(tmp_path / "pulse.csv"), "scale": 1.0,
        "baseline": "none", "duration": 3.0, "input": "commanded", "intensity": {"measure": "pga"},
    }  # fmt: skip
    runs = CaseRuns(case, "nscd-rigid", {"time_step": 1e-3}, {}, 100.0)
    values = pd.DataFrame({"motion.scale": scales})
    files = simulate_samples(runs, driving_motions(case, None, 1), values, Store(tmp_path / "store", "t"))
    batches = samples_of(files, values)
    limits = {"tips": {"body": "block", "tilt": "40 deg"}}
    found = limit_states_of_case(batches, case, None, {}, limits, 1)
    exceeded = found["exceeded"].sel(limit="tips").to_numpy()
    expected = np.array([overturns(scale) for scale in scales])
    near = np.array([overturns(0.97 * scale) != overturns(1.03 * scale) for scale in scales])
    assert 0 < expected.sum() < len(scales)
    assert near.sum() <= 3
    np.testing.assert_array_equal(exceeded[~near], expected[~near])
    np.testing.assert_allclose(found["intensity"], scales * ground.max(), rtol=1e-6)
    count = int(exceeded.sum())
    assert tuple(found["probability_interval"].sel(limit="tips").values) == share_interval(count, len(scales))
    assert f"tips (tilt over 40 deg): {count} of 17 samples" in sentence(found.sel(limit="tips"))
    made = sample_figures(xr.concat(batches, dim="sample"))
    write_dataset(tmp_path / "results" / "samples" / "nscd-rigid" / "block.nc", made)
    write_dataset(tmp_path / "results" / "limits" / "nscd-rigid" / "block.nc", found)
    design = "friction.ice.ice\n" + "".join(f"{0.01 * number}\n" for number in range(17))
    (tmp_path / "results" / "design.csv").write_text(design)
    study = {"cases": [case], "models": ["nscd-rigid"], "limits": limits, "ensemble": {"seed": 1}}
    table = response_table(study, tmp_path / "results")
    assert table["motion.scale"].tolist() == scales.tolist()
    assert table["friction.ice.ice"].tolist() == [0.01 * number for number in range(17)]  # of no run's use
    assert table["record"].tolist() == ["pulse"] * 17
    assert table["limit.tips.exceeded"].tolist() == exceeded.tolist()
    assert set(table["status"]) == {"completed", "collapsed"}
