import numpy as np
import pytest
from record_files import STEP, at2, series

from blockshake.dynamics.records.at2 import is_at2, read_at2
from blockshake.errors import InputError

VALUES = series(503) / 1000.0  # g; a last line that is not full


@pytest.mark.parametrize(
    "sizes",
    [
        None, "  503   0.0100   NPTS, DT", "NPTS=   503, DT= 0.01000 SEC", "NPTS=503,DT=.01",
        "DT= .0100 SEC, NPTS= 503", "DT=10.0 MSEC, NPTS=503", "503, .0100 NPTS, DT", "npts= 503, dt= 1.0D-02 sec",
        "NPTS=503., DT=.01SEC", "DT=10.MSEC NPTS=503", "NPTS= 503, DT= .01 SEC, DURATION= 5.03 SEC, FS= 100 HZ",
    ],
)  # fmt: skip
def test_all_writings_of_the_sizes(sizes):
    text = at2(VALUES, sizes=sizes)
    assert is_at2(text)
    (record,) = read_at2(text, "file.AT2")
    np.testing.assert_allclose(record.acceleration, 9.80665 * VALUES, rtol=1e-7)  # seven digits in the file
    assert record.time_step == pytest.approx(STEP, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (at2(VALUES, units="FURLONGS"), "line 3: expected a unit of acceleration"),
        (at2(VALUES, units=""), "line 3: expected a unit of acceleration"),
        (at2(VALUES, units="CM/S"), "line 3: expected a unit of acceleration"),
        (at2(VALUES).replace("ACCELERATION", "VELOCITY"), "line 3: expected 'ACCELERATION"),
        (at2(VALUES).rsplit("\n", 2)[0], "NPTS: expected 503 values, found 500"),
        (at2(VALUES, sizes="no sizes"), "line 4: expected NPTS and DT"),
        (at2(VALUES, sizes="NPTS= many, DT= .01 SEC"), "NPTS: expected a positive integer, found 'many'"),
        (at2(VALUES, sizes="NPTS= 503, DT= .01 HERTZ"), "DT: expected a unit of time"),
        (
            at2(VALUES, sizes="NPTS= 503, NPTS= 500, DT= .01"),
            "NPTS: expected this entry once, found 503 and 500",
        ),
        (at2(VALUES, sizes="NPTS= 503, DT= .01, DT= .02 SEC"), "DT: expected this entry once"),
        (at2(VALUES, sizes="NPTS= 503, DT= .01, DURATION= 10.06"), "DURATION: expected a length of 5.03 s"),
        (at2(VALUES, sizes="NPTS= 503, DT= .01, FS= 200 HZ"), "FS: expected a time step of 0.01 s"),
        (at2(VALUES).replace("ACCELERATION", "PSEUDO-ACCELERATION"), "line 3: expected 'ACCELERATION"),
        (at2(VALUES).replace("TIME SERIES", "SPECTRUM"), "line 3: expected 'ACCELERATION"),
        ("one line", "four header lines"),
    ],
)
def test_wrong_files_are_named(text, message):
    with pytest.raises(InputError, match=message):
        read_at2(text, "file.AT2")
