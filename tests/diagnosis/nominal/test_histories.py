"""Histories read of a test: joints whose motion is prescribed, gaps, and the clock of the readings."""

import numpy as np
from known_motion import SENSORS, STRUCTURE, TIME, base_motion, bump, moved_run, ramp, seen

from blockshake.diagnosis.nominal.histories import as_cells, at_readings, common_times, read_histories

BASE = base_motion()
ANGLE = bump(TIME, 1.5, 0.6, 0.02)
SLIP = ramp(TIME, 2.5, 0.2, 0.004)
TOP = STRUCTURE.body_names[-1]


def _run():
    return moved_run(BASE, rocking=[0.0, ANGLE], slips=[SLIP])


def _cell(cells, quantity, number=0):
    return cells.isel(cell=np.flatnonzero(cells["quantity"].to_numpy() == quantity)[number])


def test_prescribed_joints_come_back_fifty_times_a_second():
    found = read_histories(seen(_run()), STRUCTURE, SENSORS)
    time = found["time"].to_numpy()
    np.testing.assert_allclose(np.diff(time), 0.02, atol=1e-12)
    cells = as_cells(found)
    # single precision
    np.testing.assert_allclose(_cell(cells, "rotation", 1), np.interp(time, TIME, ANGLE), atol=1e-8)
    np.testing.assert_allclose(_cell(cells, "slip", 0), np.interp(time, TIME, SLIP), atol=1e-8)
    assert cells["where"].values[-1] == TOP
    assert cells["quantity"].values.tolist() == ["rotation"] * 3 + ["slip"] * 3 + ["drift"]


def test_one_marker_a_block_leaves_the_drift_of_every_block():
    markers = [f"{name}-a" for name in STRUCTURE.body_names]
    slab = [one.name for one in STRUCTURE.file.markers if one.body == "slab"]
    test = seen(_run()).sel(marker=list(dict.fromkeys([*slab, *markers])))
    cells = as_cells(read_histories(test, STRUCTURE, SENSORS))
    assert set(cells["quantity"].values) == {"drift"}
    assert cells["where"].values.tolist() == [name for name in STRUCTURE.body_names if name != "slab"]


def test_short_gaps_are_bridged_and_long_ones_stay():
    test = seen(_run())
    for start, length in ((3.0, 0.1), (4.0, 0.5)):
        test["marker_displacement"].loc[{"time": slice(start, start + length)}] = np.nan
    cells = as_cells(read_histories(test, STRUCTURE, SENSORS))
    known = cells.notnull().all("cell")
    assert known.sel(time=slice(2.9, 3.2)).all()
    assert not known.sel(time=slice(4.05, 4.45)).any()


def test_noise_is_told_of_every_cell():
    read = as_cells(read_histories(seen(_run(), marker_noise=1e-4, seed=3), STRUCTURE, SENSORS))
    noisy = read_histories(seen(_run(), marker_noise=1e-4, seed=3), STRUCTURE, SENSORS)
    exact = as_cells(read_histories(seen(_run()), STRUCTURE, SENSORS))
    # 300 readings: standard error of a deviation 4 %, largest of seven: 4 of them
    ratio = (read - exact).std("time") / as_cells(noisy, "_noise")
    np.testing.assert_allclose(ratio, 1.0, atol=0.17)


def test_a_simulated_test_is_held_against_the_times_of_the_readings():
    cells = as_cells(read_histories(seen(_run()), STRUCTURE, SENSORS))
    asked = cells["time"].to_numpy()[5:-5] + 0.003
    measured = cells.isel(time=slice(5, -5)).assign_coords(time=asked)
    time = common_times(measured, cells)
    np.testing.assert_array_equal(time, asked)
    found = at_readings(cells, time)
    smooth = (
        np.abs(time[:, None] - [1.5, 2.1]).min(axis=1) > 0.04
    )  # s, from the ends of the turn, where it has kinks
    error = _cell(found, "rotation", 1).to_numpy() - np.interp(time, TIME, ANGLE)
    assert np.abs(error[smooth]).max() < 2e-5
