"""Compile every kernel of both solvers once, into the cache that later jobs share."""

import numba
import numpy as np

from blockshake.dynamics.motion import ground_motion
from blockshake.jit import SOURCE_DIGEST
from blockshake.study.simulation import MODELS, simulate


def compile_kernels():
    """Run each solver for a moment; what was compiled is returned as JSON-like values."""
    still = ground_motion("rest", np.array([0.0, 0.1]), {"x": np.zeros(2)}, "acceleration")
    for model in MODELS:
        simulate("configuration-1", still, model, duration=0.01)
    return {"source_digest": SOURCE_DIGEST, "numba": numba.__version__, "models": list(MODELS)}
