"""The table of parameters that `blockshake parameters` prints."""

from blockshake.files import shipped_names
from blockshake.geometry.schema import Joint
from blockshake.geometry.structure import load_structure
from blockshake.quantities import PHYSICAL
from blockshake.simulation.models import MODELS


def parameter_table(structure=None):
    """Rows of name, unit, default, meaning and source of every parameter, a tuple of text each.

    Parameters
    ----------
    structure : str or path, optional
        Whose materials, pairs and bodies are listed one by one, with its contact stiffness; the first shipped one by
        default.
    """
    loaded = load_structure(structure or shipped_names("structures")[0])
    file, rows = loaded.file, []
    for quantity in PHYSICAL:
        for name, value in instances(quantity.name, file):
            rows.append((name, quantity.unit, _shown(value), quantity.meaning, quantity.source))
    numerical, stiffness = {}, {}
    for model in MODELS.values():
        # some models share their parameters
        numerical |= model.numerical_parameters()
        stiffness |= model.stiffness_of(loaded)
    for name, (default, unit, meaning, source) in numerical.items():
        rows.append((name, unit, _shown(stiffness.get(name, default)), meaning, source))
    return rows


def instances(pattern, file):
    """Dotted names that the name of a `Quantity` stands for in a structure file, and their values there."""
    parts = pattern.split(".")
    if parts[0] == "friction":
        suffix, key = (f".{parts[3]}", parts[3]) if len(parts) == 4 else ("", "coefficient")
        return [(f"friction.{'.'.join(entry.pair)}{suffix}", getattr(entry, key)) for entry in file.friction]
    if parts[0] == "joints":
        key = parts[3]
        named = [(f"joints.{'.'.join(joint.bodies)}.{key}", getattr(joint, key)) for joint in file.joints]
        return named or [(pattern, Joint.model_fields[key].default)]
    if len(parts) == 1:
        return [(pattern, getattr(file, pattern))]
    named = held = getattr(file, parts[0])
    if not isinstance(held, dict):
        named = {getattr(item, "name", number): item for number, item in enumerate(held)}
    return [(f"{parts[0]}.{name}.{parts[2]}", getattr(item, parts[2])) for name, item in named.items()]


def _shown(value):
    if isinstance(value, float):
        return f"{value:g}"
    return "-" if value is None else str(list(value) if isinstance(value, tuple) else value)
