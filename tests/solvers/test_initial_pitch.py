"""Both solvers start a driven body where its motion starts: displacement from its start, pitch as given."""

import numpy as np
from both_solvers import both, solve

from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure

PITCH = 1e-5  # rad; the slab's top rises by 4 um under the block's edge, within the 0.1 mm of an equilibrium


@both
def test_start_of_displacement_is_taken_off_and_of_pitch_is_not(solver):
    structure = load_structure("configuration-1")
    time = np.linspace(0.0, 1.0, 11)
    motion = ground_motion(
        "tilted", time, {"x": np.full(11, 0.3), "pitch_y": np.full(11, PITCH)}, "displacement"
    )
    run = solve(solver, structure, np.linspace(0.0, 0.2, 41), motion)
    assert run.status == "completed"
    np.testing.assert_allclose(run.position[:, 0], structure.position[0] + np.zeros((41, 3)), atol=1e-15)
    # quaternion of a right-handed turn about y: (cos a/2, 0, sin a/2, 0)
    np.testing.assert_allclose(run.orientation[:, 0, 2], np.sin(PITCH / 2.0), rtol=1e-9)
    # the blocks do not slide on a slab tilted by 1e-5, they lean to +x with it: LS-DEM by all of the tilt, NSCD by
    # more than half, since the edge that starts 4 um inside the slab is not pushed out
    top_lean = PITCH * (structure.position[3, 2] + 0.1)
    assert 0.5 * top_lean < run.position[-1, 3, 0] < 1.2 * top_lean
