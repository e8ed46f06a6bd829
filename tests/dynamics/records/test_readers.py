"""Readers of records: metadata, headers in any order, and what they refuse; test_made_files.py has the rest."""

import numpy as np
import pytest
from record_files import STEP, at2, cosmos, dyna, series

from blockshake.dynamics.records.at2 import is_at2, read_at2
from blockshake.dynamics.records.cosmos import is_cosmos, read_cosmos
from blockshake.dynamics.records.dyna import is_dyna, read_dyna
from blockshake.errors import InputError

VALUES = series(503)  # a last line that is not full
GS = VALUES / 1000.0
SIZES = (
    None, "  503   0.0100   NPTS, DT", "NPTS=   503, DT= 0.01000 SEC", "NPTS=503,DT=.01", "DT= .0100 SEC, NPTS= 503",
    "DT=10.0 MSEC, NPTS=503", "503, .0100 NPTS, DT", "npts= 503, dt= 1.0D-02 sec", "NPTS=503., DT=.01SEC",
    "DT=10.MSEC NPTS=503", "NPTS= 503, DT= .01 SEC, DURATION= 5.03 SEC, FS= 100 HZ",
)  # fmt: skip


@pytest.mark.parametrize("sizes", SIZES)
def test_all_writings_of_the_sizes_of_an_at2(sizes):
    text = at2(GS, sizes=sizes)
    assert is_at2(text)
    (record,) = read_at2(text, "file.AT2")
    np.testing.assert_allclose(record.acceleration, 9.80665 * GS, rtol=1e-7)  # seven digits in the file
    assert record.time_step == pytest.approx(STEP, rel=1e-12)


def test_metadata_are_kept():
    text = dyna(series())
    assert is_dyna(text)
    (record,) = read_dyna(text, "file.asc")
    assert record.time_step == STEP
    assert record.metadata["licence"] == "CC BY 4.0"
    assert record.metadata["stream"] == "HNE"
    assert record.metadata["moment_magnitude"] == "6.3"
    text = cosmos(VALUES)
    assert is_cosmos(text)
    assert read_cosmos(text, "file.v2")[0].metadata["event"] == "Made up event"


def test_every_channel_of_a_cosmos_file_is_a_record():
    records = read_cosmos(cosmos(VALUES, channels=3), "file.v2")
    assert [record.channel for record in records] == ["90 Deg", "180 Deg", "270 Deg"]
    np.testing.assert_allclose(records[2].acceleration, 0.02 * VALUES, rtol=1e-12)


def test_the_header_of_a_dyna_file_is_read_by_key_in_any_order():
    lines = dyna(series()).splitlines()
    shuffled = [*lines[63::-1], *lines[64:]]
    one, other = (read_dyna("\n".join(text), "f")[0].acceleration for text in (shuffled, lines))
    np.testing.assert_array_equal(one, other)


REFUSED = [
    (read_at2, at2(GS, units="FURLONGS"), "line 3: expected a unit of acceleration"),
    (read_at2, at2(GS, units=""), "line 3: expected a unit of acceleration"),
    (read_at2, at2(GS).replace("ACCELERATION", "VELOCITY"), "line 3: expected 'ACCELERATION"),
    (read_at2, at2(GS).replace("ACCELERATION", "PSEUDO-ACCELERATION"), "line 3: expected 'ACCELERATION"),
    (read_at2, at2(GS).replace("TIME SERIES", "SPECTRUM"), "line 3: expected 'ACCELERATION"),
    (read_at2, at2(GS).rsplit("\n", 2)[0], "NPTS: expected 503 values, found 500"),
    (read_at2, at2(GS, sizes="no sizes"), "line 4: expected NPTS and DT"),
    (read_at2, at2(GS, sizes="NPTS= many, DT= .01 SEC"), "NPTS: expected a positive integer, found 'many'"),
    (read_at2, at2(GS, sizes="NPTS= 503, DT= .01 HERTZ"), "DT: expected a unit of time"),
    (
        read_at2,
        at2(GS, sizes="NPTS= 503, NPTS= 500, DT= .01"),
        "NPTS: expected this entry once, found 503 and 500",
    ),
    (read_at2, at2(GS, sizes="NPTS= 503, DT= .01, DT= .02 SEC"), "DT: expected this entry once"),
    (read_at2, at2(GS, sizes="NPTS= 503, DT= .01, DURATION= 10.06"), "DURATION: expected a length of 5.03 s"),
    (read_at2, at2(GS, sizes="NPTS= 503, DT= .01, FS= 200 HZ"), "FS: expected a time step of 0.01 s"),
    (read_at2, "one line", "four header lines"),
    (read_cosmos, cosmos(VALUES, units="counts (50)"), r"expected a unit of acceleration .*'counts \(50\)'"),
    (read_cosmos, cosmos(VALUES, entries={62: -999.0, 63: -999.0}), "entry 62: expected the time step in ms"),
    (read_cosmos, cosmos(VALUES, entries={62: 0.0}), "real header, entry 62: expected a positive number"),
    (read_cosmos, cosmos(series(501)).rsplit("\n", 80)[0], "expected 501 values"),
    (read_cosmos, cosmos(series(501))[:-9000], "line 52: expected 8 values, in 9 columns each, found 3"),
    (read_cosmos, "nothing", "expected an acceleration series, found none"),
    (read_dyna, dyna(series(), UNITS="furlong"), "UNITS: .*'furlong'"),
    (read_dyna, dyna(series(), NDATA=None), "NDATA: expected this key"),
    (read_dyna, dyna(series(), SAMPLING_INTERVAL_S="0"), "SAMPLING_INTERVAL_S: expected a positive number"),
    (read_dyna, dyna(series(), DATA_TYPE="VELOCITY"), "DATA_TYPE: expected ACCELERATION"),
    (read_dyna, dyna(series(), DATA_TYPE="SPECTRAL ACCELERATION"), "DATA_TYPE: expected ACCELERATION"),
    (
        read_dyna,
        dyna(series()).replace("\n0.000000\n", "\nnan\n", 1),
        "expected a finite number, found 'nan'",
    ),
    (read_dyna, dyna(series(1)), "at least two values"),
]


@pytest.mark.parametrize(("read", "text", "message"), REFUSED)
def test_wrong_files_are_named(read, text, message):
    with pytest.raises(InputError, match=message):
        read(text, "file")
