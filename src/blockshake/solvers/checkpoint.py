"""A run on disk between two steps: it goes on from there bit by bit as if it had not been cut."""

import hashlib
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from blockshake.files import replacing
from blockshake.jit import SOURCE_DIGEST


@dataclass(frozen=True)
class Checkpoint:
    """Place of a run on disk, or none.

    Attributes
    ----------
    path : path or None
        None keeps nothing.
    key : str
        From `run_key`: a file of another run is not read.
    kinds : tuple of type
        Of the parts of the run, in their order: arrays, and named tuples of arrays or of other named tuples.
    """

    path: Path | str | None
    key: str
    kinds: tuple[type, ...]

    def save(self, parts):
        """Write the parts of a run, in place of an earlier file only when they are whole."""
        if self.path is not None:
            arrays = _arrays(parts)
            # an array that stands at two places is one array again when it is read
            first = [next(n for n, other in enumerate(arrays) if other is array) for array in arrays]
            save_parts(self.path, self.key, {"parts": (*arrays, first)})

    def load(self):
        """Parts of this very run, or None where there is no file of it that can be read."""
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
    digest = hashlib.sha256(SOURCE_DIGEST.encode())
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
