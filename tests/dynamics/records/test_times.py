"""A gap between rows is refused however the times are printed, and an uneven series is read as it is."""

import numpy as np
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.dynamics.records.times import check_times
from blockshake.errors import InputError
from blockshake.study.remarks import motion_remarks

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
    fast = (-1.0) ** np.arange(len(time))
    check_times(time, [fast], list(range(2, len(time) + 2)), "f.csv", "t")


@pytest.mark.parametrize("name", EVEN)
def test_times_without_a_gap_pass(name):
    check(EVEN[name])


@pytest.mark.parametrize("name", [name for name in EVEN if name not in ("exponential", "growing steps")])
def test_a_gap_of_seconds_is_refused(name):
    time = EVEN[name].copy()
    time[400:] = np.round(time[400:] + 3.0, 9)
    with pytest.raises(InputError, match=r"f.csv: line 402, t: expected rows .*, 1 such gap in all"):
        check(time)


@pytest.mark.parametrize("name", ["300 Hz in ms", "60 Hz in 10 ms", "100 Hz"])
def test_few_missing_rows_are_refused(name):
    with pytest.raises(InputError, match="line 402, t: expected rows"):
        check(np.delete(EVEN[name], range(400, 403)))


def _arrays(period, missing):
    time = np.delete(np.arange(600) / 100.0, missing)
    return {"time_s": time, "acceleration_x": np.sin(2.0 * np.pi * time / period)}


def test_missing_rows_that_the_motion_bears_are_remarked():
    """A period of 1 s bears 0.06 s without rows: a line over 0.06 s errs by (2 pi)^2 0.06^2 / 8, 1.8 % of the peak."""
    arrays = _arrays(1.0, slice(400, 405))
    motion = load_motion(arrays)
    (remark,) = [remark for remark in motion_remarks(motion) if "rows are missing" in remark]
    assert remark.startswith(
        "rows are missing: 0.06 s after 3.99 s have none, where others are 0.01 s apart; 1 such"
    )
    between = np.linspace(4.0, 4.04, 9)
    read = motion.evaluate(between, 2)[:, 0]
    np.testing.assert_allclose(read, np.sin(2.0 * np.pi * between), atol=0.5 * np.pi**2 * 0.06**2)


def test_the_same_rows_of_a_faster_motion_are_refused():
    # 59 crossings lie in 5.99 s
    with pytest.raises(InputError, match=r"a quarter of the mean period is 0\.051 s"):
        load_motion(_arrays(0.2, slice(400, 405)))


def test_a_motion_without_gaps_has_no_remark():
    assert not [one for one in motion_remarks(load_motion(_arrays(1.0, []))) if "rows are missing" in one]
