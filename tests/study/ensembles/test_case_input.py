"""A table that errs costs nothing where the models are driven by the measured motion of the slab."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from fair_score import crps

from blockshake.dynamics.load_motion import load_motion
from blockshake.effects.effect import Experiment
from blockshake.errors import InputError
from blockshake.files import write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.measurement.sensors.instruments import Instruments, observe
from blockshake.simulation.simulate import simulate
from blockshake.store import Store
from blockshake.study.ensembles.batch import CaseRuns, samples_of, simulate_samples
from blockshake.study.ensembles.case_input import (
    driving_motions,
    measured_input,
    measured_on_clock,
    structure_of_case,
)
from blockshake.study.ensembles.coverage import compared_curves
from blockshake.study.ensembles.ensemble import join_batches
from blockshake.virtual.settings import TableErrors
from blockshake.virtual.shake_table import followed

FRICTION = "friction.stone.stone"
STRUCTURE = """
name: one-block
materials: {stone: {density: 2400.0, youngs_modulus: 3.45e+10, poisson_ratio: 0.2}}
shapes: {slab: {box: [6.0, 3.0, 0.4]}, block: {box: [2.0, 1.0, 0.5]}}
bodies:
  - {name: slab, shape: slab, material: stone, position: [0.0, 0.0, -0.2], driven: true}
  - {name: block, shape: block, material: stone, position: [0.0, 0.0, 0.25]}
friction: [{pair: [stone, stone], coefficient: 0.5}]
markers:
  - {name: slab-left, body: slab, position: [-2.5, -1.5, 0.1]}
  - {name: slab-right, body: slab, position: [2.5, -1.5, 0.1]}
  - {name: slab-end, body: slab, position: [3.0, 0.0, 0.0]}
  - {name: block-face, body: block, position: [0.0, -0.5, 0.0]}
accelerometers: [{name: slab-acc, body: slab, position: [3.0, 0.0, 0.0], axes: [x]}]
"""
CAMPAIGN = """
name: sliding
structure: one-block.yaml
tests: [{name: t1, file: t1.nc, motion: motion.csv, scale: 1.0, role: fit}]
"""
OFF = TableErrors(gain=1.06, high=-0.02, corner=2.0, pitch=5e-5)
SIZE, DURATION = 20, 3.0


@pytest.fixture
def case(tmp_path):
    time = np.arange(0.0, DURATION + 0.005, 0.01)
    wave = 8.0 * np.sin(4.0 * np.pi * time) * np.clip(np.minimum(time, 2.8 - time), 0.0, 0.5)
    rows = [f"{t:.2f},{a:.6f}" for t, a in zip(time, wave, strict=True)]
    (tmp_path / "motion.csv").write_text("time_s,acceleration_x\n" + "\n".join(rows) + "\n")
    (tmp_path / "one-block.yaml").write_text(STRUCTURE)
    (tmp_path / "campaign.yaml").write_text(CAMPAIGN)
    return {
        "structure": str(tmp_path / "one-block.yaml"), "motion": str(tmp_path / "motion.csv"), "scale": 1.0,
        "baseline": "auto",
        "duration": 2.5,
    }  # fmt: skip


@pytest.fixture
def score(case, tmp_path):
    """Score of an ensemble against a test on a table, by the input that drives the ensemble [m]."""
    structure = load_structure(case["structure"])
    named = {"campaign": str(tmp_path), "test": "t1"}

    def scored(table, driven_by):
        motion = followed(Experiment(structure, load_motion(case["motion"]), Instruments()), table).motion
        run = simulate(structure, motion, "nscd-rigid", {FRICTION: 0.5}, time_step=1e-3, duration=DURATION)
        write_dataset(tmp_path / "t1.nc", observe(run, structure, Instruments(), 4))
        base = measured_input({**case, "input": driven_by}, named)
        values = 0.5 * np.exp(0.05 * np.linspace(-1.6, 1.6, SIZE))
        runs = CaseRuns({**case, "input": driven_by}, "nscd-rigid", {"time_step": 1e-3}, {}, 200.0)
        motions = driving_motions(runs.case, base, 1)
        rows = pd.DataFrame({FRICTION: values})
        finished = samples_of(simulate_samples(runs, motions, rows, Store(tmp_path / "store", "test")), rows)
        measured, noise = measured_on_clock(named, base)
        read, _, _, readings = compared_curves(measured, join_batches(finished), noise, 1)
        return np.nanmean(crps(readings, read.to_numpy()))

    return scored


def test_a_table_five_per_cent_off_costs_nothing(score):
    exact = score(TableErrors(), "measured")
    assert score(OFF, "measured") == pytest.approx(exact, rel=0.15)
    assert score(OFF, "commanded") > 3.0 * exact
    assert score(TableErrors(), "commanded") == pytest.approx(exact, rel=0.15)


def test_samples_have_draws_of_their_own_and_models_the_same(case, score, tmp_path):
    score(TableErrors(), "measured")
    named = {"campaign": str(tmp_path), "test": "t1"}
    driven = {**case, "input": "measured"}
    base = measured_input(driven, named)
    first, again = driving_motions(driven, base, 1), driving_motions(driven, base, 1)
    other = driving_motions(driven, base, 2)
    table = [one(3).table.coefficients for one in (first, again, other)]
    assert np.array_equal(table[0], table[1])
    assert not np.array_equal(table[0], table[2])
    assert not np.array_equal(table[0], first(4).table.coefficients)


def test_a_record_that_ends_before_the_window_is_refused_where_it_is_the_input(case, score, tmp_path):
    score(TableErrors(), "commanded")
    named = {"campaign": str(tmp_path), "test": "t1"}
    longer = {**case, "duration": 10.0}
    with pytest.raises(InputError, match=r"t1: duration: expected at most 3 s, .* or input: commanded"):
        measured_input({**longer, "input": "measured"}, named)
    assert np.isfinite(measured_input({**longer, "input": "commanded"}, named).attrs["gain"])


@pytest.mark.parametrize("lost", ["rows", "readings of the slab"])
def test_a_gap_in_which_the_slab_s_motion_is_lost_is_refused_where_it_is_the_input(
    lost, case, score, tmp_path
):
    score(TableErrors(), "commanded")
    path, named = tmp_path / "t1.nc", {"campaign": str(tmp_path), "test": "t1"}
    whole = xr.load_dataset(path, decode_times=False)
    inside = (whole["time"] > 1.0) & (whole["time"] < 1.8)
    slab = whole["marker"].isin(["slab-left", "slab-right", "slab-end"])
    test = whole.drop_dims("time_acc")
    test["marker_displacement"] = whole["marker_displacement"].where(~(inside & slab))
    test = test.isel(time=~inside) if lost == "rows" else test
    write_dataset(path, test)
    with pytest.raises(
        InputError, match=r"expected readings of the slab .* or input: commanded; .* to [\d.]+ mm alone"
    ):
        measured_input({**case, "input": "measured"}, named)
    measured_input({**case, "input": "commanded"}, named)


def test_a_case_starts_where_the_blocks_of_its_test_stood(case, tmp_path):
    structure, motion = load_structure(case["structure"]), load_motion(case["motion"])
    run = simulate(structure, motion, "nscd-rigid", {}, time_step=1e-3, duration=1.0)
    test = observe(run, structure, Instruments(), 4).assign_coords(body=["block"])
    test["initial_offset"] = ("body", "axis"), [[0.05, -0.02, 0.0]]
    test["initial_rotation"] = ("body", "axis"), [[0.0, 0.0, 0.03]]
    write_dataset(tmp_path / "t1.nc", test)
    driven = {**case, "duration": 0.5, "input": "commanded"}
    base = measured_input(driven, {"campaign": str(tmp_path), "test": "t1"})
    write_dataset(tmp_path / "base.nc", base)
    rows, finished = pd.DataFrame({FRICTION: [0.5]}), []
    for known in (None, [], base, tmp_path / "base.nc"):
        stands = structure_of_case(driven, known)
        moved = [0.05, -0.02, 0.0] if known else [0.0, 0.0, 0.0]
        np.testing.assert_allclose(stands.position - structure.position, [[0.0] * 3, moved], atol=1e-12)
        runs = CaseRuns(driven, "nscd-rigid", {"time_step": 1e-3}, {}, 200.0)
        store = Store(tmp_path / "store", "test")
        finished += simulate_samples(runs, driving_motions(driven, known, 1), rows, store, known)
    assert finished[0] == finished[1] != finished[2] == finished[3]
