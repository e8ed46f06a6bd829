"""The joint calibration on synthetic tests of one block, whose friction or contact stiffness is known."""

import numpy as np
import pytest
import xarray as xr
import yaml

from blockshake.dynamics.load_motion import load_motion
from blockshake.files import write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.simulation.simulate import simulate
from blockshake.store import Store
from blockshake.study.calibration import comparison
from blockshake.study.calibration.calibration import ALL, calibrate, models_of
from blockshake.study.calibration.comparison import compare_open_tests
from blockshake.study.calibration.settings import RESTITUTION, STIFFNESS
from blockshake.study.stiffness.wave_speed import calibrate_stiffness

FRICTION = "friction.stone.stone"
SQUAT = [2.0, 1.0, 0.5]  # b/h = 4: slides, never rocks
SLENDER = [0.4, 1.0, 1.6]  # on its springs it rocks at some 40 Hz times the root of their factor
MODELS = {
    "ls-dem": {"time_step": 5e-5, "parameters": {}},
    "nscd-rigid": {"time_step": 1e-3, "parameters": {}},
}
DENSITY = {"materials.stone.density": {"distribution": "lognormal", "mean": 2400.0, "cov": 0.04}}


def _study(cases, size):
    distributions = {FRICTION: {"distribution": "lognormal", "mean": 0.6, "cov": 0.1}, **DENSITY}
    return {
        "calibration": {"cases": cases, "size": size},
        "ensemble": {"seed": 1, "distributions": distributions, "linked": {}},
        "models": MODELS,
        "output_rate": 200.0,
    }


def _noise(seed, amplitude, duration, highest):
    """Base acceleration with all frequencies up to a highest one, at rest for half a second before and after."""
    time = np.arange(0.0, duration + 1e-9, 0.005)
    generator = np.random.default_rng(seed)
    lines = np.arange(1.0, highest, 0.25)
    wave = np.sin(2.0 * np.pi * (np.outer(time, lines) + generator.uniform(size=len(lines)))).sum(axis=1)
    wave *= amplitude * np.sqrt(2.0 / len(lines)) * ((time > 0.5) & (time < duration - 0.5))
    return "time_s,acceleration_x\n" + "".join(f"{t:.3f},{a:.8f}\n" for t, a in zip(time, wave, strict=True))


@pytest.fixture
def campaign(tmp_path, one_block):
    """Folder of synthetic tests of one block by LS-DEM with true parameters, one under each motion."""

    def made(block, truth, motions, duration, **options):
        structure = one_block(block, **options)
        tests = []
        for place, motion in enumerate(motions):
            name = f"t{place}"
            (tmp_path / f"{name}.csv").write_text(motion)
            run = simulate(
                structure,
                load_motion(tmp_path / f"{name}.csv"),
                "ls-dem",
                truth,
                time_step=2e-5,
                duration=duration,
            )
            write_dataset(
                tmp_path / f"{name}.nc", observe(run, load_structure(structure), Instruments(), place)
            )
            tests.append(
                {"name": name, "file": f"{name}.nc", "motion": f"{name}.csv", "scale": 1.0, "role": "fit"}
            )
        tests[-1]["role"] = "sealed"
        file = {"name": "made", "structure": "one-block.yaml", "tests": tests}
        (tmp_path / "campaign.yaml").write_text(yaml.safe_dump(file))
        return tmp_path

    return made


def _answers(folder, models, size, duration, tmp_path):
    case = {"name": "one-block", "structure": str(folder / "one-block.yaml"), "duration": duration}
    study = _study({model: ("one-block",) for model in models}, size) | {"cases": [case]}
    compared = [
        compare_open_tests(case, str(folder), model, study, Store(tmp_path / "store", "source"))
        for model in models
    ]
    return compared, calibrate(compared, study)


@pytest.mark.slow
@pytest.mark.parametrize("truth", [0.35, 0.55])
def test_the_friction_of_a_sliding_block_is_told_by_the_other_solver(truth, campaign, tmp_path):
    motions = [_noise(seed, 5.0, 4.0, 4.0) for seed in range(3)]
    folder = campaign(SQUAT, {FRICTION: truth}, motions, 4.0)
    _, found = _answers(folder, ["nscd-rigid"], 40, 4.0, tmp_path)
    answer = found["parameters"][FRICTION]["answers"][ALL]
    assert answer["told"]
    assert (answer["lower"] or 0.2) <= truth <= (answer["upper"] or 1.0)
    assert answer["upper"] - (answer["lower"] or 0.2) < 0.3
    assert set(found["parameters"]) == {FRICTION}  # rigid contact has no springs


@pytest.mark.slow
def test_contact_stiffness_is_told_by_a_noise_test_of_low_amplitude(campaign, one_block, tmp_path):
    """The block stays closed: friction and restitution of impacts are unknown, the stiffness is, by its frequency."""
    truth = 0.3
    wave = calibrate_stiffness(one_block(SLENDER))
    true = {f"ls_dem.{name}": truth * wave[name] for name in ("normal_stiffness", "shear_stiffness")}
    motions = [_noise(seed, 0.3, 6.0, 45.0) for seed in range(3)]
    folder = campaign(SLENDER, true, motions, 6.0)
    _, found = _answers(folder, ["ls-dem"], 40, 6.0, tmp_path)
    stiffness = found["parameters"][STIFFNESS]["answers"][ALL]
    assert stiffness["told"]
    assert (stiffness["lower"] or 0.03) <= truth <= (stiffness["upper"] or 3.0)
    assert stiffness["assumed_is_refused"]
    assert not found["parameters"][FRICTION]["answers"][ALL]["told"]


def test_rigid_contact_needs_no_wave_test_and_a_test_no_accelerometers(campaign, tmp_path, monkeypatch):
    motions = [_noise(seed, 4.0, 2.5, 4.0) for seed in range(2)]
    folder = campaign(SQUAT, {FRICTION: 0.4}, motions, 2.5, accelerometers=False)
    monkeypatch.setattr("blockshake.study.calibration.comparison.calibrate_design", None)
    compared, found = _answers(folder, ["nscd-rigid"], 20, 2.5, tmp_path)
    assert compared[0]["parameter"].values.tolist() == [FRICTION]
    assert [one["reading"] for one in found["tests"]] == ["displacement"]
    assert found["left_out"] == []


def test_one_parameter_alone_is_calibrated_and_another_takes_its_value(campaign, tmp_path, monkeypatch):
    """The springs stay the structure's, without a wave test, and a linked friction has the calibrated one's value."""
    folder = campaign(SQUAT, {FRICTION: 0.4}, [_noise(seed, 4.0, 2.5, 4.0) for seed in range(2)], 2.5)
    case = {"name": "one-block", "structure": str(folder / "one-block.yaml"), "duration": 2.5}
    study = _study({"ls-dem": ("one-block",)}, 20)
    linked = {"friction.stone.glass": FRICTION}
    study["calibration"] |= {"parameters": (FRICTION,), "linked": linked}
    monkeypatch.setattr("blockshake.study.calibration.comparison.calibrate_design", None)
    asked = {}

    def unread(test, model, settings, rows, steps, ensemble, *rest):
        asked.update(rows=rows, steps=steps, linked=ensemble["linked"])
        return [None] * len(rows)

    monkeypatch.setattr(comparison, "simulate_readings", unread)
    compared = compare_open_tests(case, str(folder), "ls-dem", study, Store(tmp_path / "store", "source"))
    assert compared["parameter"].values.tolist() == [FRICTION]
    assert list(asked["rows"]) == [FRICTION, *DENSITY]
    assert set(asked["steps"]) == {MODELS["ls-dem"]["time_step"]}
    assert asked["linked"] == linked


def test_a_test_that_many_samples_do_not_end_is_not_asked(campaign, tmp_path, monkeypatch):
    """Corners of the ranges without any sample would pass for values that are reported."""
    folder = campaign(SQUAT, {FRICTION: 0.4}, [_noise(seed, 4.0, 2.5, 4.0) for seed in range(2)], 2.5)
    solved = comparison.simulate_readings

    def failing(*arguments):
        return [None if place % 5 == 0 else path for place, path in enumerate(solved(*arguments))]

    monkeypatch.setattr(comparison, "simulate_readings", failing)
    _, found = _answers(folder, ["nscd-rigid"], 20, 2.5, tmp_path)
    assert found["left_out"] == ["one-block t0, nscd-rigid"]
    assert found["parameters"] == {}
    assert found["tests"] == []


def test_a_run_that_does_not_converge_is_made_again_by_a_shorter_step(campaign, tmp_path, monkeypatch):
    """Some samples' joints ask for a shorter step than their springs alone: their test would not be requested."""
    folder = campaign(SQUAT, {FRICTION: 0.4}, [_noise(seed, 4.0, 2.5, 4.0) for seed in range(2)], 2.5)
    steps = []

    def short_steps_alone(*arguments, time_step, **options):
        steps.append(time_step)
        run = simulate(*arguments, time_step=time_step, **options)
        return run if time_step < 4e-4 else run.assign_attrs(status="not-converged")

    monkeypatch.setattr("blockshake.study.calibration.readings.simulate", short_steps_alone)
    _, found = _answers(folder, ["nscd-rigid"], 20, 2.5, tmp_path)
    assert steps == 20 * [1e-3, 5e-4, 2.5e-4]
    assert found["left_out"] == []


def test_both_models_answer_and_the_sealed_test_is_not_read(campaign, tmp_path):
    folder = campaign(SQUAT, {FRICTION: 0.4}, [_noise(seed, 4.0, 2.5, 4.0) for seed in range(2)], 2.5)
    (folder / "t1.nc").write_bytes(b"sealed")
    compared, found = _answers(folder, list(MODELS), 20, 2.5, tmp_path)
    assert models_of(found) == list(MODELS)
    assert {one["test"] for one in found["tests"]} == {"t0"}
    assert [one["test"].values.tolist() for one in compared] == [["t0"], ["t0"]]
    assert set(found["parameters"][RESTITUTION]["answers"]) == {"ls-dem", ALL}
    assert set(found["parameters"][FRICTION]["answers"]) == {*MODELS, ALL}
    kept = {path: path.stat().st_mtime_ns for path in (tmp_path / "store").glob("*.nc")}
    assert len(kept) == 2 * 20
    again, _ = _answers(folder, list(MODELS), 20, 2.5, tmp_path)
    for one, other in zip(compared, again, strict=True):
        xr.testing.assert_identical(one, other)
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "store").glob("*.nc")} == kept
