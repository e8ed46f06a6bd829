"""Samples that climb: their capacities are Newmark's, and what the levels tell is counted right."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
import yaml

from blockshake.statistics.intervals import share_interval
from blockshake.store import Store
from blockshake.study.config import Ladder
from blockshake.study.ensembles.batch import CaseRuns
from blockshake.study.fragility.climb import climb_samples, gathered
from blockshake.study.fragility.fragility import fragility

GRAVITY, PULSE = 9.81, 0.2  # m/s2, s
PAIR = "friction.stone.stone"


def sliding(acceleration, friction):
    """Largest slip of a rigid block under a pulse of so much acceleration [m/s2] for 0.2 s each way (Newmark 1965) [m].

    The block speeds up by Coulomb's law until it has the speed of the base, which slows down in the meantime.
    """
    own = friction * GRAVITY
    meeting = 2.0 * acceleration * PULSE / (acceleration + own)
    after = meeting - PULSE
    base = 0.5 * acceleration * PULSE**2 + acceleration * PULSE * after - 0.5 * acceleration * after**2
    return base - 0.5 * own * meeting**2


@pytest.fixture
def case(make_mapping, tmp_path):
    """A sharp cube on a slab, and a motion of 1 m/s2 one way and back."""
    cube = {"name": "cube", "shape": "cube", "position": [0.0, 0.0, 0.5]}
    (tmp_path / "cube.yaml").write_text(yaml.safe_dump(make_mapping([cube])))
    time = np.arange(0.0, 1.0005, 1e-3)
    pulse = np.where(time < PULSE, 1.0, np.where(time < 2.0 * PULSE, -1.0, 0.0))
    rows = [f"{t:.4f},{a}" for t, a in zip(time, pulse, strict=True)]
    (tmp_path / "pulse.csv").write_text("\n".join(["time_s,acceleration_x", *rows]))
    return {
        "structure": str(tmp_path / "cube.yaml"),
        "motion": str(tmp_path / "pulse.csv"),
        "baseline": "auto",
        "duration": 0.6,
    }


def test_capacities_enclose_those_of_a_block_that_slides(case, tmp_path):
    rows = pd.DataFrame({PAIR: [0.3, 0.4]})
    ladder = Ladder(first=3.0, increment=0.25, highest=8.0, largest_drift=0.048)
    told = []
    runs = CaseRuns(case, "nscd-rigid", {"time_step": 1e-3}, {})
    store = Store(tmp_path / "store", "source", told.append)
    found = climb_samples(runs, rows, ladder, store)
    for sample, friction in enumerate(rows[PAIR]):
        lower, upper = (float(found[f"capacity_{side}"][sample]) for side in ("lower", "upper"))
        assert sliding(lower, friction) <= 0.048 < sliding(upper, friction)
        assert upper - lower == 0.25
        stood = 0.048 * found["drift_ratio"].sel(sample=sample, scale=lower)
        assert float(stood) == pytest.approx(sliding(lower, friction), abs=1e-3)
        assert np.isnan(found["passed"].sel(sample=sample, scale=slice(upper + 0.1, None))).all()
    assert len(told) == 2
    again = climb_samples(runs, rows, ladder, store)
    assert found.identical(again)  # from the store


@pytest.mark.parametrize(
    ("given", "limit", "expected"),
    [
        (None, 0.1, [0.5, 0.1]),
        (0.3, 0.3, [0.3, 0.3]),
        ({"narrow": 0.2}, 0.2, [0.5, 0.2]),
        ({"narrow": 0.4, "cube/slab": 0.06}, 0.06, [0.5, 0.4, 0.06]),
    ],
)
def test_a_block_and_a_joint_have_limits_of_their_own(given, limit, expected, case, make_mapping, tmp_path):
    """A cube of 1 m and a block of 0.2 m slide as far as each other: the narrow one leaves its place first."""
    mapping = make_mapping([
        {"name": "cube", "shape": "cube", "position": [0.0, 0.0, 0.5]},
        {"name": "narrow", "shape": "narrow", "position": [0.0, 1.5, 0.1]},
    ])  # fmt: skip
    mapping["shapes"]["narrow"] = {"box": [0.6, 0.2, 0.2]}
    (tmp_path / "cube.yaml").write_text(yaml.safe_dump(mapping))
    ladder = Ladder(first=4.0, increment=1.0, highest=20.0, largest_drift=given)
    runs = CaseRuns(case, "nscd-rigid", {"time_step": 1e-3}, {})
    found = climb_samples(runs, pd.DataFrame({PAIR: [0.3]}), ladder, Store(tmp_path / "store", "source", str))
    lower, upper = float(found["capacity_lower"][0]), float(found["capacity_upper"][0])
    assert sliding(lower, 0.3) <= limit < sliding(upper, 0.3)
    names = ["cube", "narrow", "slab/cube"][: len(expected)]
    np.testing.assert_array_equal(found["largest_drift"].sel(body=names), expected)


def level(scale, passed, status="completed"):
    return {"scale": scale, "passed": passed, "status": status, "reason": "", "drift_ratio": 0.1 * scale}


def test_shares_count_what_is_known_at_each_level():
    scales = np.array([1.0, 2.0, 3.0])
    climbs = [
        [level(1.0, True), level(2.0, False, "falling")],
        [level(1.0, True), level(2.0, True), level(3.0, True)],
        [level(1.0, True), level(2.0, True), level(3.0, False)],
        [level(1.0, True), level(2.0, False, "not-converged")],
    ]
    climbed = gathered(np.arange(4), climbs, scales, xr.DataArray([0.4], {"body": ["cube"]}))
    np.testing.assert_array_equal(climbed["capacity_lower"], [1.0, 3.0, 2.0, 1.0])
    np.testing.assert_array_equal(climbed["capacity_upper"], [2.0, np.inf, 3.0, np.inf])
    found = fragility(climbed)
    np.testing.assert_array_equal(found["known"], [4, 3, 3])
    np.testing.assert_allclose(found["share"], [0.0, 1.0 / 3.0, 2.0 / 3.0])
    # Clopper and Pearson of 0 in 4
    assert float(found["share_interval"].sel(bound="upper")[0]) == pytest.approx(1.0 - 0.025**0.25)
    # of the sample whose run failed nothing is known at the higher levels: 1 of 4 at least, 2 of 4 at most
    limits = [*share_interval(1, 4)[:1], *share_interval(2, 4)[1:]]
    np.testing.assert_allclose(found["share_interval"].sel(scale=2.0), limits)
    assert 2.0 < float(found["median"]) < 3.5
    assert float(found["safe_scale"]) < float(found["median"])
    assert found.identical(fragility(climbed))
    for name, variable in found.variables.items():
        assert variable.attrs.get("long_name") or name in ("sample", "bound", "quantile"), name
