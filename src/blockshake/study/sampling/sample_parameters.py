"""Parameters of one structure that a sample of the design stands for."""

from blockshake.geometry.schema import EXTENSION
from blockshake.geometry.structure_file import dotted_values
from blockshake.quantities import MOTION
from blockshake.simulation.models import part_parameters, solver_of


def sample_parameters(row, structure, linked):
    """Parameters of one sample that this structure has, by dotted name, from a row that has stiffness too.

    ``linked``: parameters that take another's sampled value. Parameters of a material, pair or box that the structure
    does not have are left out: configuration 1 has no steel, and only a structure that states an extension has
    parameters ``extension.NAME``. Those of the motion are left out too: `as_sampled` takes them.
    """
    values = {str(name): float(value) for name, value in row.items() if name not in MOTION}
    values |= {name: values[source] for name, source in linked.items() if source in values}
    return {name: value for name, value in values.items() if has_parameter(structure, name)}


def used_parameters(row, structure, linked, model):
    """`sample_parameters` without those that cannot matter to a model."""
    given = sample_parameters(row, structure, linked)
    unused = unused_variables(given, model, given)
    return {name: value for name, value in given.items() if name not in unused}


def used_columns(design, structure, linked, model):
    """Columns of a design that can matter to a model of a structure, themselves or by what takes their values."""
    given = sample_parameters(design.iloc[0], structure, linked)
    unused = set(unused_variables([*design.columns, *linked], model, given))
    by_link = {source for target, source in linked.items() if target not in unused}
    return [name for name in design.columns if name not in unused or name in by_link]


def structure_parameters(row, structure, linked):
    """`sample_parameters` without those of a solver: what `Structure.with_parameters` takes."""
    return part_parameters(sample_parameters(row, structure, linked))[0]


def has_parameter(structure, name):
    """Whether a structure has the material, the pair, the body or the box that a parameter describes, by dotted name.

    Every structure has the parameters of a solver and of the motion.
    """
    if name in MOTION or part_parameters({name: 0.0})[1]:
        return True
    file, (kind, *parts) = structure.file, name.split(".")
    if kind == "materials":
        return parts[0] in file.materials
    if kind == "friction":
        return any(sorted(entry.pair) == sorted(parts[:2]) for entry in file.friction)
    if kind == "joints":
        return set(parts[:2]) <= set(structure.body_names)
    if kind == "shapes" and (parts[0] not in file.shapes or file.shapes[parts[0]].box is None):
        return False
    if name.startswith(EXTENSION) and not file.extension:
        return False
    return name.removeprefix(EXTENSION) in dotted_values(file.model_dump(mode="json"))


def own_value(structure, name):
    """Value in a structure of the coefficient or the material's property of a dotted name; 0 where it has none."""
    kind, *parts = name.split(".")
    if kind == "friction":
        same = [entry for entry in structure.file.friction if sorted(entry.pair) == sorted(parts)]
        return same[0].coefficient if same else 0.0
    return getattr(structure.file.materials.get(parts[0]), parts[1], 0.0)


def unused_variables(variables, model, parameters):
    """Variables that cannot matter: controls that a faultless measure must find at the level of chance.

    Dotted names. ``parameters``: what a sample gives to the structure, from `sample_parameters`, without what it lacks.
    """
    solver = solver_of(model)

    def is_used(name):
        of_solver = bool(part_parameters({name: 0.0})[1])
        if of_solver:
            return name.startswith(f"{solver.prefix}.")
        return name in MOTION or (name in parameters and name.split(".")[-1] not in solver.without_effect)

    return [name for name in variables if not is_used(name)]
