"""Compile a solver's kernels once, into the cache that later jobs share."""

import numba
import numpy as np

from blockshake.dynamics.motion import ground_motion
from blockshake.jit import SOURCE_DIGEST
from blockshake.study.simulation import simulate


def compile_kernels(model):
    """Run a solver for a moment; what was compiled is returned as JSON-like values."""
    still = ground_motion("rest", np.array([0.0, 0.1]), {"x": np.zeros(2)}, "acceleration")
    simulate("configuration-1", still, model, duration=0.01)
    return {"model": model, "kernels": SOURCE_DIGEST, "numba": numba.__version__}
