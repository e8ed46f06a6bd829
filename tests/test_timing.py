"""Cost of the simulations of a study, from the logs of its jobs: `bench/timing.py`."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr


@pytest.fixture
def timing(monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[1] / "bench"))
    import timing

    return timing


@pytest.fixture
def read_timings(timing):
    return timing.read_timings


def test_a_job_that_was_killed_has_no_cost(tmp_path, timing):
    (tmp_path / "killed.log").write_text("a line\n")
    assert timing.read_cost(tmp_path / "killed.log") is None
    assert timing.read_cost(tmp_path / "none.log") is None


def figures(count):
    return xr.Dataset({"end_time": ("sample", np.full(count, 2.0))}, coords={"sample": np.arange(count)})


def write(folder, batch, text):
    path = folder / "simulate_batch" / "ls-dem" / "one" / f"{batch}.log"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"python 3\n{text}")


def test_jobs_add_up_and_batches_of_an_earlier_configuration_do_not_count(tmp_path, read_timings):
    write(tmp_path, "000-004", "Took 12.0 s, 10.0 CPU s.\n")
    write(tmp_path, "005-007", "Took 6.0 s, 5.0 CPU s.\n")
    write(tmp_path, "010-014", "Took 99.0 s, 99.0 CPU s.\n")
    (timing,) = read_timings(tmp_path, {("ls-dem", "one"): figures(8)})
    assert (timing.jobs, timing.samples, timing.simulated) == (2, 8, 16.0)
    assert (timing.cpu_time, timing.wall_time) == (15.0, 18.0)


@pytest.mark.parametrize("logs", [(), ("000-007",)])
def test_cost_of_a_case_without_logs_or_with_killed_jobs_alone_is_unknown(tmp_path, read_timings, logs):
    for batch in logs:
        write(tmp_path, batch, "sample 3, simulated: completed\n")
    (timing,) = read_timings(tmp_path, {("ls-dem", "one"): figures(8)})
    assert (timing.jobs, timing.simulated) == (0, 0.0)
    assert np.isnan([timing.cpu_time, timing.wall_time]).all()
