"""Kernels and their parts: what becomes machine code, and which private parts of Numba that stands on."""

import gc

import numba
import numpy as np
import pytest
from numba.core.caching import IndexDataCacheFile
from numba.core.codegen import JITCodeLibrary
from numba.core.registry import cpu_target

from blockshake import jit

# The version of Numba that jit.py was written for.
WRITTEN_FOR = "0.68.1"


@jit.kernel_without_allocation
def _twice(values, index):
    return 2.0 * values[index]


@jit.kernel_without_aliasing
def _shifted_into(values, out):
    for index in range(values.size):
        out[index] = values[index] + 1.0


@jit.inner_kernel
def _sum(values):
    shifted = np.empty(values.size)
    _shifted_into(values, shifted)
    total = 0.0
    for index in range(values.size):
        total += _twice(shifted, index)
    return total


def _kernel():
    """A kernel that is compiled anew."""
    return numba.njit(**jit._OPTIONS, _nrt=True, pipeline_class=jit._whole)(
        lambda values: _sum(values) + _sum(values)
    )


@pytest.fixture
def compiled(monkeypatch):
    """Names of the libraries of which machine code is made."""
    names, make = [], JITCodeLibrary._finalize_final_module

    def noted(library):
        names.append(library.name)
        make(library)

    monkeypatch.setattr(JITCodeLibrary, "_finalize_final_module", noted)
    return names


def test_a_kernel_computes_what_its_parts_say():
    values = np.arange(5.0)
    assert _kernel()(values) == _sum(values) + _sum(values) == 60.0


def test_machine_code_is_made_of_kernels_and_not_of_their_parts(compiled):
    _kernel()(np.arange(5.0))
    assert [name for name in compiled if "lambda" in name and "_kernel" in name]
    assert not [name for name in compiled if name in ("_twice", "_sum", "_shifted_into")]


def test_garbage_is_collected_again_after_a_compilation():
    assert gc.isenabled()
    _kernel()(np.arange(5.0))
    assert gc.isenabled()
    assert not jit.compiling()


@pytest.mark.parametrize(
    ("part", "names"),
    [
        (
            JITCodeLibrary(cpu_target.target_context.codegen(), "none"),
            "_codegen _final_module _finalized _linking_libraries _get_module_for_linking _optimize_final_module "
            "_raise_if_finalized _finalize_final_module codegen finalize get_pointer_to_function enable_object_caching",
        ),
        (
            IndexDataCacheFile("folder", "kernel", "stamp"),
            "_data_path _index_name _open_for_write _source_stamp _version load save",
        ),
    ],
    ids=["JITCodeLibrary", "IndexDataCacheFile"],
)
def test_numba_has_the_private_parts_that_are_replaced_or_extended(part, names):
    """A version of Numba without one of them is named here, and jit.py is to be read before it is taken."""
    missing = [name for name in names.split() if not hasattr(part, name)]
    assert not missing, f"Numba {numba.__version__} has no {missing}; jit.py was written for {WRITTEN_FOR}"
