"""Compile a solver's kernels once, into the cache that later jobs share."""

import numba
import numpy as np

from blockshake import jit
from blockshake.dynamics.motion import ground_motion
from blockshake.simulation.simulate import simulate


def compile_kernels(model):
    """Run a solver for a moment; the model and the digests of its compiled kernels are returned, JSON-like."""
    still = ground_motion("rest", np.array([0.0, 0.1]), {"x": np.zeros(2)}, "acceleration")
    simulate("configuration-1", still, model, duration=0.01)
    return {"model": model, "kernels": jit.SOURCE_DIGEST, "numba": numba.__version__}
