"""The table of parameters that `blockshake parameters` prints."""

import re

from blockshake.files import shipped_names
from blockshake.geometry.schema import Joint
from blockshake.geometry.structure import load_structure
from blockshake.quantities import PHYSICAL
from blockshake.study.simulation import MODELS


def parameter_table(structure=None):
    """Rows of name, unit, default, meaning and source of every parameter.

    Parameters
    ----------
    structure : str or path, optional
        Whose materials, pairs and bodies are listed one by one; the first shipped one by default.

    Returns
    -------
    list of tuple of 5 str
    """
    file = load_structure(structure or shipped_names("structures")[0]).file
    rows = []
    for quantity in PHYSICAL:
        for name, value in _instances(quantity.name, file):
            rows.append((name, quantity.unit, _shown(value), quantity.meaning, quantity.source))
    for _, schema, prefix, _ in MODELS.values():
        for name, field in schema.model_fields.items():
            meaning, source = field.description.rsplit("; ", 1)
            unit = re.search(r"\[(.*?)\]", meaning)
            words = " ".join(meaning.replace(unit.group(0), "").split()).replace(" ;", ";")
            rows.append((f"{prefix}.{name}", unit.group(1), _shown(field.default), words, source))
    return rows


def _instances(pattern, file):
    """Dotted names of this structure that a pattern stands for, with the structure's values."""
    parts = pattern.split(".")
    if parts[0] == "friction":
        suffix, key = (f".{parts[3]}", parts[3]) if len(parts) == 4 else ("", "coefficient")
        return [(f"friction.{'.'.join(entry.pair)}{suffix}", getattr(entry, key)) for entry in file.friction]
    if parts[0] == "joints":
        named = [
            (f"joints.{'.'.join(joint.bodies)}.{parts[3]}", getattr(joint, parts[3])) for joint in file.joints
        ]
        return named or [(pattern, Joint.model_fields[parts[3]].default)]
    if len(parts) == 1:
        return [(pattern, getattr(file, pattern))]
    held = getattr(file, parts[0])
    named = (
        held.items()
        if isinstance(held, dict)
        else [(getattr(item, "name", n), item) for n, item in enumerate(held)]
    )
    return [(f"{parts[0]}.{name}.{parts[2]}", getattr(item, parts[2])) for name, item in named]


def _shown(value):
    if value is None:
        return "-"
    return (
        f"{value:g}"
        if isinstance(value, float)
        else str(list(value))
        if isinstance(value, tuple)
        else str(value)
    )
