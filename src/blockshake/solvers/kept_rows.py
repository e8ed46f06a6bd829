"""Rows on disk that a long run has handed over, so that its memory does not grow with them."""

import shutil
from pathlib import Path

from blockshake.errors import InputError
from blockshake.solvers.checkpoint import load_parts, save_parts

AT_HAND = 2**14  # rows of the record in memory: tens of MiB


class KeptRows:
    """Folder of the rows handed over so far, a file each time, whole or not at all.

    ``reduce`` makes of `Rows` what is kept of them, tuples of arrays by name. A file serves the run whose digest it
    holds, and no other.
    """

    def __init__(self, folder, reduce):
        self._folder, self._reduce, self._key = Path(folder), reduce, None
        self._firsts = []

    def begin(self, key):
        """Forget what is there: a run starts."""
        self.remove()
        self._key, self._firsts = key, []

    def goes_on(self, key, first):
        """Whether all rows before row ``first`` of this very run are there; later ones are taken away."""
        self._key, self._firsts = key, []
        found = sorted(int(path.stem) for path in self._folder.glob("*.npz") if path.stem.isdigit())
        reached = 0
        for begin in found:
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
        """Keep rows, the first of which is row ``first`` of the run's."""
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
