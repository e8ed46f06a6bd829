"""The recorded comparison with LMGC90 that ships with the program: no study has that program at hand."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.errors import InputError
from blockshake.files import HOME

PEER_RECORD = HOME / "data" / "peers" / "lmgc90.nc"
TARGET, GOAL = 3.0, 10.0  # times faster than LMGC90
PROGRAMS = ("blockshake", "LMGC90")


class Speed(NamedTuple):
    """Cases of the record, and those that meet the target and the goal of the speed."""

    cases: int
    on_target: int
    on_goal: int


class Residual(NamedTuple):
    """Case of the largest relative residual, that residual, and the median over the cases [1]."""

    case: str
    largest: float
    median: float


def load_peer_record():
    """Record of ``bench/compare_lmgc90.py --record``, with what follows from it.

    Returns
    -------
    xarray.Dataset
        ``displacement(history, program, time)`` [m], NaN after a history's end; ``largest_difference(history)`` [m],
        ``acceleration(history)`` [m/s2]; ``step_time(case, program)`` [s], ``residual(case, program)`` and
        ``times_faster(case)`` [1]. Computed from it: ``difference(history, time)``, LMGC90 less blockshake [m];
        ``peak(history, program)`` [m]; ``excess(history)``, peak of LMGC90 over that of blockshake less 1 [1].

    Raises
    ------
    InputError
        The file is missing or no netCDF.
    """
    try:
        record = xr.load_dataset(PEER_RECORD)
    except (OSError, ValueError) as error:
        raise InputError(PEER_RECORD, "", f"expected the recorded comparison with LMGC90; {error}") from None
    displacement = record["displacement"].astype(float)
    ours, theirs = (displacement.sel(program=one, drop=True) for one in PROGRAMS)
    peak = np.abs(displacement).max("time")
    excess = peak.sel(program="LMGC90", drop=True) / peak.sel(program="blockshake", drop=True) - 1.0
    return record.assign(difference=theirs - ours, peak=peak, excess=excess)


def speed(record):
    """`Speed` of a record from `load_peer_record`: its cases that meet the target and the goal."""
    faster = record["times_faster"].to_numpy()
    return Speed(len(faster), int((faster >= TARGET).sum()), int((faster >= GOAL).sum()))


def largest_residual(record):
    """`Residual` of the case of a record in which the residual of LMGC90's contacts is largest."""
    theirs = record["residual"].sel(program="LMGC90")
    place = int(np.argmax(theirs.to_numpy()))
    return Residual(str(record["case"].values[place]), float(theirs[place]), float(theirs.median()))
