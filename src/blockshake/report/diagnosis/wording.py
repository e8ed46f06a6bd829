"""Words of a diagnosis: effects, places, estimates."""

from blockshake.effects.registry import EFFECTS, title_of
from blockshake.report.document.units import interval, printed, quantity, with_unit
from blockshake.report.document.wording import number

_WHERE = {
    "input": "on the table's motion",
    "contact": "in the contacts",
    "geometry": "in the blocks' geometry and mass",
    "force": "as a force on a block",
    "observation": "in the sensors alone",
}


def acting(effect):
    """Where an effect of the registry acts, in words."""
    return _WHERE[EFFECTS[effect].acts]


def estimate_words(estimate):
    """An estimate with its interval and its unit: ``0.62 (0.48 to 0.77) mrad per m/s2``."""
    factor, _ = printed(estimate.unit)
    ends = interval(estimate.lower, estimate.upper, estimate.unit)
    return with_unit(f"{number(factor * estimate.estimate)} ({ends})", estimate.unit)


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
