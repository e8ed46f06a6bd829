"""Small inputs that users of other programs reported, with their right values; skipped where the files are missing."""

import os
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from blockshake.cli import main
from blockshake.dynamics.load_motion import load_motion

CASES = Path(os.environ.get("BLOCKSHAKE_SHARED", Path(__file__).parents[2] / "shared")) / "cases"
pytestmark = pytest.mark.skipif(not CASES.is_dir(), reason=f"no {CASES} (set BLOCKSHAKE_SHARED)")


def _peaks(motion):
    """Largest absolute displacement, velocity and acceleration [m, m/s, m/s2] along x."""
    return [np.abs(motion.evaluate(motion.table.breaks, order)[:, 0]).max() for order in range(3)]


def _simulate(folder, structure, motion, model, output, *more):
    files = ["--structure", str(folder / structure), "--motion", str(folder / motion)]
    assert main(["simulate", *files, "--model", model, "--output", str(output), *more]) == 0
    return xr.load_dataset(output)


def test_the_unit_of_an_old_at2_record_ends_with_a_full_stop():
    motion = load_motion(CASES / "at2-unit-full-stop" / "record.AT2", baseline="none")
    assert motion.duration == pytest.approx(4.02)
    assert _peaks(motion)[2] == pytest.approx(0.24445 * 9.80665, rel=1e-4)


def test_a_cosmos_v2_record_has_the_step_of_its_series():
    motion = load_motion(CASES / "cosmos-v2-interval" / "record.v2", baseline="none")
    assert motion.duration == pytest.approx(9.99)
    assert _peaks(motion)[2] == pytest.approx(1.47066, rel=1e-4)


@pytest.mark.parametrize("name", ["wavelet.AT2", "control.AT2"])
def test_a_record_that_ends_at_rest_keeps_its_displacement(name):
    displacement, velocity, acceleration = _peaks(load_motion(CASES / "record-corrected-twice" / name))
    assert displacement == pytest.approx(0.0499, rel=0.02)
    assert velocity == pytest.approx(0.2534, rel=0.01)
    assert acceleration == pytest.approx(3.084, rel=0.01)


def test_names_of_a_correlation_file_are_checked_before_the_first_job(monkeypatch, capsys):
    monkeypatch.chdir(CASES / "correlation-names")
    assert main(["check", "study.yaml"]) == 2
    assert "friction.granite.steel" in capsys.readouterr().err
    assert main(["check", "study-2.yaml"]) == 0  # a pair in either order


def test_a_mesh_of_solids_that_overlap_is_refused(capsys):
    assert main(["check", str(CASES / "overlapping-solids" / "block.yaml")]) == 2
    assert "two.stl: part 1 and 2 of 2 overlap" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["cubes.yaml", "one-block.yaml"])
def test_blocks_that_are_laid_into_each_other_stand(name, tmp_path):
    folder = CASES / "start-overlap-ls-dem"
    run = _simulate(folder, name, "rest.csv", "ls-dem", tmp_path / "run.nc", "--duration", "0.6")
    moved = run["position"] - run["position"].isel(time=0)
    assert float(np.abs(moved).max()) < 1e-3


@pytest.mark.parametrize("name", ["block.yaml", "middle.yaml"])
def test_a_block_on_a_tilting_table_stays_until_it_tips(name, tmp_path):
    """At arctan(0.4 / 0.8) = 26.6 degrees, 24.2 s."""
    run = _simulate(CASES / "tilting-table-collapsed", name, "tilt.csv", "nscd-rigid", tmp_path / "run.nc")
    assert float(run["time"][-1]) > 24.2
