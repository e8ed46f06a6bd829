"""A run on disk between two steps: it goes on from there bit by bit as if it had not been cut."""

import hashlib
import time
import zipfile

import numpy as np

from blockshake.files import replacing
from blockshake.jit import SOURCE_DIGEST

NEWS = 10.0  # s of wall time between lines of progress


class Due:
    """Whether an interval of wall time has passed since it last had, or since the start.

    ``interval`` [s]; zero is always due.
    """

    def __init__(self, interval):
        self._interval, self._last = interval, time.monotonic()

    def __call__(self):
        """True once an interval."""
        now = time.monotonic()
        if now - self._last < self._interval:
            return False
        self._last = now
        return True


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
        digest.update(np.ascontiguousarray(values).tobytes())
    return digest.hexdigest()


def save_parts(path, key, parts):
    """Write tuples of arrays by name, in place of an earlier file only when they are whole."""
    arrays = {"key": np.array(key)}
    for name, part in parts.items():
        arrays |= {f"{name}_{index}": array for index, array in enumerate(part)}
    with replacing(path) as temporary, open(temporary, "wb") as file:
        np.savez(file, **arrays)


def load_parts(path, key):
    """Lists of arrays by name, or None where there is no file of this very run that can be read."""
    parts = {}
    try:
        with np.load(path) as arrays:
            if str(arrays["key"]) != key:
                return None
            for entry in arrays.files:
                name, _, index = entry.rpartition("_")
                if name:
                    parts.setdefault(name, {})[int(index)] = arrays[entry]
    except (OSError, EOFError, KeyError, ValueError, zipfile.BadZipFile):
        return None
    return {name: [part[index] for index in sorted(part)] for name, part in parts.items()}
