import numpy as np
import xarray as xr

from blockshake.study.peer_record import PROGRAMS, largest_residual, load_peer_record, speed


def test_excess_and_difference_are_of_lmgc90_over_blockshake():
    record = load_peer_record().sel(history="nine blocks")
    ours, theirs = (
        record["displacement"].sel(program=one).dropna("time").to_numpy().astype(float) for one in PROGRAMS
    )
    np.testing.assert_array_equal(record["difference"].dropna("time"), theirs - ours)
    excess = np.abs(theirs).max() / np.abs(ours).max() - 1.0
    assert float(record["excess"]) == excess


def test_cases_on_target_and_the_largest_residual():
    record = xr.Dataset(
        {
            "times_faster": ("case", [2.9, 3.0, 12.0]),
            "residual": (("case", "program"), [[1e-5, 1.0], [3e-1, 1.0], [1e-4, 1.0]]),
        },
        coords={"case": ["a", "b", "c"], "program": ["LMGC90", "blockshake"]},
    )
    assert speed(record) == (3, 2, 1)
    assert largest_residual(record) == ("b", 3e-1, 1e-4)
