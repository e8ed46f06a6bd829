"""Finished units of work on disk, named by the digest of all that made them: a killed job goes on from them."""

import hashlib
import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.errors import InputError
from blockshake.files import MADE_ANEW, content_digest, replacing, write_dataset, write_json
from blockshake.interrupts import delayed_interrupts

_SEAL = 64  # bytes at the end of a kept file: the digest of its name and of all before them


class Store(NamedTuple):
    """Folder of finished units, the digest of the sources that make them, and who hears of each.

    A unit is named by the digest of the sources and of all that it follows from beside them: another source makes it
    anew. It goes to the folder at once, whole or not at all; a run that was cut short goes on from a checkpoint there.
    ``say`` is called with a line of text.
    """

    folder: str | Path
    source: str
    say: Callable = print

    def value(self, given, make):
        """JSON-like value of a unit, made where the store has not got it.

        Parameters
        ----------
        given : sequence
            All that the unit follows from: arrays, and values as of `content_digest`.
        make : callable
            Of the path of a checkpoint: the value. All digits of its numbers are kept, NaN too.
        """
        path = self._path(given, ".json")
        if not kept(path):
            value = make(path.with_suffix(".checkpoint"))
            _keep(path, lambda temporary: write_json(temporary, value))
        return json.loads(path.read_bytes()[:-_SEAL])

    def dataset(self, words, given, make, decimals=None):
        """File of the Dataset of a run, simulated where the store has not got it; a line says how the run ended.

        Parameters
        ----------
        words : str
            Which run it is.
        given : sequence
            All that the unit follows from: arrays, and values as of `content_digest`.
        make : callable
            Of the path of a checkpoint: the Dataset, with the run's ``status`` and, where there is one, ``reason`` as
            attributes.
        decimals : dict, optional
            Decimal digits kept of each unit, see `write_dataset`.
        """
        path, how, cost, begin = self._path(given, ".nc"), "kept", "", time.monotonic()
        if not kept(path):
            made = make(path.with_suffix(".checkpoint"))
            _keep(path, lambda temporary: write_dataset(temporary, made, decimals))
            how, cost = "simulated", f"; took {time.monotonic() - begin:.3g} s"
        with delayed_interrupts(), xr.open_dataset(path) as unit:
            ended = f"{unit.attrs['status']} {unit.attrs.get('reason', '')}".rstrip()
        self.say(f"{words}, {how}: {ended}{cost}")
        return path

    def _path(self, given, suffix):
        content = (part.tobytes() if isinstance(part, np.ndarray) else part for part in given)
        return Path(self.folder, content_digest(self.source, *content)).with_suffix(suffix)


def kept(path):
    """Whether a unit is in its store, as it was written under this very name.

    A file that was cut, altered or renamed is not: whoever asks makes the unit again, in its place.
    """
    try:
        content = Path(path).read_bytes()
    except OSError:
        return False
    return content[-_SEAL:] == _seal(path, content[:-_SEAL])


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
        with delayed_interrupts(), xr.open_dataset(path, drop_variables=list(without)) as dataset:
            return dataset.sel(
                {name: labels for name, labels in (chosen or {}).items() if name in dataset.dims}
            ).load()
    except (KeyError, OSError, RuntimeError, ValueError):
        raise InputError(path, "", MADE_ANEW.format("netCDF")) from None


def _keep(path, write):
    """Write a unit, and its seal behind the file's own end, where readers of netCDF do not look."""
    with replacing(path) as temporary:
        write(temporary)
        seal = _seal(path, temporary.read_bytes())
        with open(temporary, "ab") as file:
            file.write(seal)


def _seal(path, content):
    return hashlib.sha256(Path(path).name.encode() + b"\0" + content).hexdigest().encode()


def structure_digest(structure):
    """Twelve hexadecimal digits of a structure's content, solids of meshes included."""
    solids = (solid.vertices.tobytes() for solid in structure.solids.values())
    return content_digest(structure.file.model_dump(mode="json"), *solids)
