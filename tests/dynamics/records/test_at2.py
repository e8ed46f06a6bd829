import numpy as np
import pytest
from record_files import STEP, at2, series

from blockshake.dynamics.records.at2 import is_at2, read_at2
from blockshake.errors import InputError

VALUES = series(503) / 1000.0  # g; a last line that is not full


@pytest.mark.parametrize("sizes", [None, "  503   0.0100   NPTS, DT"])
def test_both_writings_of_the_sizes(sizes):
    text = at2(VALUES, sizes=sizes)
    assert is_at2(text)
    record = read_at2(text, "file.AT2")
    np.testing.assert_allclose(record.acceleration, 9.80665 * VALUES, rtol=1e-7)  # seven digits in the file
    assert record.time_step == STEP


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (at2(VALUES, units="FURLONGS"), "line 3: expected a unit of acceleration"),
        (at2(VALUES).replace("ACCELERATION", "VELOCITY"), "line 3: expected 'ACCELERATION"),
        (at2(VALUES).rsplit("\n", 2)[0], "NPTS: expected 503 values, found 500"),
        (at2(VALUES, sizes="no sizes"), "line 4: expected NPTS and DT"),
        (at2(VALUES, sizes="NPTS= many, DT= .01 SEC"), "NPTS: expected a positive integer, found 'many'"),
        ("one line", "four header lines"),
    ],
)
def test_wrong_files_are_named(text, message):
    with pytest.raises(InputError, match=message):
        read_at2(text, "file.AT2")
