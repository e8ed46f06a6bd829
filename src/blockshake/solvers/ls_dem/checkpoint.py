"""A run of LS-DEM on disk between two steps: it goes on from there bit by bit as if it had not been cut."""

import hashlib
import zipfile

import numpy as np

from blockshake.dynamics.system import State
from blockshake.files import replacing
from blockshake.jit import SOURCE_DIGEST
from blockshake.solvers.ls_dem.candidates import Candidates
from blockshake.solvers.ls_dem.joints import Joints
from blockshake.solvers.ls_dem.loop import Record
from blockshake.solvers.ls_dem.progress import Progress
from blockshake.solvers.ls_dem.relative_pose import Poses


def run_key(structure, ground, parameters, record_times, time_step, rotations_blocked):
    """Digest of all that makes a run, the program included: a checkpoint serves no other."""
    digest = hashlib.sha256(SOURCE_DIGEST.encode())
    digest.update(structure.file.model_dump_json().encode())
    digest.update(parameters.model_dump_json().encode())
    digest.update(repr((time_step, rotations_blocked)).encode())
    for solid in structure.solids.values():
        digest.update(solid.vertices.tobytes())
    for values in (*ground, record_times):
        digest.update(np.ascontiguousarray(values).tobytes())
    return digest.hexdigest()


def save_checkpoint(path, key, progress, candidates, joints, record, settling_steps):
    """Write a run's state, in place of an earlier one only when it is whole."""
    arrays = {"key": np.array(key), "settling_steps": np.array(settling_steps)}
    parts = {
        "state": progress.state,
        "poses": progress.poses,
        "progress": progress[2:],
        "candidates": candidates,
        "joints": joints,
        "record": record,
    }
    for name, part in parts.items():
        arrays |= {f"{name}_{index}": array for index, array in enumerate(part)}
    with replacing(path) as temporary, open(temporary, "wb") as file:
        np.savez(file, **arrays)


def load_checkpoint(path, key):
    """State of this very run, or None where there is none that can be read."""
    try:
        with np.load(path) as arrays:
            if str(arrays["key"]) != key:
                return None
            parts = {}
            for name in ("state", "poses", "progress", "candidates", "joints", "record"):
                count = sum(entry.rpartition("_")[0] == name for entry in arrays.files)
                parts[name] = [arrays[f"{name}_{index}"] for index in range(count)]
            settling_steps = int(arrays["settling_steps"])
    except (OSError, EOFError, KeyError, ValueError, zipfile.BadZipFile):
        return None
    state = State(*parts["state"])
    poses = Poses(state.position, *parts["poses"][1:])
    progress = Progress(state, poses, *parts["progress"])
    return (
        progress, Candidates(*parts["candidates"]), Joints(*parts["joints"]), Record(*parts["record"]), settling_steps,
    )  # fmt: skip
