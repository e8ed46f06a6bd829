"""Numbers as files write them."""

import numpy as np
import pytest

from blockshake.tables.numbers import missing_code, plain_number, touching_numbers


@pytest.mark.parametrize(
    ("text", "value"), [("1.0D-03", 1e-3), ("-.123E+01", -1.23), (" 7. ", 7.0), ("1d2", 100.0), ("+5", 5.0)]
)
def test_fortran_s_numbers(text, value):
    assert float(plain_number(text)) == value


@pytest.mark.parametrize(
    "text", ["", "1_0", "nan", "inf", "0x1F", "1,5", "1.2.3", "1e", "\u0661", "1 2", "--1", "*****"]
)
def test_other_text_is_no_number(text):
    assert plain_number(text) is None


def test_numbers_that_touch_are_told_apart_by_a_sign_alone():
    assert touching_numbers("-.123E+01-.456E+01") == ["-.123E+01", "-.456E+01"]
    assert touching_numbers("1.5057E+0-2.2223E+0") == ["1.5057E+0", "-2.2223E+0"]
    assert touching_numbers("123.4567890.123456") is None
    assert touching_numbers("1.5x") is None


def test_a_code_stands_out_of_the_values_around_it():
    assert missing_code(np.array([1.0, -999.0, 2.0])) == 1
    assert missing_code(np.array([1.0, np.nan, 9999.0])) == 2
    assert missing_code(np.array([998.0, 999.0, 1000.0])) is None  # a reading
    assert missing_code(np.array([-999.0, -999.0])) is None  # nothing to stand out of
    assert missing_code(np.array([1.0, 998.9])) is None


@pytest.mark.parametrize(
    "code", [-9999.99, 1e35, -1e31, 9.96921e36, 2147483647.0, -99.99, 99999.9, -8888.0, 999999.999, 1.7e38]
)
def test_every_usual_code_is_seen(code):
    assert missing_code(np.array([1.5, 20.25, code, 2.0])) == 2


def test_a_code_within_the_range_of_the_values_jumps_from_both_neighbours():
    wave = np.round(423.0 * np.sin(np.arange(600) / 10.0), 3)
    with_codes = wave.copy()
    with_codes[[200, 201]] = -999.0
    assert missing_code(with_codes) == 200
    assert missing_code(np.round(1010.0 * wave / 423.0, 3)) is None
    large = np.round(1000.0 * np.sin(np.arange(600) / 10.0), 3)
    large[np.argmax(large)] = 999.0  # a peak
    assert missing_code(large) is None
    assert missing_code(np.array([1.5, 99.99, -999.0, 2.0])) == 1
