"""Words of a diagnosis: causes, places, sizes, and what a form from outside is."""

from blockshake.diagnosis.answer.places import EVERYWHERE
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS, title_of
from blockshake.report.document.units import interval, printed, quantity, with_unit
from blockshake.report.document.wording import number

_SMALLEST_CHANCE = 1e-6  # that is told as a number
_LARGEST_ODDS = 1e6
_HIGH = 0.25  # of a body's height above its middle, from which on a force acts near the top


def name_of(cause):
    """A cause's name in words, effect of the registry or form from outside."""
    return FORMS[cause].title if cause in FORMS else title_of(cause)


def estimate_words(estimate):
    """An estimate with its interval and its unit: ``0.62 (0.48 to 0.77) mrad per m/s2``."""
    factor, _ = printed(estimate.unit)
    ends = interval(estimate.lower, estimate.upper, estimate.unit)
    return with_unit(f"{number(factor * estimate.estimate)} ({ends})", estimate.unit)


def place_words(place):
    """A place of a file in words, such as ``joint slab / block-1``; empty where a cause has none."""
    if "joint" in place:
        return f"joint {' / '.join(place['joint'])}"
    body = place.get("body", "")
    return f"{_level(place['height'])} of {body}" if "height" in place else body


def named_place(name, bodies):
    """A place of the evidence in words, ``block-1@0.42`` as ``top of block-1``, among the names of all bodies."""
    body, _, height = name.rpartition("@")
    if body:
        return f"{_level(float(height))} of {body}"
    return name if name in (EVERYWHERE, *bodies) else f"joint {name}"


def _level(height):
    return "top" if height > _HIGH else "middle"


def sizes_of(cause):
    """Parameters of a `Cause` in words: ``offset 37.7 (30.4 to 44.8) mm``."""
    return ", ".join(f"{name} {estimate_words(own)}" for name, own in cause.parameters.items())


def cause_words(cause, place):
    """A `Cause` with its place in words, its sizes, and when it acts."""
    name = f"{cause.title}{f' ({place})' if place else ''}"
    return ", ".join(part for part in (name, sizes_of(cause), when_words(cause.when)) if part)


def when_words(when):
    """When a form from outside acts; empty of what acts all the time."""
    if "starts" in when:
        starts = (f"{_seconds(start)} of {test}" for test, start in when["starts"].items())
        return f"from {listed(starts)} on"
    if "blows" in when:
        blows = (f"{_seconds(one['time'])} of {test}" for test, one in when["blows"].items())
        return f"at {listed(blows)}"
    if "start" in when:
        after = " and in the tests after it" if when["lasts"] else ""
        return f"from {_seconds(when['start'])} of {when['test']} on{after}"
    return f"in {when['test']} alone" if "test" in when else ""


def _seconds(time):
    return f"{max(time, 0.0):.2f} s"


def listed(words, last="and"):
    """Words in a row: ``a, b and c``."""
    *others, end = words
    return f"{', '.join(others)} {last} {end}" if others else end


def odds_words(odds):
    """Odds against a cause from their logarithm: ``1 to 57``."""
    ratio = 2.718281828459045 ** min(odds, 50.0)
    return f"1 to {number(ratio, 2)}" if ratio < _LARGEST_ODDS else f"1 to more than {_LARGEST_ODDS:,.0f}"


def beyond(effect, value):
    """A size in words from which on an effect would have been seen."""
    first = EFFECTS[effect].parameters[0]
    return f"{'below ' if first.visible < first.null else ''}{quantity(value, first.unit)}"


def chance_words(p):
    """A chance, as a number where it is not too small for one."""
    return f"p = {number(p, 2)}" if p > _SMALLEST_CHANCE else f"p below {_SMALLEST_CHANCE:g}"
