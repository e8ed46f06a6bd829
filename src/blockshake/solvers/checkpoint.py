"""A run on disk: its state between two steps, from which it goes on bit by bit, and the rows handed over."""

import hashlib
import shutil
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from blockshake.errors import InputError
from blockshake.files import replacing
from blockshake.sources import compiled_sources, source_digest

AT_HAND = 2**14  # rows of the record in memory: tens of MiB


@dataclass(frozen=True)
class Checkpoint:
    """Place of a run on disk, or none."""

    path: Path | str | None  # None keeps nothing
    key: str  # from `run_key`: a file of another run is not read
    # of the parts of the run, in their order: arrays, and named tuples of arrays or of other named tuples
    kinds: tuple[type, ...]

    def save(self, parts):
        """Write the parts of a run, in place of an earlier file only when they are whole."""
        if self.path is not None:
            arrays = _arrays(parts)
            # an array that stands at two places is one array again when it is read
            first = [next(n for n, other in enumerate(arrays) if other is array) for array in arrays]
            save_parts(self.path, self.key, {"parts": (*arrays, first)})

    def load(self):
        """Parts of the run that has this key, or None where no file of it can be read."""
        kept = load_parts(self.path, self.key) if self.path is not None else None
        if kept is None:
            return None
        *arrays, first = kept["parts"]
        read = iter([arrays[number] for number in first])
        return tuple(_rebuilt(kind, read) for kind in self.kinds)

    def remove(self):
        """Take the file away."""
        if self.path is not None:
            Path(self.path).unlink(missing_ok=True)

    def advice(self):
        """Words that tell the user of an interrupted run how it goes on."""
        if self.path is None or not Path(self.path).exists():
            return "nothing of it is saved"
        return f"the same command goes on from {self.path}"


def _arrays(part):
    """Arrays of nested tuples, in order."""
    return [array for inner in part for array in _arrays(inner)] if isinstance(part, tuple) else [part]


def _rebuilt(kind, arrays):
    """Array or named tuple of a kind, from an iterator over its arrays."""
    if not issubclass(kind, tuple):
        return next(arrays)
    return kind(*(_rebuilt(inner, arrays) for inner in kind.__annotations__.values()))


def run_key(structure, ground, parameters, record_times, time_step, *choices):
    """Digest of all that makes a run, the program included: a checkpoint serves no other."""
    digest = hashlib.sha256(source_digest(*compiled_sources()).encode())
    digest.update(type(parameters).__name__.encode())
    digest.update(structure.file.model_dump_json().encode())
    digest.update(parameters.model_dump_json().encode())
    digest.update(repr((time_step, *choices)).encode())
    for solid in structure.solids.values():
        digest.update(solid.vertices.tobytes() + solid.triangles.tobytes())
    for values in (*ground, record_times):
        digest.update(np.ascontiguousarray(values))
    return digest.hexdigest()


def save_parts(path, key, parts):
    """Write tuples of arrays by name, in place of an earlier file only when they are whole."""
    arrays = {"key": np.array(key)}
    for name, part in parts.items():
        arrays |= {f"{name}_{index}": array for index, array in enumerate(part)}
    with replacing(path) as temporary, open(temporary, "wb") as file:
        np.savez(file, **arrays)


def load_parts(path, key, names=None):
    """Lists of arrays by name, or None where there is no file of this very run that can be read.

    ``names``: those that alone are read; all by default.
    """
    parts = {}
    try:
        with np.load(path) as arrays:
            if str(arrays["key"]) != key:
                return None
            for entry in arrays.files:
                name, _, index = entry.rpartition("_")
                if name and (names is None or name in names):
                    parts.setdefault(name, {})[int(index)] = arrays[entry]
    except (OSError, EOFError, KeyError, ValueError, zipfile.BadZipFile):
        return None
    return {name: [part[index] for index in sorted(part)] for name, part in parts.items()}


class KeptRows:
    """Folder of the rows handed over so far, a file each time, whole or not at all.

    ``reduce`` makes of `Rows` what is kept of them, tuples of arrays by name. A file serves the run whose digest it
    holds, and no other.
    """

    def __init__(self, folder, reduce):
        self._folder, self._reduce, self._key = Path(folder), reduce, None
        self._firsts = []

    def begin(self, key):
        """Remove the rows of an earlier run: a new run starts."""
        self.remove()
        self._key, self._firsts = key, []

    def goes_on(self, key, first):
        """Whether all rows before row ``first`` of this very run are there; later ones are taken away."""
        self._key, self._firsts = key, []
        firsts = sorted(int(path.stem) for path in self._folder.glob("*.npz") if path.stem.isdigit())
        reached = 0
        for begin in firsts:
            if begin >= first:
                self._file(begin).unlink()
                continue
            parts = load_parts(self._file(begin), key)
            if parts is None or begin != reached:
                return False
            self._firsts.append(begin)
            reached += int(parts["count"][0])
        return reached == first

    def put(self, first, rows):
        """Keep some rows of the run; ``first`` is the number of the first of them."""
        self._folder.mkdir(parents=True, exist_ok=True)
        parts = {"count": (len(rows.time),), **self._reduce(rows)}
        save_parts(self._file(first), self._key, parts)
        self._firsts.append(first)

    def read(self, *names):
        """Yield the arrays of these names, lists by name, file after file.

        Raises
        ------
        InputError
            A file was taken away or damaged meanwhile.
        """
        for first in self._firsts:
            parts = load_parts(self._file(first), self._key, names)
            if parts is None:
                raise InputError(self._file(first), "", "expected rows of the run that writes them")
            yield parts

    def remove(self):
        """Take the folder away."""
        shutil.rmtree(self._folder, ignore_errors=True)

    def _file(self, first):
        return self._folder / f"{first:012d}.npz"
