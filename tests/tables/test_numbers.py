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
