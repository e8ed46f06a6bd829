"""Parameters of one structure that a sample of the design stands for."""


def sample_parameters(row, structure, linked):
    """Parameters of one sample that this structure has, by dotted name, from a row that has stiffness too.

    ``linked``: parameters that take another's sampled value. Parameters of a material or pair that the structure does
    not have are left out: configuration 1 has no steel.
    """
    values = {str(name): float(value) for name, value in row.items()}
    values |= {name: values[source] for name, source in linked.items() if source in values}
    file = structure.file
    pairs = {tuple(sorted(entry.pair)) for entry in file.friction}
    return {name: value for name, value in values.items() if _has(name.split("."), file.materials, pairs)}


def has_parameter(structure, name):
    """Whether a structure has the material or the pair that a parameter describes, by its dotted name."""
    pairs = {tuple(sorted(entry.pair)) for entry in structure.file.friction}
    return _has(name.split("."), structure.file.materials, pairs)


def own_value(structure, name):
    """Value in a structure of the coefficient or the material's property of a dotted name; 0 where it has none."""
    kind, *parts = name.split(".")
    if kind == "friction":
        same = [entry for entry in structure.file.friction if sorted(entry.pair) == sorted(parts)]
        return same[0].coefficient if same else 0.0
    return getattr(structure.file.materials.get(parts[0]), parts[1], 0.0)


def _has(parts, materials, pairs):
    if parts[0] == "materials":
        return parts[1] in materials
    if parts[0] == "friction":
        return tuple(sorted(parts[1:])) in pairs
    return True
