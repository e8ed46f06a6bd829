"""Parameters of one structure that a sample of the design stands for."""

from blockshake.geometry.schema import EXTENSION
from blockshake.geometry.structure_file import dotted_values
from blockshake.simulation.models import solver_of


def sample_parameters(row, structure, linked):
    """Parameters of one sample that this structure has, by dotted name, from a row that has stiffness too.

    ``linked``: parameters that take another's sampled value. Parameters of a material, pair or box that the structure
    does not have are left out: configuration 1 has no steel, and only a structure that states an extension has
    parameters ``extension.NAME``.
    """
    values = {str(name): float(value) for name, value in row.items()}
    values |= {name: values[source] for name, source in linked.items() if source in values}
    return {name: value for name, value in values.items() if has_parameter(structure, name)}


def has_parameter(structure, name):
    """Whether a structure has the material, the pair or the box that a parameter describes, by its dotted name."""
    file, (kind, *parts) = structure.file, name.split(".")
    if name.startswith(EXTENSION):
        stated = dotted_values(file.model_dump(mode="json")) if file.extension else {}
        return name.removeprefix(EXTENSION) in stated
    if kind == "materials":
        return parts[0] in file.materials
    if kind == "friction":
        return any(sorted(entry.pair) == sorted(parts) for entry in file.friction)
    if kind == "shapes":
        return parts[0] in file.shapes and file.shapes[parts[0]].box is not None
    return True


def own_value(structure, name):
    """Value in a structure of the coefficient or the material's property of a dotted name; 0 where it has none."""
    kind, *parts = name.split(".")
    if kind == "friction":
        same = [entry for entry in structure.file.friction if sorted(entry.pair) == sorted(parts)]
        return same[0].coefficient if same else 0.0
    return getattr(structure.file.materials.get(parts[0]), parts[1], 0.0)


def unused_variables(variables, model, parameters):
    """Variables that cannot matter: controls that a sound measure must find at the level of chance.

    Dotted names. ``parameters``: what a sample gives to the structure, from `sample_parameters`, without what it lacks.
    """
    unused = solver_of(model).without_effect
    return [name for name in variables if name not in parameters or name.rsplit(".", 1)[1] in unused]
