"""Printed units: the one table from SI to the unit that a reader sees."""

from typing import NamedTuple

from blockshake.pages.wording import CUBED, MICRO, SQUARED, number


class Printed(NamedTuple):
    """A printed unit: how many of it make one of the SI unit, and its name."""

    factor: float
    name: str


MICROMETRES = Printed(1e6, f"{MICRO}m")
_PRINTED = {
    "1": Printed(1.0, "1"),
    "m": Printed(1e3, "mm"),
    "s": Printed(1e3, "ms"),
    "s2": Printed(1e3, f"mm per m/s{SQUARED}"),
    "m/s": Printed(1e3, "mm/s"),
    "m/s2": Printed(1.0, f"m/s{SQUARED}"),
    "rad": Printed(1e3, "mrad"),
    "rad s2/m": Printed(1e3, f"mrad per m/s{SQUARED}"),
    "rad s/m": Printed(1e3, "mrad per m/s"),
    "kg/m3": Printed(1.0, f"kg/m{CUBED}"),
    "Pa": Printed(1e-9, "GPa"),
    "Pa s": Printed(1e-6, "MPa s"),
    "rad/(N m)": Printed(1e9, "mrad per MN m"),
    "N": Printed(1e-3, "kN"),
    "N s": Printed(1e-3, "kN s"),
    "N s/m": Printed(1e-3, "kN s/m"),
    "N/m": Printed(1e-6, "MN/m"),
    "N/m3": Printed(1e-9, f"GN/m{CUBED}"),
    "m3/N": Printed(1e9, "mm/MPa"),
}


def printed(unit):
    """Printed unit of an SI unit; a unit without an entry stands as it is.

    >>> printed("Pa")
    Printed(factor=1e-09, name='GPa')
    """
    return _PRINTED.get(unit, Printed(1.0, unit.replace("m3", f"m{CUBED}")))


def quantity(value, unit, digits=3):
    """A value with its printed unit; a share has none.

    >>> quantity(0.0123, "m"), quantity(0.5, "1")
    ('12.3 mm', '0.500')
    """
    factor, name = printed(unit)
    words = number(factor * value, digits)
    return words if name == "1" else f"{words} {name}"
