"""The one place for Numba options, with a cache that follows the sources.

Numba's own cache misses edits in imported modules and freezes globals at compile time. Every
digest of the sources that hold kernels therefore gets a cache folder of its own: an edit in any
of them compiles anew, and an unchanged package never does.

Nor is that cache safe where several processes compile at once, as Snakemake's jobs and the tests' workers do: two that
save different signatures of a kernel take the same file name, and the index of one then leads to the machine code
of the other. Saving is therefore done one at a time.

Nor does that cache know a module by its name: a copy of a checkout, or a file whose time changes, would compile all
anew. Here a kernel's place is its module's name; the digest says whether the sources are the same.
"""

import fcntl
import os
from pathlib import Path

import numba
from numba.core.caching import CacheImpl, IndexDataCacheFile, _CacheLocator
from numba.core.compiler_lock import global_compiler_lock

from blockshake.sources import compiled_sources, source_digest

SOURCE_DIGEST = source_digest(*compiled_sources())
CACHE_FOLDER = Path(os.environ.get("BLOCKSHAKE_CACHE", Path.home() / ".cache" / "blockshake")) / SOURCE_DIGEST
numba.config.CACHE_DIR = str(CACHE_FOLDER)

_save_unguarded = IndexDataCacheFile.save


def _save_alone(self, key, data):
    """Save a compiled kernel while no other process saves one."""
    CACHE_FOLDER.mkdir(parents=True, exist_ok=True)
    with open(CACHE_FOLDER / "lock", "a", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        _save_unguarded(self, key, data)


IndexDataCacheFile.save = _save_alone


class _ByModule(_CacheLocator):
    """Place of a kernel of this package in the cache: the folder of its module."""

    def __init__(self, module):
        self._path = CACHE_FOLDER / module

    def get_cache_path(self):
        """Folder of the module's kernels."""
        return str(self._path)

    def get_source_stamp(self):
        """Stamp that every copy of the same sources has."""
        return SOURCE_DIGEST

    def get_disambiguator(self):
        """Part of a file's name: no kernel's name stands twice in a module, and its lines may move."""
        return "kernel"

    @classmethod
    def from_function(cls, py_func, py_file):
        """Locator of a kernel of this package; none of any other, which Numba's own locators serve."""
        return cls(py_func.__module__) if py_func.__module__.startswith("blockshake.") else None


CacheImpl._locator_classes.insert(0, _ByModule)

_OPTIONS = {"cache": True, "nogil": True, "error_model": "numpy", "fastmath": False}
kernel = numba.njit(**_OPTIONS, _nrt=True)
inline_kernel = numba.njit(**_OPTIONS, inline="always")
# For what runs at every step. It allocates nothing and returns no array, so that it need not count who holds which
# array: an atomic instruction each time that one is taken up or laid down. Numba refuses an allocation in it, and in
# the kernels that it calls unless they say, as those above do, that they count. Its code is copied to where it is
# called, because the tables of a run are hundreds of arguments, which a call would pass one by one.
borrowing_kernel = numba.njit(**_OPTIONS, _nrt=False, forceinline=True)


def compiling():
    """Whether this thread is compiling a kernel."""
    return global_compiler_lock.is_locked()
