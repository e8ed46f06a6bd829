"""A gap between rows is refused however the times are printed, and an uneven series is read as it is."""

import numpy as np
import pytest

from blockshake.dynamics.records.times import check_times
from blockshake.errors import InputError

RANDOM = np.random.default_rng(3)
EVEN = {
    "300 Hz in ms": np.round(np.arange(600) / 300.0, 3),
    "400 Hz in ms": np.round(np.arange(600) / 400.0, 3),
    "60 Hz in 10 ms": np.round(np.arange(600) / 60.0, 2),
    "75 Hz in 10 ms": np.round(np.arange(600) / 75.0, 2),
    "100 Hz": np.arange(600) / 100.0,
    "jitter": np.cumsum(0.01 * (1.0 + 0.15 * RANDOM.normal(size=600))),
    "100 Hz, then 50 Hz": np.append(np.arange(300) / 100.0, 3.0 + np.arange(300) / 50.0),
    "exponential": np.cumsum(RANDOM.exponential(size=600)),
    "growing steps": np.cumsum(1.3 ** np.arange(30)),
}


def check(time):
    check_times(time, list(range(2, len(time) + 2)), "f.csv", "t")


@pytest.mark.parametrize("name", EVEN)
def test_times_without_a_gap_pass(name):
    check(EVEN[name])


@pytest.mark.parametrize("name", [name for name in EVEN if name not in ("exponential", "growing steps")])
def test_a_gap_of_seconds_is_refused(name):
    time = EVEN[name].copy()
    time[400:] = np.round(time[400:] + 3.0, 9)
    with pytest.raises(InputError, match=r"f.csv: line 402, t: expected rows .*, 1 such gaps in all"):
        check(time)


@pytest.mark.parametrize("name", ["300 Hz in ms", "60 Hz in 10 ms", "100 Hz"])
def test_few_missing_rows_are_refused(name):
    with pytest.raises(InputError, match="line 402, t: expected rows"):
        check(np.delete(EVEN[name], range(400, 403)))
