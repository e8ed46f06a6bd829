import pytest

from blockshake.effects.registry import EFFECTS
from blockshake.pages.units import printed, quantity
from blockshake.quantities import PHYSICAL


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (3.45e10, "Pa", "34.5 GPa"), (1.5e8, "Pa s", "150 MPa s"), (1.8e10, "N/m3", "18 GN/m\N{SUPERSCRIPT THREE}"),
        (0.0123, "m", "12.3 mm"), (0.5, "1", "0.500"), (2400.0, "kg/m3", "2400 kg/m\N{SUPERSCRIPT THREE}"),
        (6e-4, "rad s2/m", "0.600 mrad per m/s\N{SUPERSCRIPT TWO}"), (2e8, "N/m", "200 MN/m"), (5.0, "Hz", "5 Hz"),
        (4480.0, "N", "4.48 kN"), (1210.0, "N s", "1.21 kN s"), (3e4, "N s/m", "30 kN s/m"),
    ],
)  # fmt: skip
def test_quantities_are_in_their_printed_unit(value, unit, text):
    assert quantity(value, unit) == text


def test_no_power_of_a_metre_is_printed_without_its_exponent():
    units = {one.unit for one in PHYSICAL} | {
        one.unit for effect in EFFECTS.values() for one in effect.parameters
    }
    assert not [unit for unit in units if printed(unit).name.endswith(("m3", "s2"))]
