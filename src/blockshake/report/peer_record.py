"""The recorded comparison with LMGC90 that ships with the program: no study has that program at hand."""

import xarray as xr

from blockshake.errors import InputError
from blockshake.files import PACKAGE

PEER_RECORD = PACKAGE.parents[1] / "data" / "peers" / "lmgc90.nc"


def load_peer_record():
    """What ``bench/compare_lmgc90.py --record`` wrote.

    Returns
    -------
    xarray.Dataset
        ``displacement(history, program, time)`` [m], NaN after a history's end; ``largest_difference(history)``
        [m], ``acceleration(history)`` [m/s2]; ``step_time(case, program)`` [s], ``residual(case, program)``
        and ``times_faster(case)`` [1].

    Raises
    ------
    InputError
        The file is missing or no netCDF.
    """
    try:
        return xr.load_dataset(PEER_RECORD)
    except (OSError, ValueError) as error:
        raise InputError(PEER_RECORD, "", f"expected the recorded comparison with LMGC90; {error}") from None
