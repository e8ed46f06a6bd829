import numpy as np
import pytest
from record_files import STEP, cosmos, series

from blockshake.dynamics.records.cosmos import is_cosmos, read_cosmos
from blockshake.errors import InputError

VALUES = series(501)  # a last line that is not full


def test_values_unit_and_step():
    text = cosmos(VALUES)
    assert is_cosmos(text)
    (record,) = read_cosmos(text, "file.v2")
    np.testing.assert_allclose(record.acceleration, 0.01 * VALUES, rtol=1e-12)
    assert record.time_step == pytest.approx(STEP, rel=1e-15)
    assert record.metadata["event"] == "Made up event"


def test_columns_that_touch_are_cut_at_their_width():
    wide = -1000.0 - VALUES  # fills all nine columns
    np.testing.assert_allclose(read_cosmos(cosmos(wide), "file.v2")[0].acceleration, 0.01 * wide, rtol=1e-12)


def test_unit_code_without_a_blank():
    np.testing.assert_allclose(
        read_cosmos(cosmos(VALUES, units="cm/sec2(04)"), "file.v2")[0].acceleration, 0.01 * VALUES, rtol=1e-12
    )


def test_an_unknown_step_is_the_length_over_the_number_of_values():
    (record,) = read_cosmos(cosmos(VALUES, entries={62: -999.0}), "file.v2")
    assert record.time_step == pytest.approx(STEP, rel=1e-12)
    assert record.assumed == "a time step of 0.01 s, the length over the number of values"


def test_every_channel_is_a_record():
    records = read_cosmos(cosmos(VALUES, channels=3), "file.v2")
    assert [record.channel for record in records] == ["90 Deg", "180 Deg", "270 Deg"]
    np.testing.assert_allclose(records[2].acceleration, 0.02 * VALUES, rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (cosmos(VALUES, units="counts (50)"), r"expected a unit of acceleration .*'counts \(50\)'"),
        (
            cosmos(VALUES, entries={62: -999.0, 63: -999.0}),
            "real header, entry 62: expected the time step in ms",
        ),
        (cosmos(VALUES, entries={62: 0.0}), "real header, entry 62: expected a positive number"),
        (cosmos(VALUES).rsplit("\n", 80)[0], "expected 501 values"),
        (cosmos(VALUES)[:-9000], "line 52: expected 8 values, in 9 columns each, found 3"),
        ("nothing", "expected an acceleration series, found none"),
    ],
)
def test_wrong_files_are_named(text, message):
    with pytest.raises(InputError, match=message):
        read_cosmos(text, "file.v2")
