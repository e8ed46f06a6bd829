"""Long names and units of results."""


def describe(dataset, described):
    """Give variables and coordinates of a Dataset their attributes, in place of any that they have.

    Parameters
    ----------
    dataset : xarray.Dataset
    described : dict of str to (str, str)
        Long name and unit, by variable.
    """
    for name, (long_name, units) in described.items():
        dataset[name].attrs = {"long_name": long_name, "units": units}
