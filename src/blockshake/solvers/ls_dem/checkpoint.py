"""The parts of an LS-DEM run as arrays, to be saved and read back."""

from blockshake.dynamics.system import State
from blockshake.solvers.ls_dem.contact.candidates import Candidates
from blockshake.solvers.ls_dem.contact.relative_pose import Poses
from blockshake.solvers.ls_dem.joints import Joints
from blockshake.solvers.ls_dem.progress import Progress
from blockshake.solvers.record import Record


def pack(progress, candidates, joints, started, record):
    """Tuples of arrays by name."""
    return {
        "state": progress.state,
        "poses": progress.poses,
        "progress": progress[2:],
        "candidates": candidates,
        "joints": joints,
        "started": (started,),
        "record": record,
    }


def unpack(arrays):
    """Parts of a run; the positions of its poses are those of its state."""
    state = State(*arrays["state"])
    poses = Poses(state.position, *arrays["poses"][1:])
    return (
        Progress(state, poses, *arrays["progress"]),
        Candidates(*arrays["candidates"]),
        Joints(*arrays["joints"]),
        arrays["started"][0],
        Record(*arrays["record"]),
    )
