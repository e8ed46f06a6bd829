"""Files of results, read for a report."""

import xarray as xr

from blockshake.errors import InputError


def load_results(path):
    """Dataset of a netCDF file.

    Raises
    ------
    InputError
        The file is missing or holds something else.
    """
    try:
        return xr.load_dataset(path)
    except (OSError, ValueError) as error:
        raise InputError(path, "", f"expected a netCDF file of results; {error}") from None
