"""Files of results, read for a report."""

import json

import xarray as xr

from blockshake.errors import InputError
from blockshake.files import read_text


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


def load_json(path):
    """Value of a JSON file.

    Raises
    ------
    InputError
        The file is missing or holds something else.
    """
    try:
        return json.loads(read_text(path))
    except json.JSONDecodeError as error:
        raise InputError(path, "", f"expected JSON; {error}") from None
