import numpy as np
import pytest

from blockshake.pages.wording import (
    MISSING,
    given,
    millimetres,
    model_label,
    number,
    parameter_label,
    percent,
)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"), (1.0, "1"), (17, "17"), (120000, "120000"), (1.2345, "1.23"), (-98.76, "-98.8"), (1234.56, "1235"),
        (0.01234, "0.0123"), (1.23e-6, "1.23e-06"), (3.45e10, "3.45e+10"), (np.nan, MISSING), (np.inf, MISSING),
    ],
)  # fmt: skip
def test_number_keeps_three_digits(value, text):
    assert number(value) == text


def test_a_model_with_settings_of_its_own_has_the_label_of_its_solver_and_its_words():
    assert model_label("nscd-rigid") == "NSCD rigid"
    assert model_label("nscd-rigid-as-printed") == "NSCD rigid as printed"
    assert [model_label(name) for name in ("all", "", "ls-dem2")] == ["all", "", "ls-dem2"]


def test_lengths_shares_and_given_numbers():
    assert (millimetres(0.12345), percent(0.4567), given(2.25), given(5e-5)) == (
        "123.5",
        "45.7",
        "2.25",
        "5e-05",
    )
    assert (millimetres(np.nan), percent(np.nan)) == (MISSING, MISSING)


def test_parameters_have_names():
    assert parameter_label("friction.concrete.steel") == "friction, concrete on steel"
    assert parameter_label("materials.steel.youngs_modulus") == "Young's modulus of steel"
