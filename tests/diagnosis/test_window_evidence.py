"""Short windows of simulated tests of two blocks: nothing is found where nothing is, and the effect where it is."""

import numpy as np
import pytest

from blockshake.diagnosis.candidates import candidates
from blockshake.diagnosis.joint_histories import joint_histories
from blockshake.diagnosis.null_model import draw_nominal
from blockshake.diagnosis.planned_test import PlannedTest, simulated_test
from blockshake.diagnosis.reconstructed_base import reconstruct_base
from blockshake.diagnosis.window_evidence import LONGEST, window_evidence, window_length
from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.motion import ground_motion
from blockshake.effects.registry import EFFECTS
from blockshake.geometry.structure import load_structure
from blockshake.measurement.accelerometers import accelerometer_channels
from blockshake.measurement.campaign import Sensors

# Largest |t| that a clean test may have: standard deviation 1.0 over six tests of NSCD, 1.4 to 2 over seven of LS-DEM.
CLEAN = {"nscd-rigid": 4.0, "ls-dem": 6.0}
TRIED = ("table-pitch", "stopper-contact@block-2-+x", "eccentricity@block-1")


def _evidence(source, solver, number, duration, keys, hidden=None, motion=None, blind=()):
    structure = load_structure(source)
    tried = [candidate for candidate in candidates(structure) if candidate.key in keys]
    effects = []
    for candidate in tried:
        if candidate.key == hidden:
            size, *others = EFFECTS[candidate.effect].parameters
            values = {size.name: size.null + 0.3 * (size.visible - size.null)}
            effects.append(candidate.as_effect(values | {item.name: item.visible for item in others}))
    markers = tuple(marker.name for marker in structure.file.markers if marker.name not in blind)
    planned = PlannedTest(
        source,
        motion or load_motion("alkion", 2.5),
        duration,
        Sensors(),
        markers,
        tuple(accelerometer_channels(structure)),
    )
    test, status = simulated_test(planned, draw_nominal(source, solver, number), effects)
    assert status == "completed"
    base = reconstruct_base(test, structure, planned.sensors)
    histories = joint_histories(test, structure, planned.sensors, base)
    return window_evidence(
        "test", structure, source, histories, base, tried, 3.0 * LONGEST, lambda line: None
    )


def test_windows_are_a_third_of_the_horizon():
    assert window_length(0.9) == pytest.approx(0.3)
    assert window_length(9.0) == LONGEST
    assert window_length(0.01) == 0.1


def test_a_table_that_pitches_is_found_before_anything_rocks(two_blocks):
    # rocking begins at g times the blocks' slenderness, 0.25 g for two of them; this is 0.1 g
    time = np.linspace(0.0, 1.6, 161)
    shaken = np.where(time > 0.3, np.sin(4.0 * np.pi * (time - 0.3)), 0.0)
    motion = ground_motion("gentle", time, {"x": shaken}, "acceleration")
    found = _evidence(two_blocks, "nscd-rigid", 1030, 1.6, TRIED[::2], hidden="table-pitch", motion=motion)
    assert 2 <= found.attrs["n_windows"] <= 5
    pitch = found.sel(candidate="table-pitch")
    assert abs(pitch["t"]) > 5.0
    assert pitch["size"].item() == pytest.approx(0.3, abs=0.1)
    assert pitch["log_ratio"] > 5.0
    assert abs(pitch["t"]) > 2.0 * abs(found["t"].sel(candidate="eccentricity@block-1"))


def test_a_block_whose_rotation_nobody_knows_leaves_no_windows(two_blocks):
    blind = [f"block-2-{name}" for name in ("lower", "upper", "end")]
    found = _evidence(two_blocks, "nscd-rigid", 1030, 0.5, TRIED[:1], blind=blind)
    assert found.attrs["n_windows"] == 0
    assert np.isnan(found["t"]).all()


@pytest.mark.slow
@pytest.mark.parametrize("solver", ["nscd-rigid", "ls-dem"])
def test_a_clean_test_has_small_t_and_tells_its_solver(two_blocks, solver):
    found = _evidence(two_blocks, solver, 1031, 6.0, TRIED)
    assert str(found["model"].values[int(np.argmax(found["density"].values))]) == solver
    assert np.abs(found["t"]).max() < CLEAN[solver]
    scaled = (found["innovation"] / found["scatter"]).sel(model=solver)
    assert 0.4 < np.sqrt((scaled**2).mean()) < 1.6


@pytest.mark.slow
@pytest.mark.parametrize("solver", ["nscd-rigid", "ls-dem"])
@pytest.mark.parametrize("hidden", TRIED)
def test_an_effect_of_a_third_of_the_visible_size_has_the_largest_t(two_blocks, solver, hidden):
    found = _evidence(two_blocks, solver, 1032, 6.0, TRIED, hidden=hidden)
    assert str(found["candidate"].values[int(np.argmax(np.abs(found["t"].values)))]) == hidden
    assert str(found["candidate"].values[int(np.argmax(found["log_ratio"].values))]) == hidden
    assert abs(found["t"].sel(candidate=hidden)) > CLEAN[solver]
