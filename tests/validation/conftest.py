import sys
from pathlib import Path

import numpy as np
import pytest

from blockshake.solvers.nscd.driver import simulate_nscd
from blockshake.solvers.nscd.parameters import NscdParameters

sys.path.insert(0, str(Path(__file__).parents[2] / "bench"))

import peers

TIME_STEP = 1e-3  # s, the paper's
EVERY = 5e-3  # s, between the poses compared


def _asking(peer):
    if peers.peer_version(peer) is None:
        pytest.skip(peers.MISSING.format(peer))

    def run(structure, motion, duration, *, time_step=TIME_STEP, **options):
        """Poses every 5 ms, without the start, as `peers.ask_peer` gives them."""
        steps, every = round(duration / time_step), round(EVERY / time_step)
        return peers.ask_peer(
            peer, peers.block_task(structure, motion, time_step, steps, record_every=every, **options)
        )

    return run


@pytest.fixture(scope="session")
def run_lmgc90():
    return _asking(peers.LMGC90)


@pytest.fixture(scope="session")
def run_mujoco():
    return _asking(peers.MUJOCO)


@pytest.fixture(scope="session")
def run_nscd():
    def run(structure, motion, duration, *, time_step=TIME_STEP):
        """Trajectory at 5, 10, 15 ... ms as a dict, rotations as matrices, like a peer's."""
        times = EVERY * np.arange(round(duration / EVERY) + 1)
        run = simulate_nscd(structure, motion, NscdParameters(), times, time_step)
        assert run.status == "completed", run.reason
        return {
            "time": run.time[1:],
            "position": run.position[1:],
            "rotation": peers.rotation_matrices(run.orientation[1:]),
        }

    return run


@pytest.fixture(scope="session")
def make_block(make_structure):
    """Structure of one sharp block on the driven slab."""

    def make(box, friction):
        block = {"name": "block", "shape": "block", "position": [0.0, 0.0, 0.5 * box[2]]}
        return make_structure([block], shapes={"block": {"box": box}}, friction=friction)

    return make


@pytest.fixture(scope="session")
def relative():
    """Horizontal displacement of the free bodies [m] since the start, with respect to the slab."""

    def subtract(run, structure, motion):
        ground = motion.evaluate(run["time"])[:, 0] - motion.evaluate(np.zeros(1))[0, 0]
        free = ~structure.driven
        return run["position"][:, free, 0] - structure.position[free, 0] - ground[:, None]

    return subtract
