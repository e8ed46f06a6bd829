"""Checking a mapping against its schema, with pydantic's first complaint worded as one line."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from blockshake.errors import InputError

# Numbers of the schemas. A whole number is a number too; a text, true and false are not.
Finite = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Finite, Field(gt=0)]
NotNegative = Annotated[Finite, Field(ge=0)]
Fraction = Annotated[Finite, Field(ge=0, le=1)]
ProperFraction = Annotated[Finite, Field(ge=0, lt=1)]
Count = Annotated[int, Field(strict=True, ge=0)]


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
        Names the key (an entry of a list by its ``name`` where it has one) and what was expected.
    """
    try:
        return schema.model_validate(mapping)
    except ValidationError as error:
        first = error.errors()[0]
    key = ".".join(([prefix] if prefix else []) + _words(first["loc"], mapping))
    if first["type"] == "extra_forbidden":
        raise InputError(where, key, "unknown key")
    if first["type"] == "missing":
        raise InputError(where, key, "missing key")
    message = first["msg"].removeprefix("Value error, ")
    found = "" if isinstance(first["input"], dict) else f", not {first['input']!r}"
    raise InputError(where, key, f"{message[0].lower()}{message[1:]}{found}")


def _words(location, mapping):
    """Parts of a dotted key, entries of lists by name."""
    words, place = [], mapping
    for part in location:
        if isinstance(place, (list, tuple)) and isinstance(part, int) and part < len(place):
            place = place[part]
            words.append(str(place.get("name", part)) if isinstance(place, dict) else str(part))
        else:
            place = place.get(part) if isinstance(place, dict) else None
            words.append(str(part))
    return words
