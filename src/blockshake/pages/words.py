"""Sentences of a page: macros of a template that stands next to the module that computes what they say."""

import functools
import re

import jinja2

from blockshake.pages.wording import (
    MISSING,
    count_words,
    given,
    listed,
    model_label,
    number,
    parameter_label,
    sentence_case,
    share_words,
)

_SMALL = 0.05  # mm, of a length that is printed as 0
_FINEST = 0.005  # mm, of a difference of lengths that is printed as 0
_WHOLE = 9.95  # mm, from which on a length is printed without decimals


def length(value):
    """A length [m] in mm, whole from 10 mm on and 0 below 0.05 mm.

    >>> length(0.0123), length(0.00123), length(5e-10)
    ('12', '1.2', '0')
    """
    shown = 1e3 * abs(float(value))
    if shown != shown:
        return MISSING
    digits = 0 if shown >= _WHOLE or shown < _SMALL else 1
    return f"{1e3 * float(value) if shown >= _SMALL else 0.0:.{digits}f}"


def fine_length(value):
    """A difference of lengths [m] in mm with two digits, 0 below 0.005 mm, which no marker reads.

    >>> fine_length(0.0123), fine_length(5e-10), fine_length(float("nan"))
    ('12', '0', 'none')
    """
    return "0" if abs(1e3 * float(value)) < _FINEST else number(1e3 * float(value), 2)


def whole_percent(share):
    """A share in whole percent."""
    return f"{100.0 * float(share):.0f}"


def span(values, show=length):
    """Smallest and largest of some values, one where they print alike: ``8.9 to 171``."""
    return " to ".join(dict.fromkeys(show(end) for end in (min(values), max(values))))


def either(count, one, many):
    """``one`` of a single thing, ``many`` of several: plurals and the verbs that go with them."""
    return one if count == 1 else many


_FILTERS = {
    "capital": lambda text: sentence_case(text)[:-1],
    "count": count_words,
    "either": either,
    "fine_mm": fine_length,
    "given": given,
    "mm": length,
    "listed": listed,
    "model": model_label,
    "models": lambda names, last="and": listed([*map(model_label, names)], last),
    "number": number,
    "parameter": parameter_label,
    "percent": whole_percent,
    "share": share_words,
}


class Words:
    """Macros of the template in ``words`` with the name of a module, which computes the facts that fill them in."""

    def __init__(self, module):
        self._package, _, name = module.rpartition(".")
        self._name = f"{name}.j2"

    def __getattr__(self, macro):
        """Function that fills the macro in: the text with single spaces."""
        return lambda *facts, **named: _one_line(self._text(macro, facts, named))

    def items(self, macro, *facts, **named):
        """Lines of a macro that are not empty: a tuple of sentences."""
        return tuple(filter(None, map(_one_line, self._text(macro, facts, named).splitlines())))

    def _text(self, macro, facts, named):
        return getattr(_environment(self._package).get_template(self._name).module, macro)(*facts, **named)


def _one_line(text):
    """Text with single spaces, none before a stop."""
    return re.sub(r" (?=[.,;:)])", "", " ".join(text.split()))


@functools.cache
def _environment(package):
    """Templates of a package; a name that nobody fills in is an error."""
    made = jinja2.Environment(
        loader=jinja2.PackageLoader(package, "words"), undefined=jinja2.StrictUndefined, autoescape=False,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    made.filters |= _FILTERS
    return made
