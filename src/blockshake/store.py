"""Finished units of work on disk, named by the digest of all that made them: a killed job goes on from them."""

import hashlib
import json
from pathlib import Path

import xarray as xr

from blockshake.errors import InputError
from blockshake.files import MADE_ANEW, replacing, write_dataset, write_json
from blockshake.interrupts import delayed_interrupts

_SEAL = 64  # bytes at the end of a kept file: the digest of its name and of all before them


def kept(path):
    """Whether a unit is in its store, as it was written under this very name.

    A file that was cut, altered or renamed is not: whoever asks makes the unit again, in its place.
    """
    try:
        content = Path(path).read_bytes()
    except OSError:
        return False
    return content[-_SEAL:] == _seal(path, content[:-_SEAL])


def keep_dataset(path, dataset, decimals=None):
    """Put an xarray Dataset into a store, whole or not at all; ``decimals`` as of `write_dataset`.

    The seal stands behind the file's own end, where readers of netCDF do not look.
    """
    _keep(path, lambda temporary: write_dataset(temporary, dataset, decimals))


def kept_value(store, key, make):
    """JSON-like value of a unit, made where the store has not got it.

    Parameters
    ----------
    store : str or path
        Folder of finished units.
    key : str
        Digest of the sources that compute and of all that they are given.
    make : callable
        Gives the value. All digits of its numbers are kept, NaN too.
    """
    path = Path(store) / f"{key}.json"
    if not kept(path):
        value = make()
        _keep(path, lambda temporary: write_json(temporary, value))
    return json.loads(path.read_bytes()[:-_SEAL])


def load_made(path, without=(), chosen=None):
    """Dataset of a netCDF file that an earlier job made, some of its variables left out.

    ``chosen``: labels by dimension, such as ``{"axis": ["x"]}``; of the variables with that dimension these alone
    are read.

    Raises
    ------
    InputError
        The file cannot be read as such.
    """
    try:
        with delayed_interrupts(), xr.open_dataset(path, drop_variables=list(without)) as found:
            return found.sel(
                {name: labels for name, labels in (chosen or {}).items() if name in found.dims}
            ).load()
    except (KeyError, OSError, RuntimeError, ValueError):
        raise InputError(path, "", MADE_ANEW.format("netCDF")) from None


def _keep(path, write):
    with replacing(path) as temporary:
        write(temporary)
        seal = _seal(path, temporary.read_bytes())
        with open(temporary, "ab") as file:
            file.write(seal)


def _seal(path, content):
    return hashlib.sha256(Path(path).name.encode() + b"\0" + content).hexdigest().encode()
