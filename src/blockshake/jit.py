"""The one place for Numba's options: kernels, which Python calls, their parts, and a cache that follows the sources.

Numba compiles every function by itself and then once more, with all that it calls, in each function that calls it: of a
chain of calls the innermost one is compiled as often as the chain is long. Here only kernels become machine code, and
their parts are linked into them (docs/decisions/0017-compile-time.md).

Numba's own cache misses edits in imported modules and freezes globals at compile time. Here a kernel's folder is named
after its module and the digest of all that this module imports: an edit compiles anew what it touches, and a copy of a
checkout nothing.

Nor is that cache safe where several processes compile at once, as Snakemake's jobs and the tests' workers do, or where
one is killed: two that save different signatures of a kernel take the same file name, and the index of one then leads
to the machine code of the other. Nor does it see that a file was cut or altered. Here each signature therefore has a
file of its own, with a digest of its content; a file that is not whole is compiled anew.

Two private parts of Numba are replaced or extended here, `IndexDataCacheFile` and `JITCodeLibrary`; `tests/test_jit.py`
names the version that this was written for, and one that lacks them.
"""

import functools
import gc
import hashlib
import logging
import pickle
from pathlib import Path
from types import SimpleNamespace

import numba
from numba.core.caching import IndexDataCacheFile, _CacheLocator
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import AnalysisPass, register_pass
from numba.core.event import Listener, register
from numba.core.serialize import dumps
from numba.core.typed_passes import NoPythonSupportedFeatureValidation
from numba.extending import register_jitable

from blockshake.caches import kernel_folder
from blockshake.sources import module_sources, source_digest

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
        _say_not_kept(path.parents[1], error.strerror)


@functools.cache
def _say_not_kept(folder, reason):
    _log.warning("compiled kernels are not kept in %s: %s", folder, reason.lower())


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


class ByModule(_CacheLocator):
    """Place of a kernel of this package in the cache: the folder of its module and of the digest of its sources."""

    def __init__(self, module):
        self._digest = source_digest(*module_sources("/".join(module.split(".")[1:]) + ".py"))
        self._path = kernel_folder(f"{module.partition('.')[2]}-{self._digest}")

    def get_cache_path(self):
        """Folder of the module's kernels."""
        return str(self._path)

    def ensure_cache_path(self):
        """Leave the folder to the first file that is saved."""

    def get_source_stamp(self):
        """Stamp that every copy of the same sources has."""
        return self._digest

    def get_disambiguator(self):
        """Part of a file's name: no kernel's name stands twice in a module, and its lines may move."""
        return "kernel"

    @classmethod
    def from_function(cls, py_func, py_file):
        """Locator of a kernel of this package; none of any other, which Numba's own locators serve."""
        return cls(py_func.__module__) if py_func.__module__.startswith("blockshake.") else None


_NUMBAS_LOCATORS = (
    "UserProvidedCacheLocator,InTreeCacheLocator,UserWideCacheLocator,IPythonCacheLocator,ZipCacheLocator"
)
numba.config.CACHE_LOCATOR_CLASSES = "blockshake.jit.ByModule," + (
    numba.config.CACHE_LOCATOR_CLASSES or _NUMBAS_LOCATORS
)


class _Part(JITCodeLibrary):
    """Code of a part of kernels: linked into each of them, and compiled there and nowhere else."""

    codegen = SimpleNamespace(set_env=lambda name, environment: None)  # no environment to keep

    def finalize(self):
        """Leave everything to the kernels."""
        self._raise_if_finalized()
        self._finalized = True

    def get_pointer_to_function(self, name):
        """No address: a part has no machine code of its own."""
        return 0


class _OptimisedPart(_Part):
    """Code of a part that is optimised before it is linked, while its arguments are still known not to overlap."""

    def finalize(self):
        """Link and optimise."""
        self._raise_if_finalized()
        for library in _linked(self):
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._linking_libraries.clear()
        self._optimize_final_module()
        self._finalized = True


class _Whole(JITCodeLibrary):
    """Code of a kernel, with all its parts."""

    def finalize(self):
        """Link, optimise, and make machine code."""
        self._linking_libraries[:] = _linked(self)
        super().finalize()


def _linked(library):
    """Libraries that a library calls, directly or by way of parts, each once."""
    found, waiting = {}, list(library._linking_libraries)
    while waiting:
        called = waiting.pop()
        if called not in found:
            found[called] = True
            waiting += called._linking_libraries if isinstance(called, _Part) else []
    return list(found)


@functools.cache
def _say_that_it_compiles():
    _log.info("compiles the solver first, once, for about half a minute")


def _compiler(library, **flags):
    """Numba's compiler with another library, and flags that it has no options for."""

    @register_pass(mutates_CFG=False, analysis_only=True)
    class ChooseLibrary(AnalysisPass):
        _name = f"choose_library{library.__name__}"

        def __init__(self):
            pass

        def run_pass(self, state):
            if library is _Whole:
                _say_that_it_compiles()
            for name, value in flags.items():
                setattr(state.flags, name, value)
            state.library = library(state.targetctx.codegen(), state.func_id.func_qualname)
            state.library.enable_object_caching()
            return False

    class Compiler(CompilerBase):
        def define_pipelines(self):
            passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
            passes.add_pass_after(ChooseLibrary, NoPythonSupportedFeatureValidation)
            passes.finalize()
            return [passes]

    return Compiler


_OPTIONS = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
_whole, _part, _separate = _compiler(_Whole), _compiler(_Part), _compiler(_OptimisedPart, noalias=True)


def _inner(**options):
    return lambda function: register_jitable(**_OPTIONS, **options)(function)


# What Python calls: it is compiled with all its parts, and kept. A part is called by kernels, and by Python uncompiled.
kernel = numba.njit(**_OPTIONS, cache=True, _nrt=True, pipeline_class=_whole)
inner_kernel = _inner(_nrt=True, pipeline_class=_part)
# For what runs at every step. It allocates nothing and returns no array, so that it need not count who holds which
# array: an atomic instruction each time that one is taken up or laid down. Numba refuses an allocation in it, and in
# the kernels that it calls unless they say, as those above do, that they count. The code of a part is copied to where
# it is called, because the tables of a run are hundreds of arguments, which a call would pass one by one.
loop_kernel = numba.njit(**_OPTIONS, cache=True, _nrt=False, pipeline_class=_whole)
kernel_without_allocation = _inner(_nrt=False, forceinline=True, pipeline_class=_part)
# The same where no array argument overlaps another one, which the compiler assumes: loops over the lanes of packets,
# which are in two arrays, become vector instructions only so.
kernel_without_aliasing = _inner(_nrt=False, forceinline=True, pipeline_class=_separate)
# For what gives a view of an array to one of these: its statements stand in its place.
inline_kernel = numba.njit(**_OPTIONS, inline="always", pipeline_class=_whole)


class _Collection(Listener):
    """No collection of garbage while a kernel is compiled: each would walk over all that the compiler has made."""

    depth, collects = 0, True

    def on_start(self, event):
        """The compiler begins, or calls itself."""
        if self.depth == 0:
            self.collects = gc.isenabled()
            gc.disable()
        self.depth += 1

    def on_end(self, event):
        """The compiler ends, or goes back to its caller."""
        self.depth -= 1
        if self.depth == 0 and self.collects:
            gc.enable()


_collection = _Collection()
register("numba:compiler_lock", _collection)


def compiling():
    """Whether this thread is compiling a kernel."""
    return _collection.depth > 0
