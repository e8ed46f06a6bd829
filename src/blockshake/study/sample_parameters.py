"""What a sample of the design says of one structure."""

from blockshake.geometry.structure import load_structure


def sample_parameters(row, structure, linked):
    """Parameters of one sample that this structure has.

    Parameters
    ----------
    row : pandas.Series
        Sampled values by dotted name, stiffness among them.
    structure : str or path
        What it has no material or pair for is left out: configuration 1 has no steel.
    linked : dict of str to str
        Parameters that take the sampled value of another.

    Returns
    -------
    dict of str to float
    """
    values = {str(name): float(value) for name, value in row.items()}
    values |= {name: values[source] for name, source in linked.items() if source in values}
    file = load_structure(structure).file
    pairs = {tuple(sorted(entry.pair)) for entry in file.friction}
    return {name: value for name, value in values.items() if _has(name.split("."), file.materials, pairs)}


def _has(parts, materials, pairs):
    if parts[0] == "materials":
        return parts[1] in materials
    if parts[0] == "friction":
        return tuple(sorted(parts[1:])) in pairs
    return True
