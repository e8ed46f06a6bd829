"""Units as the world writes them."""

from decimal import Decimal

import pytest

from blockshake.errors import InputError
from blockshake.tables.units import kind_of_unit, leading_unit, unit_of_name, unit_size


def test_units_have_their_sizes():
    for kind, unit, size in (
        ("displacement", "mm", "0.001"), ("time", "ms", "0.001"), ("acceleration", "g", "9.80665"),
        ("acceleration", "cm/s2", "0.01"), ("acceleration", "GAL", "0.01"), ("displacement", "\N{MICRO SIGN}m", "1e-6"),
    ):  # fmt: skip
        assert unit_size(kind, unit, "here", "unit") == Decimal(size)
    assert kind_of_unit("cm/s", ("acceleration", "velocity"), "here", "unit") == "velocity"


@pytest.mark.parametrize("unit", [
    "cm/s2", "CM/S^2", "cm/s**2", "cm/sec2", "CM/SEC**2", "cm/sec^2", "CM/SEC/SEC", "CM/S/S.", "cm/s/s", "cm/s\u00b2",
    "cm s-2", "cm s^-2", "cm\u00b7s\u207b\u00b2", "(cm/s2)", "[cm/s2]", "cm/(s^2)", "cm/sec2(04)", "cm/s^2 (4)",
    "Gal", "gal.", "gals", "cm/second2", " CM / S2 ",
])  # fmt: skip
def test_a_centimetre_per_second_squared_in_any_writing(unit):
    assert unit_size("acceleration", unit, "here", "unit") == Decimal("0.01")


@pytest.mark.parametrize("unit", ["g", "G", "G.", "G,", "G;", "(G)", "[g]", "G'S", "g\u2019s", '"g"'])
def test_a_g_in_any_writing(unit):
    assert unit_size("acceleration", unit, "here", "unit") == Decimal("9.80665")


def test_a_tenth_of_g_as_a_network_writes_it():
    assert unit_size("acceleration", "G/10", "here", "unit") == Decimal("0.980665")


@pytest.mark.parametrize(
    "unit", ["", "inch", "g/100", "10g", "G*10", "cm", "cm/s", "s", "m/s3", "0.01 g", "counts", "k"]
)
def test_other_accelerations_are_refused(unit):
    with pytest.raises(InputError, match="unit: expected a unit of acceleration"):
        unit_size("acceleration", unit, "here", "unit")


def test_a_unit_before_other_words():
    for text, size in (
        ("G. FILTER POINTS: HP=0.2", "9.80665"),
        ("CM / SEC / SEC, corrected", "0.01"),
        ("mm/s2", "0.001"),
    ):
        assert leading_unit("acceleration", text, "here", "line") == Decimal(size)
    assert leading_unit("acceleration", "(02)", "here", "line") == Decimal("9.80665")
    for text in (
        "G X 10", "G / 100", "G * 10", "G 10", "CM PER SEC", "", "G (x 1000)", "G TIMES 10", "G MULTIPLY BY 10",
        "G, SCALED BY 10", "G, CORRECTED, SCALE FACTOR 10", "G SF= 10", "G (10)", "cm/s^2 (02)", "G (04)",
    ):  # fmt: skip
        with pytest.raises(InputError, match="expected a unit of acceleration"):
            leading_unit("acceleration", text, "here", "line")


def test_a_unit_in_a_column_s_name():
    assert unit_of_name("EW [cm/s\u00b2]") == ("acceleration", Decimal("0.01"))
    assert unit_of_name("time_ms") == ("time", Decimal("0.001"))
    assert unit_of_name("Weg (mm)") == ("displacement", Decimal("0.001"))
    for name in ("t/ms", "Zeit in ms", "Time(milliseconds)", "t [msec]"):
        assert unit_of_name(name) == ("time", Decimal("0.001"))
    for name in ("EW_mg", "EW (milli-g)", "EW in mg"):
        assert unit_of_name(name) == ("acceleration", Decimal("0.00980665"))
    assert unit_of_name("EW in cm/s\u00b2") == ("acceleration", Decimal("0.01"))
    assert unit_of_name("v cm/s") == ("velocity", Decimal("0.01"))
    for name, kind in (("acc_g", "acceleration"), ("t_s", "time"), ("wall/m", "displacement")):
        assert unit_of_name(name, kind)[0] == kind
    for name in ("EW_S", "peak_m", "a 3 g", "PGA = 0.35 g", "PGA: .35 g", "Peak 0.35e0 g"):
        assert unit_of_name(name, "acceleration") is None
    for name in ("EW/NS", "in phase", "time_s", "wall_m", "acc (filtered)", "a[3]", "U1", "peak_min"):
        assert unit_of_name(name) is None
