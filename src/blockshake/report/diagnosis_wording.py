"""Words of a diagnosis: effects, places, parameters in units that are read easily."""

from blockshake.effects.registry import EFFECTS
from blockshake.report.wording import CUBED, SQUARED, number

# SI unit of a parameter or feature: how many of the printed unit it makes
_PRINTED = {
    "1": (1.0, ""),
    "m": (1e3, "mm"),
    "s": (1e3, "ms"),
    "s2": (1e3, f"mm per m/s{SQUARED}"),
    "m/s": (1e3, "mm/s"),
    "m/s2": (1.0, f"m/s{SQUARED}"),
    "N/m": (1e-6, "MN/m"),
    "m3/N": (1e9, "mm/MPa"),
    "rad": (1e3, "mrad"),
    "rad s2/m": (1e3, f"mrad per m/s{SQUARED}"),
    "rad s/m": (1e3, "mrad per m/s"),
}
_WHERE = {
    "input": "on the table's motion",
    "contact": "in the contacts",
    "geometry": "in the blocks' geometry and mass",
    "force": "as a force on a block",
    "observation": "in the sensors alone",
}


def title_of(effect):
    """An effect's name in words; one that is not in the registry is a sensor fault by its own name."""
    return EFFECTS[effect].title if effect in EFFECTS else effect.replace("-", " ")


def acting(effect):
    """Where an effect of the registry acts, in words."""
    return _WHERE[EFFECTS[effect].acts]


def printed(unit):
    """Factor from SI and name of the unit that a value is printed in; a unit without an entry stands as it is."""
    return _PRINTED.get(unit, (1.0, unit.replace("m3", f"m{CUBED}")))


def quantity(value, unit, digits=3):
    """A value with its unit."""
    factor, name = printed(unit)
    return f"{number(factor * value, digits)} {name}".rstrip()


def interval(lower, upper, unit, digits=3):
    """Two ends in the printed unit, which is not named."""
    factor, _ = printed(unit)
    return f"{number(factor * lower, digits)} to {number(factor * upper, digits)}"


def estimate_words(estimate):
    """An estimate with its interval and its unit: ``0.62 (0.48 to 0.77) mrad per m/s2``."""
    factor, name = printed(estimate.unit)
    ends = interval(estimate.lower, estimate.upper, estimate.unit)
    return f"{number(factor * estimate.estimate)} ({ends}) {name}".rstrip()


def place_words(place):
    """Where an effect is, such as ``joint slab / block-1``; empty where it has no place."""
    words = [
        value
        if kind in ("body", "axis")
        else f"{kind} {value if isinstance(value, str) else ' / '.join(value)}"
        for kind, value in place.items()
    ]
    return ", ".join(words)


def with_place(effect, place):
    """An effect with where it is: ``joint of low friction (joint slab / block-1)``."""
    words = place_words(place)
    return f"{title_of(effect)} ({words})" if words else title_of(effect)


def size_in_unit(effect, size):
    """A size in units of the visible one as a value of the effect's first parameter, in SI."""
    first = EFFECTS[effect].parameters[0]
    return first.null + size * (first.visible - first.null)


def beyond(effect, value):
    """A size in words from which on an effect would have been seen."""
    first = EFFECTS[effect].parameters[0]
    if first.visible < first.null:
        return f"below {quantity(value, first.unit)}"
    sign = "\N{PLUS-MINUS SIGN}" if first.lower < first.null else ""
    return f"beyond {sign}{quantity(value, first.unit)}"
