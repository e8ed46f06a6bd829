"""Every key of a user's files with its kind, unit, default and meaning, from the schemas that check them."""

import re

from blockshake.own_files.commands import file_schema

_UNIT = re.compile(r"\s*\[([^\]]*)\]$")
_WORDS = {"string": "text", "boolean": "true or false", "integer": "whole number", "number": "number"}
_LIMITS = {
    "exclusiveMinimum": "above",
    "minimum": "at least",
    "exclusiveMaximum": "below",
    "maximum": "at most",
}


def key_rows(kind):
    """Every key of a kind of file, as `file_schema` names the kinds.

    Parameters
    ----------
    kind : str

    Returns
    -------
    list of tuple of str
        Key, value, unit, default and meaning. A list's entries have ``[]`` in their keys, a mapping's ``NAME``.
    """
    schema = file_schema(kind)
    return list(_rows(schema, schema["$defs"], ""))


def _rows(schema, known, above):
    for name, entry in schema["properties"].items():
        entry = _resolved(entry, known)
        key = f"{above}{name}"
        inner, below = _inside(entry, known)
        words = (
            entry.get("description", "") if inner is None or "description" in entry else inner["description"]
        )
        unit = _UNIT.search(words)
        yield (
            key,
            _value(entry, known),
            unit[1] if unit else "",
            _default(name, entry, schema),
            _UNIT.sub("", words),
        )
        if inner is not None:
            yield from _rows(inner, known, f"{key}{below}.")


def _resolved(entry, known):
    """An entry with its reference followed; of alternatives the one that is no null, with keys if there is one."""
    own = {name: value for name, value in entry.items() if name not in ("$ref", "anyOf")}
    choices = [inner for one in entry.get("anyOf", ()) for inner in one.get("oneOf", [one])]
    choices = [one for one in choices if one.get("type") != "null"]
    if len(choices) > 1 and not any("$ref" in one for one in choices):
        return {**own, "choices": choices}
    if choices:
        best = max(choices, key=lambda one: "$ref" in one)
        return {**_resolved(best, known), **own}
    if "$ref" in entry:
        return {**known[entry["$ref"].rpartition("/")[2]], **own}
    return entry


def _inside(entry, known):
    """Schema of the keys below an entry with the ending of its key; none where there are no keys below."""
    if "properties" in entry:
        return entry, ""
    if "items" in entry:
        inner = _resolved(entry["items"], known)
        return (inner, "[]") if "properties" in inner else (None, "")
    inner = _of_mapping(entry)
    if inner is not None:
        inner = _resolved(inner, known)
        return (inner, ".NAME") if "properties" in inner else (None, "")
    return None, ""


def _of_mapping(entry):
    """Schema of the values of a mapping with free names, if it is one."""
    if "patternProperties" in entry:
        return next(iter(entry["patternProperties"].values()))
    free = entry.get("additionalProperties")
    return free if isinstance(free, dict) else None


def _value(entry, known):
    """Kind and limits of a value in words."""
    if "choices" in entry:
        return " or ".join(_value(one, known) for one in entry["choices"])
    if "enum" in entry:
        return "one of " + ", ".join(map(str, entry["enum"]))
    if "const" in entry:
        return str(entry["const"])
    if "prefixItems" in entry:
        return (
            f"list of {len(entry['prefixItems'])}: {_value(_resolved(entry['prefixItems'][0], known), known)}"
        )
    if entry.get("type") == "array":
        inner = _resolved(entry["items"], known)
        return "list" if "properties" in inner else f"list: {_value(inner, known)}"
    if entry.get("type") == "object":
        inner = _of_mapping(entry)
        return "mapping by name" if inner is not None else "mapping"
    limits = " and ".join(f"{words} {entry[key]:g}" for key, words in _LIMITS.items() if key in entry)
    return f"{_WORDS[entry['type']]} {limits}".strip()


def _default(name, entry, schema):
    """Default in words: needed, none, its value, or where it is said."""
    if name in schema.get("required", ()):
        return "needed"
    if "default" not in entry:
        return "see meaning"
    value = entry["default"]
    if value in (None, "", [], {}):
        return "none"
    if isinstance(value, dict):
        return "that of the keys below" if "properties" in entry else "see meaning"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list):
        return ", ".join(f"{one:g}" if isinstance(one, float) else str(one) for one in value)
    return str(value)
