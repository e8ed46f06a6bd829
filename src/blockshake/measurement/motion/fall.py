"""The end of a measured test: from the fall of a block on, no joint is where it was."""

from typing import NamedTuple

import numpy as np

from blockshake.dynamics.collapse import COSINE_OF_TILT, collapse_limits
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.body_frame import without_outliers
from blockshake.measurement.motion.body_poses import body_poses, driven_body

_SCREEN = 0.5  # of the smallest drop that counts: markers that stay as near to each other need no poses


class Fall(NamedTuple):
    """Body that has fallen first, and the time from which it lies [s]."""

    body: str
    time: float


def find_fall(test, structure, sensors):
    """`Fall` in a test, or None: by the criterion of `find_collapsed`, from an instant to the end of the record.

    The test is as in a campaign. A block that touches nothing at the start, as one that is dropped, has nothing to fall
    from.
    """
    supported, drop_limit = collapse_limits(structure)
    if not supported.any():
        return None
    moved = test["marker_displacement"].transpose("time", "marker", "axis").to_numpy()
    if not (np.ptp(np.nan_to_num(moved), axis=1).max() > _SCREEN * drop_limit[supported].min()):
        return None
    poses = body_poses(without_outliers(test, structure), structure, sensors.marker_noise)
    moved = poses.position[..., 2] - structure.position[:, 2]
    drop = moved[:, [driven_body(structure, poses)]] - moved
    upward = rotation_matrices(structure.orientation)[:, 2]  # in the axes of each body
    upright = np.einsum("tbi,bi->tb", poses.rotation[:, :, 2], upward)
    lies = (drop > drop_limit) | (upright < COSINE_OF_TILT)
    stands = ~lies & np.isfinite(drop)
    falls = []
    for body in np.flatnonzero(supported & lies.any(axis=0)):
        last = np.flatnonzero(stands[:, body])[-1] if stands[:, body].any() else -1
        after = np.flatnonzero(lies[last + 1 :, body])
        if after.size:
            falls.append((float(test["time"][last + 1 + after[0]]), structure.body_names[body]))
    return Fall(*min(falls)[::-1]) if falls else None


def until_fall(test, fall):
    """A test without its readings from a fall on; as it is without a `Fall`."""
    if fall is None:
        return test
    kept = test.isel(time=test["time"].to_numpy() < fall.time)
    return kept.isel(time_acc=kept["time_acc"].to_numpy() < fall.time) if "time_acc" in kept.dims else kept
