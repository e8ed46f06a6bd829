"""Arrays that compiled loops allocate are freed: a kernel that does not count their holders must hand none out."""

import numpy as np
import pytest
from numba.core.runtime import _nrt_python, rtsys

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import MODELS, model_of

TIME_STEP = {"ls-dem": 5e-5, "nscd-rigid": 1e-3, "nscd-elastic": 1e-3, "nscd-viscoelastic": 1e-3}
TIME = np.linspace(0.0, 1.0, 101)
SHAKEN = ground_motion("sine", TIME, {"x": 3.0 * np.sin(12.0 * TIME)}, "acceleration", {"source": "test"})


@pytest.mark.parametrize("model", sorted(MODELS))
def test_arrays_left_after_a_run_do_not_grow_with_its_steps(model):
    row, structure = model_of(model), load_structure("configuration-1")

    def left(steps):
        before = rtsys.get_allocation_stats()
        times = np.array([0.0, steps * TIME_STEP[model]])
        trajectory = row.solve(structure, SHAKEN, row.schema(), times, TIME_STEP[model])
        after = rtsys.get_allocation_stats()
        assert trajectory.status == "completed"
        return (after.mi_alloc - before.mi_alloc) - (after.mi_free - before.mi_free)

    _nrt_python.memsys_enable_stats()
    try:
        left(10)  # compiles
        assert left(400) == left(40)
    finally:
        _nrt_python.memsys_disable_stats()
