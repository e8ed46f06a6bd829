"""Friction is found where blocks slid, and said to be unknown where they only rocked: synthetic tests of one block."""

import numpy as np
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.simulation.simulate import simulate
from blockshake.store import Store
from blockshake.study.ensembles.batch import CaseRuns
from blockshake.study.friction.search import calibrate_friction
from blockshake.study.sampling.distributions import Lognormal

NOISE = 1e-4
VARIABLE = "friction.stone.stone"
SQUAT = [2.0, 1.0, 0.5]  # b/h = 4: slides, never rocks
SLENDER = [0.4, 1.0, 1.6]  # b/h = 0.25: rocks before it slides
DISTRIBUTIONS = {
    VARIABLE: Lognormal(mean=0.6, cov=0.02),
    "materials.stone.density": Lognormal(mean=2400.0, cov=0.04),
}
SEARCH = {
    "variables": [VARIABLE], "lowest": 0.3, "highest": 0.8, "step": 0.1, "finest": 0.0125, "size": 10,
    "replicates": 3,
}  # fmt: skip


@pytest.fixture
def search(tmp_path, one_block, read_with_noise):
    def run(block, motion, truth, duration=2.0, **changes):
        structure = one_block(block)
        (tmp_path / "motion.csv").write_text(motion)
        case = {
            "structure": str(structure),
            "motion": str(tmp_path / "motion.csv"),
            "scale": 1.0,
            "baseline": "auto",
            "duration": 2.0,
            "input": "commanded",
        }
        # the truth by the other solver: not the simulator that looks for it
        true = simulate(
            structure,
            load_motion(case["motion"]),
            "ls-dem",
            {VARIABLE: truth},
            time_step=2e-5,
            duration=duration,
        )
        return calibrate_friction(
            CaseRuns(case, "nscd-rigid", {"time_step": 1e-3}, {}, 200.0),
            None,
            {"distributions": DISTRIBUTIONS, "seed": 1},
            SEARCH | changes,
            read_with_noise(true, NOISE, 5),
            NOISE,
            Store(tmp_path / "store", "test"),
        )

    return run


def _pulses(amplitude):
    """Base acceleration of 2 Hz, one-sided enough to leave a slip."""
    time = np.arange(0.0, 2.0001, 0.01)
    wave = np.sin(2 * np.pi * 2.0 * time) + 0.3 * np.sin(2 * np.pi * 4.0 * time)
    wave *= np.where(time < 1.5, 1.0, 0.0)
    rows = [f"{t:.3f},{amplitude * 9.81 * a:.8f}" for t, a in zip(time, wave, strict=True)]
    return "time_s,acceleration_x\n" + "\n".join(rows) + "\n"


@pytest.mark.slow
@pytest.mark.parametrize("truth", [0.45, 0.62])
def test_the_friction_of_a_sliding_block_is_recovered(truth, search):
    found, beside = search(SQUAT, _pulses(0.9), truth)
    assert found.lower < truth < found.upper
    assert found.upper - found.lower < 0.15
    assert found.answer.startswith("between")
    assert beside["residual"].max() > 10.0 * NOISE


@pytest.mark.slow
def test_a_rocking_block_does_not_inform_friction_above_its_slenderness(search):
    found, _ = search(SLENDER, _pulses(0.32), 0.62)
    assert np.isnan(found.upper)
    assert found.answer.startswith("not informed")
    first = found.table.index[found.table["accepted"]][0]
    assert first < 0.45


def test_a_search_repeats_to_the_bit_and_goes_on_from_its_store(search, tmp_path, monkeypatch):
    small = {"lowest": 0.4, "highest": 0.6, "step": 0.2, "finest": 0.2, "replicates": 2, "duration": 0.5}
    first, beside = search(SQUAT, _pulses(0.9), 0.45, **small)
    kept = {path: path.stat().st_mtime_ns for path in (tmp_path / "store").iterdir()}
    assert len(kept) == 40
    again, beside_again = search(SQUAT, _pulses(0.9), 0.45, **small)
    assert first.table.equals(again.table)
    assert beside.equals(beside_again)
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "store").iterdir()} == kept
