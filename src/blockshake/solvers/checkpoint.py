"""A run on disk between two steps: it goes on from there bit by bit as if it had not been cut."""

import hashlib
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

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
    interval : float
        Wall time between savings [s].
    key : str
        From `run_key`: a file of another run is not read.
    layout : module
        ``pack(*parts)`` of it gives tuples of arrays by name, and ``unpack`` of these the parts again.
    """

    path: Path | str | None
    interval: float
    key: str
    layout: Any

    def save(self, parts):
        """Write the parts of a run, in place of an earlier file only when they are whole."""
        if self.path is not None:
            save_parts(self.path, self.key, self.layout.pack(*parts))

    def load(self):
        """Parts of this very run, or None where there is no file of it that can be read."""
        parts = load_parts(self.path, self.key) if self.path is not None else None
        return None if parts is None else self.layout.unpack(parts)

    def remove(self):
        """Take the file away."""
        if self.path is not None:
            Path(self.path).unlink(missing_ok=True)

    def advice(self):
        """Words that tell the user of an interrupted run how it goes on."""
        if self.path is None or not Path(self.path).exists():
            return "nothing of it is saved"
        return f"the same command goes on from {self.path}"


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
