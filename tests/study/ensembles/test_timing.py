import json

import numpy as np
import pytest
import xarray as xr

from blockshake.study.ensembles.timing import read_timings


def figures(count):
    return xr.Dataset({"end_time": ("sample", np.full(count, 2.0))}, coords={"sample": np.arange(count)})


def write(folder, batch, **record):
    path = folder / "simulate_batch" / "ls-dem" / "one" / f"{batch}.jsonl"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record) + "\n")


def test_jobs_add_up_and_batches_of_an_earlier_configuration_do_not_count(tmp_path):
    write(tmp_path, "000-004", cpu_time=10.0, s=12.0)
    write(tmp_path, "005-007", cpu_time=5.0, s=6.0)
    write(tmp_path, "010-014", cpu_time=99.0, s=99.0)
    (timing,) = read_timings(tmp_path, {("ls-dem", "one"): figures(8)})
    assert (timing.jobs, timing.samples, timing.simulated) == (2, 8, 16.0)
    assert (timing.cpu_time, timing.wall_time) == (15.0, 18.0)


def test_cost_of_a_case_without_benchmarks_is_unknown(tmp_path):
    (timing,) = read_timings(tmp_path, {("ls-dem", "one"): figures(8)})
    assert (timing.jobs, timing.simulated) == (0, 0.0)
    assert np.isnan([timing.cpu_time, timing.wall_time]).all()


def test_a_job_too_short_to_be_measured_leaves_the_cost_unknown(tmp_path):
    write(tmp_path, "000-007", cpu_time="NA", s=0.1)
    (timing,) = read_timings(tmp_path, {("ls-dem", "one"): figures(8)})
    assert np.isnan(timing.cpu_time)
    assert timing.wall_time == pytest.approx(0.1, rel=1e-12)
