"""What an LS-DEM run leaves on disk to go on from."""

from blockshake.dynamics.system import State
from blockshake.solvers.checkpoint import load_parts, save_parts
from blockshake.solvers.ls_dem.candidates import Candidates
from blockshake.solvers.ls_dem.joints import Joints
from blockshake.solvers.ls_dem.progress import Progress
from blockshake.solvers.ls_dem.relative_pose import Poses
from blockshake.solvers.record import Record


def save_checkpoint(path, key, progress, candidates, joints, record, started):
    """Write a run's state, in place of an earlier one only when it is whole."""
    parts = {
        "state": progress.state,
        "poses": progress.poses,
        "progress": progress[2:],
        "candidates": candidates,
        "joints": joints,
        "record": record,
        "started": (started,),
    }
    save_parts(path, key, parts)


def load_checkpoint(path, key):
    """State of this very run, or None where there is none that can be read."""
    parts = load_parts(path, key)
    if parts is None:
        return None
    state = State(*parts["state"])
    poses = Poses(state.position, *parts["poses"][1:])
    return (
        Progress(state, poses, *parts["progress"]),
        Candidates(*parts["candidates"]),
        Joints(*parts["joints"]),
        Record(*parts["record"]),
        parts["started"][0],
    )
