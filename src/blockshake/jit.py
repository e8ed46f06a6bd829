"""The one place for Numba options, with a cache that follows the sources.

Numba's own cache misses edits in imported modules and freezes globals at compile time. Every
digest of the sources that hold kernels therefore gets a cache folder of its own: an edit in any
of them compiles anew, and an unchanged package never does.

Nor is that cache safe where several processes compile at once, as Snakemake's jobs and the tests' workers do, or where
one is killed: two that save different signatures of a kernel take the same file name, and the index of one then leads
to the machine code of the other. Nor does it see that a file was cut or altered. Here each signature therefore has a
file of its own, with a digest of its content; a file that is not whole is compiled anew.

Nor does that cache know a module by its name: a copy of a checkout, or a file whose time changes, would compile all
anew. Here a kernel's place is its module's name; the digest says whether the sources are the same.
"""

import functools
import hashlib
import logging
import pickle
from pathlib import Path

import numba
from numba.core.caching import CacheImpl, IndexDataCacheFile, _CacheLocator
from numba.core.compiler_lock import global_compiler_lock
from numba.core.cpu import CPUTargetOptions
from numba.core.options import TargetOptions
from numba.core.serialize import dumps

from blockshake.caches import kernel_folder
from blockshake.sources import compiled_sources, source_digest

SOURCE_DIGEST = source_digest(*compiled_sources())
CACHE_FOLDER = kernel_folder(SOURCE_DIGEST)
numba.config.CACHE_DIR = str(CACHE_FOLDER)

_log = logging.getLogger("blockshake")
_SEAL = hashlib.sha256().digest_size  # bytes


def _place(cache, key):
    """Path of the file of a kernel's signature, machine and version of Numba."""
    name = hashlib.sha256(repr((cache._version, key)).encode()).hexdigest()[:16]
    return cache._data_path(f"{cache._index_name.removesuffix('.nbi')}.{name}.nbc")


def _save(self, key, data):
    """Save a compiled kernel, whole or not at all; without room or permission it is compiled in every process."""
    content = dumps((self._source_stamp, key, data))
    path = Path(_place(self, key))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with self._open_for_write(path) as file:
            file.write(hashlib.sha256(content).digest() + content)
    except OSError as error:
        _say_not_kept(error.strerror)


@functools.cache
def _say_not_kept(reason):
    _log.warning("compiled kernels are not kept in %s: %s", CACHE_FOLDER, reason.lower())


def _load(self, key):
    """Give a compiled kernel, or None where there is no whole file of it."""
    try:
        kept = Path(_place(self, key)).read_bytes()
    except OSError:
        return None
    if hashlib.sha256(kept[_SEAL:]).digest() != kept[:_SEAL]:
        return None
    stamp, made_for, data = pickle.loads(kept[_SEAL:])
    return data if (stamp, made_for) == (self._source_stamp, key) else None


IndexDataCacheFile.save, IndexDataCacheFile.load = _save, _load


class _ByModule(_CacheLocator):
    """Place of a kernel of this package in the cache: the folder of its module."""

    def __init__(self, module):
        self._path = CACHE_FOLDER / module

    def get_cache_path(self):
        """Folder of the module's kernels."""
        return str(self._path)

    def ensure_cache_path(self):
        """Leave the folder to the first file that is saved."""

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
# The same where no array argument overlaps another one, which the compiler is told: loops over the lanes of packets,
# which are in two arrays, become vector instructions only so. Numba has the flag and no option for it.
CPUTargetOptions.noalias = TargetOptions.Mapping("noalias")
separate_kernel = numba.njit(**_OPTIONS, _nrt=False, forceinline=True, noalias=True)


def compiling():
    """Whether this thread is compiling a kernel."""
    return global_compiler_lock.is_locked()
