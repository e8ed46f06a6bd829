"""Checking a mapping against its schema, with pydantic's complaints worded as one line."""

import difflib
import re
import types
from typing import Annotated, Union, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from blockshake.errors import InputError

# Numbers of the schemas. A whole number is a number too; a text, true and false are not.
Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Finite, Field(gt=0)]
NotNegative = Annotated[Finite, Field(ge=0)]
Fraction = Annotated[Finite, Field(ge=0, le=1)]
ProperFraction = Annotated[Finite, Field(ge=0, lt=1)]
Whole = Annotated[int, Field(strict=True)]
Count = Annotated[Whole, Field(ge=0)]


_SHOWN = 20  # faults in a line
_WITH_COMMA = re.compile(r"\s*[-+]?\d+,\d+([eE][-+]?\d+)?\s*")
_POINT = "numbers take a decimal point, 0.75 and not 0,75"


class Strict(BaseModel):
    """Base of every schema of the project: unknown keys are errors, values do not change."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def validated(schema, mapping, where, prefix=""):
    """Instance of a schema from a mapping.

    Parameters
    ----------
    schema : type of Strict
    mapping : dict
        As read from a file or an option.
    where : str or path
        File or option to name in an error.
    prefix : str
        Dotted key under which the mapping stands in it.

    Raises
    ------
    InputError
        Names up to 20 keys that are unknown, with the nearest known one, or missing, and the first wrong value with
        what was expected, in one line; an entry of a list by its ``name`` where it has one.
    """
    try:
        return schema.model_validate(mapping)
    except ValidationError as error:
        found = [one for one in error.errors() if one["type"] != "default_factory_not_called"][:_SHOWN]
    # a list is counted without its entries at fault
    places = [one["loc"] for one in found]
    found = [
        one for one in found if not any(one["loc"] == place[: len(one["loc"])] != place for place in places)
    ]
    wrong_values = [one for one in found if not _is_of_key(one)]
    shown = [one for one in found if _is_of_key(one) or one is wrong_values[0]]
    faults = [
        (_key((*one["loc"], *_key_inside(one)), mapping, prefix), _in_words(one, schema)) for one in shown
    ]
    if len(faults) == 1:
        raise InputError(where, *faults[0])
    raise InputError(where, "", "; ".join(f"{key}: {said}" for key, said in faults))


def _is_of_key(error):
    return error["type"] in ("missing", "extra_forbidden", "invalid_key")


def _input_error(error):
    """The `InputError` with which a validator of a schema refused a value, or none."""
    cause = error.get("ctx", {}).get("error")
    return cause if isinstance(cause, InputError) else None


def _key_inside(error):
    """Key at fault inside the value that a validator refused, which the refusal names from the value's own name on."""
    refusal = _input_error(error)
    return refusal.key.split(".")[1:] if refusal else ()


def _in_words(error, schema):
    """One fault in words, without its key."""
    if refusal := _input_error(error):
        return refusal.expected
    if error["type"] == "missing":
        return "missing key"
    if error["type"] == "extra_forbidden" and str(error["loc"][-1]).lower() == "true":
        return "unknown key; other programs read an on without quotes as true: write on"
    if error["type"] == "invalid_key":
        return f"a key of letters was expected; {_POINT}"
    if error["type"] == "extra_forbidden":
        *place, name = error["loc"]
        near = difflib.get_close_matches(str(name), _known_keys(schema, place), n=1)
        return f"unknown key, did you mean {near[0]}?" if near else "unknown key"
    message = error["msg"].removeprefix("Value error, ")
    found = "" if isinstance(error["input"], dict) else f", not {error['input']!r}"
    if isinstance(error["input"], str) and _WITH_COMMA.fullmatch(error["input"]):
        found += f"; {_POINT}"
    return f"{message[0].lower()}{message[1:]}{found}"


def _known_keys(schema, location):
    """Keys that a schema knows at a place."""
    kinds = [schema]
    for part in location:
        kinds = [inner for kind in kinds for inner in _inside(kind, part)]
    return [name for kind in kinds if _is_schema(kind) for name in kind.model_fields]


def _inside(kind, part):
    """Kinds of values under a part of a key."""
    if _is_schema(kind):
        return _alternatives(kind.model_fields[part].annotation) if part in kind.model_fields else []
    arguments = get_args(kind)
    if not arguments:
        return []
    return _alternatives(arguments[-1] if get_origin(kind) is dict else arguments[0])


def _alternatives(annotation):
    """Kinds that an annotation allows."""
    if get_origin(annotation) in (Union, types.UnionType):
        return [inner for one in get_args(annotation) for inner in _alternatives(one)]
    return [annotation]


def _is_schema(kind):
    return isinstance(kind, type) and issubclass(kind, BaseModel)


def called(index, item):
    """Name of an entry of a list, a dict: its own, those of its pair, or its number."""
    pair = item.get("pair") or item.get("bodies")
    is_pair = isinstance(pair, (list, tuple)) and all(isinstance(one, str) for one in pair)
    return ".".join(pair) if is_pair else str(item.get("name", index))


def _key(location, mapping, prefix):
    return ".".join(([prefix] if prefix else []) + _words(location, mapping))


def _words(location, mapping):
    """Parts of a dotted key, entries of lists by name; without tags of kinds that a value may be of, in brackets."""
    words, place = [], mapping
    for part in location:
        if str(part).startswith("("):
            continue
        if isinstance(place, (list, tuple)) and isinstance(part, int) and part < len(place):
            place = place[part]
            words.append(called(part, place) if isinstance(place, dict) else str(part))
        else:
            place = place.get(part) if isinstance(place, dict) else None
            words.append(str(part))
    return words
