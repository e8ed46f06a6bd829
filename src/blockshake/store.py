"""Finished units of work on disk, named by the digest of all that made them: a killed job goes on from them."""

import hashlib
import json
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np
import xarray as xr
from pydantic import BaseModel

from blockshake.errors import InputError
from blockshake.files import MADE_ANEW, content_digest, replacing, write_dataset, write_json
from blockshake.interrupts import delayed_interrupts

_SEAL = 64  # bytes at the end of a kept file: the digest of its name and of all before them


@dataclass(frozen=True)
class Unit:
    """One unit of work: `made` reads nothing but its fields, which are therefore all that its content follows from."""

    decimals: ClassVar[dict[str, int] | None] = None  # kept of each unit in a dataset, see `write_dataset`

    def made(self, checkpoint: Path) -> Any:
        """The content: a JSON-like value, or a Dataset with the run's ``status`` and, if there is one, ``reason``."""
        raise NotImplementedError

    @property
    def identity(self) -> str:
        """Twelve hexadecimal digits of the kind of unit and of all of its fields."""
        return content_digest(type(self).__name__, described(self))


def described(value: Any) -> Any:
    """JSON-like description of a value by its content; what has a ``digest`` is described by it.

    Raises
    ------
    TypeError
        A value of an unknown kind.
    """
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, (str, bool, int, float)):
        return value
    if isinstance(digest := getattr(value, "digest", None), str):
        return digest
    if isinstance(value, np.ndarray):
        return content_digest(value.dtype.str, value.shape, np.ascontiguousarray(value).tobytes())
    if isinstance(value, BaseModel):
        return value.model_dump(mode="json")
    if isinstance(value, Mapping):
        return {str(key): described(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [described(one) for one in value]
    if is_dataclass(value):
        return {field.name: described(getattr(value, field.name)) for field in fields(value)}
    raise TypeError(f"no description of a {type(value).__name__}")


class Store(NamedTuple):
    """Folder of finished units, the digest of the sources that make them, and who hears of each.

    A unit is named by the digest of the sources and of its identity: another source makes it anew. It goes to the
    folder at once, whole or not at all; a run that was cut short goes on from a checkpoint there. ``say`` is called
    with a line of text.
    """

    folder: str | Path
    source: str
    say: Callable = print

    def value(self, unit: Unit):
        """JSON-like value of a unit, made where the store has not got it; all digits of numbers are kept, NaN too."""
        path = self._path(unit, ".json")
        if not kept(path):
            value = unit.made(path.with_suffix(".checkpoint"))
            _keep(path, lambda temporary: write_json(temporary, value))
        return json.loads(path.read_bytes()[:-_SEAL])

    def dataset(self, words: str, unit: Unit):
        """File of the Dataset of a run, simulated where the store has not got it; a line states how the run ended.

        ``words``: which run it is.
        """
        path, how, cost, begin = self._path(unit, ".nc"), "kept", "", time.monotonic()
        if not kept(path):
            made = unit.made(path.with_suffix(".checkpoint"))
            _keep(path, lambda temporary: write_dataset(temporary, made, unit.decimals))
            how, cost = "simulated", f"; took {time.monotonic() - begin:.3g} s"
        with delayed_interrupts(), xr.open_dataset(path) as run:
            ended = f"{run.attrs['status']} {run.attrs.get('reason', '')}".rstrip()
        self.say(f"{words}, {how}: {ended}{cost}")
        return path

    def _path(self, unit, suffix):
        return Path(self.folder, content_digest(self.source, unit.identity)).with_suffix(suffix)


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
