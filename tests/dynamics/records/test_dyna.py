import numpy as np
import pytest
from record_files import STEP, dyna, series

from blockshake.dynamics.records.dyna import is_dyna, read_dyna
from blockshake.errors import InputError


def test_values_unit_and_metadata():
    text = dyna(series())
    assert is_dyna(text)
    (record,) = read_dyna(text, "file.asc")
    np.testing.assert_allclose(record.acceleration, 0.01 * series(), rtol=1e-12)
    assert record.time_step == STEP
    assert record.metadata["licence"] == "CC BY 4.0"
    assert record.metadata["stream"] == "HNE"
    assert record.metadata["moment_magnitude"] == "6.3"


def test_header_is_read_by_key_in_any_order():
    lines = dyna(series()).splitlines()
    shuffled = [*lines[63::-1], *lines[64:]]
    np.testing.assert_array_equal(
        read_dyna("\n".join(shuffled), "f")[0].acceleration, read_dyna("\n".join(lines), "f")[0].acceleration
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (dyna(series(), UNITS="furlong"), "UNITS: .*'furlong'"),
        (dyna(series(), NDATA="501"), "NDATA: expected 501 values, found 500"),
        (dyna(series(), NDATA=None), "NDATA: expected this key"),
        (dyna(series(), SAMPLING_INTERVAL_S="0"), "SAMPLING_INTERVAL_S: expected a positive number"),
        (dyna(series(), DATA_TYPE="VELOCITY"), "DATA_TYPE: expected ACCELERATION"),
        (dyna(series(), DATA_TYPE="SPECTRAL ACCELERATION"), "DATA_TYPE: expected ACCELERATION"),
        (
            dyna(series()).replace("\n0.000000\n", "\nnan\n", 1),
            "expected a finite number, found 'nan'",
        ),
        (dyna(series(1)), "at least two values"),
    ],
)
def test_wrong_files_are_named(text, message):
    with pytest.raises(InputError, match=message):
        read_dyna(text, "file.asc")
