"""Mutations of good input: hypothesis strategies that change a mapping, a text or bytes in a few places."""

import contextlib
import copy
import datetime
import sys

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

FEW, MANY = 40, 3000  # mutations of a kind in `make test`, and in `make test-slow`


def mutations(count):
    """Settings of a test over mutations: the same ones in every run."""
    return settings(
        max_examples=count,
        derandomize=True,
        database=None,
        deadline=None,
        suppress_health_check=list(HealthCheck),
    )


def nested(depth, leaf=1):
    """Lists in lists."""
    for _ in range(depth):
        leaf = [leaf]
    return leaf


ODD_TEXTS = (
    "", " ", "x", "nan", "1e5", "../../secret.txt", "/etc/passwd", "a/b", "a\nb", "a\0b", "it's", 'a "b"',
    "; touch pwned",
    "$(touch pwned)", "{wildcards.case}", "{", "a#b", "%s", "$\\frac$", "<script>alert(1)</script>",
    "\u202eabc", "\x1b[2J",
    "\N{BOM}", "\N{PILE OF POO}", "x" * 300, "\u00e9" * 20_000, "con", ".", "..", "~", "*", "configuration-1", "alkion",
)  # fmt: skip
ODD_NUMBERS = (
    0, -1, 1, 2, 3, 7, 0.5, -0.0, 1e-308, 5e-324, 1e-12, 1e6, 1e9, 1e16, 1e30, 1e200, 1e308, -1e308, 2**31,
    2**63, 10**30,
    10**400, float("nan"), float("inf"), float("-inf"),
)  # fmt: skip
ODD_OTHERS = (
    None, True, False, [], {}, [[]], [None], {"a": {}}, {"": 1}, {"a\nb": 1}, {1: 2}, [1.0, 2.0], [1, 2, 3], ["x", "y"],
    nested(40), nested(300), datetime.date(2020, 1, 1), [0] * 2000, {f"k{n}": n for n in range(500)},
)  # fmt: skip
ODD = (*ODD_TEXTS, *ODD_NUMBERS, *ODD_OTHERS)


def places(value, path=()):
    """Paths of all values inside a mapping or a list, itself last."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, one in inner:
        yield from places(one, (*path, key))
    yield path


def at(value, path):
    """Value at a path."""
    for key in path:
        value = value[key]
    return value


@st.composite
def mutated_mappings(draw, good, odd=ODD):
    """A copy of a good mapping with one to three changes of its values, keys or entries."""
    mapping = copy.deepcopy(good)
    for _ in range(draw(st.integers(1, 3))):
        # places of a list count once by its first entry and once by any: long lists do not take all mutations
        path = draw(st.sampled_from(list(places(mapping))[:-1] or [()]))
        path = path[: draw(st.sampled_from((len(path), len(path), max(len(path) - 1, 1))))]
        if not path:
            return copy.deepcopy(draw(st.sampled_from(odd)))
        _change(draw, mapping, path, odd)
    return mapping


def _change(draw, mapping, path, odd):
    """One change at a path."""
    place, key = at(mapping, path[:-1]), path[-1]
    what = draw(st.sampled_from(("odd", "odd", "odd", "scale", "lose", "rename", "double", "other", "add")))
    value = place[key]
    if what == "scale" and _can_be_scaled(value):
        factor = draw(st.sampled_from((-1.0, 1e-9, 1e-3, 0.1, 0.999, 1.001, 2.0, 10.0, 1e3, 1e6, 1e12)))
        place[key] = float(value) * factor
    elif what == "lose":
        del place[key]
    elif what == "rename" and isinstance(place, dict):
        place[draw(st.sampled_from((*ODD_TEXTS, 1, True, None)))] = place.pop(key)
    elif what == "double" and isinstance(place, list):
        place.insert(0, copy.deepcopy(value))
    elif what == "other":
        place[key] = copy.deepcopy(at(mapping, draw(st.sampled_from(list(places(mapping))))))
    elif what == "add" and isinstance(value, dict):
        value[draw(st.sampled_from(ODD_TEXTS))] = copy.deepcopy(draw(st.sampled_from(odd)))
    else:
        place[key] = copy.deepcopy(draw(st.sampled_from(odd)))


def _can_be_scaled(value):
    """Whether it is a number that a float can hold."""
    numbers = isinstance(value, (int, float)) and not isinstance(value, bool)
    return numbers and abs(value) <= sys.float_info.max


ODD_WORDS = (
    "", "nan", "inf", "-inf", "1e999", "-1", "0", "1e-300", "1e300", "999999999999999999", "9" * 5000, "x", ",",
    ";", '"',
    "'", "\t", "\n", "\n\n", "\r", "\0", "#", ":", ": ", "- ", "&a ", "*a", "<<: *a",
    "!!python/object/apply:os.system ['x']",
    "[", "]", "{", "}", "|", ">", "%", "@", "`", "\N{BOM}", "\u2028", "\x85", "\x0c", "\N{PILE OF POO}",
    "time_s", "1,2",
    "1:30", "0x1F", "1_000", "2020-13-45", "~", "yes", "../../secret.txt",
)  # fmt: skip


@st.composite
def mutated_texts(draw, good, words=ODD_WORDS):
    """A good text cut, or with lines lost, doubled or exchanged, or words put in or in place of others."""
    text = good
    for _ in range(draw(st.integers(1, 3))):
        # half of the changes are in the first lines, where headers are
        end = draw(st.sampled_from((min(len(text), 400), len(text))))
        start = draw(st.integers(0, max(end, 0)))
        what = draw(st.sampled_from(("word", "word", "in place", "cut", "lose", "double", "any", "number")))
        if what == "cut":
            text = text[:start]
        elif what in ("lose", "double"):
            lines = text.splitlines(keepends=True) or [""]
            number = text[:start].count("\n")
            number = min(number, len(lines) - 1)
            lines[number : number + 1] = [] if what == "lose" else [lines[number]] * 2
            text = "".join(lines)
        elif what == "any":
            text = text[:start] + draw(st.text(max_size=4)) + text[start:]
        else:
            word = draw(st.sampled_from(words))
            length = 0
            if what != "word":
                rest = text[start : start + 40]
                wanted = "0123456789.eE+-" if what == "number" else "abcdefghijklmnopqrstuvwxyz_"
                ahead = next((place for place, sign in enumerate(rest) if sign in wanted), 0)
                start += ahead
                length = len(rest[ahead:]) - len(rest[ahead:].lstrip(wanted))
            text = text[:start] + word + text[start + length :]
    return text


@st.composite
def mutated_bytes(draw, good):
    """Good bytes with some flipped, lost, doubled, zeroed or cut off; mostly where the headers are."""
    content = bytearray(good)
    for _ in range(draw(st.integers(1, 4))):
        end = min(len(content), draw(st.sampled_from((64, 1024, 8192, len(good)))))
        start = draw(st.integers(0, max(end - 1, 0)))
        what = draw(st.sampled_from(("set", "set", "flip", "zero", "ones", "cut", "lose", "double", "size")))
        length = draw(st.sampled_from((1, 2, 4, 8, 64, 500)))
        if what == "cut":
            del content[start:]
        elif what == "lose":
            del content[start : start + length]
        elif what == "double":
            content[start:start] = content[start : start + length]
        elif what == "set" and start < len(content):
            content[start] = draw(st.integers(0, 255))
        elif what == "flip" and start < len(content):
            content[start] ^= 1 << draw(st.integers(0, 7))
        elif what == "size":
            content[start : start + 4] = draw(
                st.sampled_from((b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f", b"\0\0\0\1"))
            )
        else:
            piece = content[start : start + length]
            content[start : start + length] = (b"\0" if what == "zero" else b"\xff") * len(piece)
    return bytes(content)


@st.composite
def mutated_datasets(draw, good):
    """A good xarray Dataset with one to three changes of its variables, coordinates, dimensions or attributes."""
    dataset = good.copy(deep=True)
    for _ in range(draw(st.integers(1, 3))):
        what = draw(
            st.sampled_from((_value, _value, _label, _lose, _cut, _turn, _retype, _rename, _attribute, _unit))
        )
        filled = [name for name in dataset.variables if dataset[name].ndim and dataset[name].size]
        name = draw(st.sampled_from(filled or [None]))
        # a change that cannot be, such as a name twice, is none
        with contextlib.suppress(ValueError, TypeError, KeyError):
            dataset = dataset if name is None else what(draw, dataset, name)
    return dataset


def _value(draw, dataset, name):
    values = dataset[name].to_numpy().astype(float)
    odd = draw(st.sampled_from((np.nan, np.inf, -np.inf, 0.0, 1e30, 1e300, -1.0, 1e-300)))
    values[... if draw(st.booleans()) else _place(draw, values)] = odd
    return dataset.assign({name: (dataset[name].dims, values, dataset[name].attrs)})


def _label(draw, dataset, name):
    values = dataset[name].to_numpy().astype(object)
    values[_place(draw, values)] = draw(st.sampled_from(("", "x", "a\nb", "<b>", str(values.flat[0]))))
    return dataset.assign({name: (dataset[name].dims, values.astype(str))})


def _place(draw, values):
    return tuple(draw(st.integers(0, size - 1)) for size in values.shape)


def _lose(draw, dataset, name):
    return dataset.drop_vars(name)


def _cut(draw, dataset, name):
    return dataset.isel({draw(st.sampled_from(dataset[name].dims)): slice(0, draw(st.integers(0, 3)))})


def _turn(draw, dataset, name):
    return dataset.isel({dataset[name].dims[0]: slice(None, None, -1)})


def _retype(draw, dataset, name):
    return dataset.assign({name: dataset[name].astype(draw(st.sampled_from((str, "i4", "f4", "u1"))))})


def _rename(draw, dataset, name):
    return dataset.rename({name: draw(st.sampled_from(("x", "a b", "<script>", "\N{PILE OF POO}", "temp")))})


def _attribute(draw, dataset, name):
    key = draw(st.sampled_from([*dataset.attrs, "x"]))
    odd = ("", "x", "{", "[]", 1, 1.5, float("nan"), [1, 2], "1e5", "null", "5", "[" * 100_000)
    return dataset.assign_attrs({key: draw(st.sampled_from(odd))})


def _unit(draw, dataset, name):
    changed = dataset.copy()
    changed[name].attrs["units"] = draw(
        st.sampled_from(("mm", "", "days since 2000-01-01", "s", 3, "\N{PILE OF POO}"))
    )
    return changed
