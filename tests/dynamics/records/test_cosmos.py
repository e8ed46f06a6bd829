import numpy as np
import pytest
from record_files import STEP, cosmos, series

from blockshake.dynamics.records.cosmos import is_cosmos, read_cosmos
from blockshake.errors import InputError

VALUES = series(501)  # a last line that is not full


def test_values_unit_and_step():
    text = cosmos(VALUES)
    assert is_cosmos(text)
    record = read_cosmos(text, "file.v2")
    np.testing.assert_allclose(record.acceleration, 0.01 * VALUES, rtol=1e-12)
    assert record.time_step == pytest.approx(STEP, rel=1e-15)
    assert record.metadata["event"] == "Made up event"


def test_columns_that_touch_are_cut_at_their_width():
    wide = -1000.0 - VALUES  # fills all nine columns
    np.testing.assert_allclose(read_cosmos(cosmos(wide), "file.v2").acceleration, 0.01 * wide, rtol=1e-12)


def test_unit_code_without_a_blank():
    np.testing.assert_allclose(
        read_cosmos(cosmos(VALUES, units="cm/sec2(04)"), "file.v2").acceleration, 0.01 * VALUES, rtol=1e-12
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (cosmos(VALUES, units="counts (50)"), "expected a unit of acceleration .*'counts'"),
        (cosmos(VALUES, channels=3), "one acceleration series, found 3"),
        (cosmos(VALUES, interval=-999.0), "real header, entry 34: expected a positive number"),
        (cosmos(VALUES)[:-9000], "expected 501 values"),
        ("nothing", "one acceleration series, found 0"),
    ],
)
def test_wrong_files_are_named(text, message):
    with pytest.raises(InputError, match=message):
        read_cosmos(text, "file.v2")
