"""Words of a diagnosis: causes, places, sizes, and what a form from outside is."""

import numpy as np

from blockshake.diagnosis.answer.history import EDGES, FRICTION, MIDDLE
from blockshake.diagnosis.answer.places import EVERYWHERE
from blockshake.diagnosis.outside.registry import FORMS
from blockshake.effects.registry import EFFECTS
from blockshake.pages.units import Printed, printed
from blockshake.pages.wording import listed, number

NO_ERROR = "no error to remove"
_MANY = 1e6  # from which on odds are reported in words
_FINEST = 1e-3  # width of an interval below which its ends are numbers of three digits
_ALONG_X = ("force", "impulse", "offset")
_HIGH = 0.25  # of a body's height above its middle, from which on a force acts near the top


def name_of(cause):
    """A cause's name in words, effect of the registry or form from outside; of a body its own."""
    return FORMS[cause].title if cause in FORMS else EFFECTS[cause].title if cause in EFFECTS else cause


def shown_unit(unit):
    """Factor and name of the unit in which a size is shown: of a share, percent."""
    return Printed(100.0, "%") if unit == "1" else printed(unit)


def size_words(value, unit, digits=3):
    """A size with its unit: ``19.6 mm``."""
    factor, name = shown_unit(unit)
    return f"{number(factor * value, digits)} {name}"


def range_words(lower, upper, unit):
    """Two ends with their unit: ``-150 to 150 mm``."""
    factor, name = shown_unit(unit)
    return f"{number(factor * lower)} to {number(factor * upper)} {name}"


def estimate_words(name, estimate):
    """An estimate of a parameter: ``0.62 mrad per m/s2 (0.48 to 0.77)``; of one along x with its side.

    With the decimals that two digits of the interval's width have.
    """
    factor, unit = shown_unit(estimate.unit)
    values = [factor * one for one in (estimate.estimate, estimate.lower, estimate.upper)]
    side = ""
    if name in _ALONG_X and values[1] * values[2] > 0.0:
        side = " towards +x" if values[0] > 0.0 else " towards -x"
        values = [abs(values[0]), *sorted(map(abs, values[1:]))]
    middle, lower, upper = _to_two_digits_of(values[2] - values[1], values)
    return f"{middle} {unit} ({lower} to {upper}){side}"


def _to_two_digits_of(width, values):
    if not (_FINEST < width < _MANY):
        return map(number, values)
    decimals = max(0, 1 - int(np.floor(np.log10(width))))
    # adding zero makes a minus zero of the rounding a zero
    return (f"{round(one, decimals) + 0.0:.{decimals}f}" for one in values)


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
    """Parameters of a `Cause` in words: ``offset 37.7 mm (30.4 to 44.8) towards +x``."""
    return ", ".join(
        f"{name} {estimate_words(name, estimate)}" for name, estimate in cause.parameters.items()
    )


def cause_words(cause, place):
    """A `Cause` with its place in words, its sizes, and when it acts."""
    name = f"{cause.title}{f' ({place})' if place else ''}"
    return ", ".join(part for part in (name, sizes_of(cause), when_words(cause.when)) if part)


def history_words(path):
    """A `History` in a sentence: sizes by test where they change, or that one size is enough."""
    name, where = path.quantity, place_words(path.place)
    if name in (EDGES, MIDDLE, FRICTION):
        subject = f"the {name} of {where or 'all joints'}"
    else:
        subject = f"{name_of(name)}{f' ({where})' if where else ''}"
    also = "".join(f"; {name} {_by_test(path.tests, sizes)}" for name, sizes in path.derived.items())
    if not path.changes:
        return f"{subject}: one {path.parameter} in all tests is enough{also}"
    sizes = _by_test(path.tests, path.sizes) + also
    more = f"; alone this explains more than {name_of(path.beats)}" if path.beats else ""
    times = f"{times_words(path.gain)} likelier than one {path.parameter} in all tests"
    return f"{subject}, by test: {path.parameter} {sizes}; that is {times}{more}"


def _by_test(tests, sizes):
    by_test = zip(tests, sizes, strict=True)
    return listed([f"{estimate_words('', size)} in {test}" for test, size in by_test])


def when_words(when):
    """When a form from outside acts; empty of what acts all the time."""
    if "starts" in when:
        before = when.get("before", ())
        starts = (
            f"{_seconds(start)}{' or earlier' if test in before else ''} of {test}"
            for test, start in when["starts"].items()
        )
        return f"from {listed(starts)} on"
    if "blows" in when:
        blows = (f"{_seconds(one['time'])} of {test}" for test, one in when["blows"].items())
        return f"at {listed(blows)}"
    if "start" in when:
        after = " and in the tests after it" if when["lasts"] else ""
        grows = ", each time that it bears," if when.get("crushed") else ""
        return f"from {_seconds(when['start'])} of {when['test']} on{grows}{after}"
    return f"in {when['test']} alone" if "test" in when else ""


def _seconds(time):
    return f"{max(time, 0.0):.2f} s"


def times_words(odds):
    """How many times likelier, from the logarithm of the odds: ``57 times``."""
    if odds > np.log(_MANY):
        return "more than a million times"
    ratio = float(f"{np.exp(odds):.2g}")
    return f"{ratio:,.0f} times" if ratio > 10.0 else f"{number(ratio, 2)} times"


def beyond(effect, value):
    """A size in words from which on an effect would have been seen."""
    first = EFFECTS[effect].parameters[0]
    return f"{'below' if first.visible < first.null else 'beyond'} {size_words(value, first.unit, 2)}"


def chance_words(p):
    """A chance, as a number where it is not too small for one."""
    return f"p = {number(p, 2)}" if p > 1.0 / _MANY else "less than 1 in a million"


def percent_words(contrast):
    """A gain with its interval in percent: ``71 % (62 to 80 %)``; from -1 to 1 where the rival is within its errors."""
    if contrast.lower <= -1.0 and contrast.upper >= 1.0:
        return NO_ERROR
    middle, lower, upper = (
        f"{100.0 * one:.0f}" for one in (contrast.estimate, contrast.lower, contrast.upper)
    )
    return f"{middle} %" if lower == upper else f"{middle} % ({lower} to {upper} %)"


def estimate_in_si(estimate):
    """An `Estimate` in words, in its own unit: sizes of small bodies are small."""
    values = (estimate.estimate, estimate.lower, estimate.upper)
    middle, lower, upper = (f"{value:.3g}" for value in values)
    return f"{middle} ({lower} to {upper}){'' if estimate.unit == '1' else ' ' + estimate.unit}"
