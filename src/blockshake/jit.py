"""The one place for Numba options, with a cache that follows the sources.

Numba's own cache misses edits in imported modules and freezes globals at compile time. Every
digest of the sources that hold kernels therefore gets a cache folder of its own: an edit in any
of them compiles anew, and an unchanged package never does.
"""

import os
from pathlib import Path

import numba

from blockshake.files import source_digest
from blockshake.sources import KERNELS

SOURCE_DIGEST = source_digest(*KERNELS)
CACHE_FOLDER = Path(os.environ.get("BLOCKSHAKE_CACHE", Path.home() / ".cache" / "blockshake")) / SOURCE_DIGEST
numba.config.CACHE_DIR = str(CACHE_FOLDER)

kernel = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath=False)
inline_kernel = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath=False, inline="always")
