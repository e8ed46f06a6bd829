"""How a run ended, in lines: whether a block fell first, then how far that was from it."""

import numpy as np

from blockshake.dynamics.system import FINISHED, Status
from blockshake.geometry.rotations import rotation_matrices
from blockshake.measurement.motion.joints import find_joints
from blockshake.simulation.rocking import overturning_margins
from blockshake.simulation.run_histories import drift_histories

_AT_HAND = 2**14  # times that are read at once
_ROCKS = 2e-3  # rad, of a tilt that no joint's elasticity makes


def ending(run, structure):
    """Whether a block fell; the largest drift, lift and tilt, and the least margin against overturning; remarks.

    The run file is open or loaded. Drift is the horizontal displacement of a mass centre against the first driven body,
    in whatever direction, and lift its displacement upwards: neither is the opening of a joint, its uplift. The margin
    is `overturning_margins`'. Lines of text, the answer first.
    """
    status, reason, end = (run.attrs[name] for name in ("status", "reason", "end_time"))
    answer = f"no block fell in {end:.4g} s" if status == Status.COMPLETED else f"{status} at {end:.4g} s"
    lines = [f"{answer} ({reason})" if reason and status in FINISHED else answer]
    largest, margins = _largest(run, structure)
    base = " against the base" if structure.driven.any() else ""
    for name, factor, unit, way in (
        ("drift", 1e3, "mm", f" (mass centre, horizontally{base})"),
        ("lift", 1e3, "mm", " (mass centre, upwards)"),
        ("tilt", 1e3, "mrad", ""),
    ):
        if name in largest:
            size, body, when = largest[name]
            where = f"{structure.body_names[body]} at {when:.4g} s"
            lines.append(f"largest {name}: {factor * size:.3g} {unit}, {where}{way}")
    if np.isfinite(margins).any():
        joint = int(np.nanargmin(margins))
        lower, upper = (structure.body_names[body] for body in find_joints(structure)[0][joint])
        share = (
            f"{100.0 * margins[joint]:.0f} %"
            if margins[joint] > 0.0
            else "none, the weight went over the edge"
        )
        lines.append(f"least margin against overturning: {share}, joint {lower}-{upper} (100 % at the start)")
    overlap = run.attrs.get("numerics_overlap_as_laid", 0.0)
    if overlap > 0.0:
        lines.append(f"remark: overlaps of up to {1e3 * overlap:.2g} mm were taken up at the start")
    if largest.get("tilt", (0.0,))[0] >= _ROCKS:
        lines.append(
            "remark: blocks rock, in which LS-DEM and NSCD differ: run both (docs/theory/rocking.md)"
        )
    return lines


def _largest(run, structure):
    """Largest drift and lift [m] and tilt [rad] in a run, and the least margins of the joints.

    By name the size, the body's number and its time [s], without a driven body in the inertial frame; empty where
    nothing is free or known. The margins are those of `overturning_margins`.
    """
    found, free = {}, np.flatnonzero(~structure.driven)
    margins = np.full(len(find_joints(structure)[0]), np.nan)
    for begin in range(0, run.sizes["time"] if len(free) else 0, _AT_HAND):
        rows = np.append(0, np.arange(begin, min(begin + _AT_HAND, run.sizes["time"])))
        part = run[["position", "orientation"]].isel(time=rows).load()
        part = part.isel(time=np.isfinite(part["position"]).all(("body", "axis")).to_numpy())
        if not part.sizes["time"]:
            continue
        position, turns = part["position"].to_numpy(), rotation_matrices(part["orientation"].to_numpy())
        moved = drift_histories(structure, position, turns)
        margins = np.fmin(margins, overturning_margins(structure, position, turns))
        sizes = {
            "drift": np.hypot(moved[..., 0], moved[..., 1]),
            "lift": np.maximum(moved[..., 2], 0.0),
            "tilt": _tilts(structure, turns),
        }
        for name, size in sizes.items():
            row, column = np.unravel_index(size[:, free].argmax(), (len(size), len(free)))
            most = float(size[row, free[column]])
            if most > found.get(name, (-1.0,))[0]:
                found[name] = most, int(free[column]), float(part["time"][row])
    return found, margins


def _tilts(structure, turns):
    """Angle between the line of each body that was upright at the start and the same line of the base, (n_times,
    n_bodies) [rad]."""
    start = rotation_matrices(structure.orientation)
    upright = np.einsum("tbij,bj->tbi", turns, start[:, 2])
    base = (
        upright[:, int(np.argmax(structure.driven))]
        if structure.driven.any()
        else np.array([[0.0, 0.0, 1.0]])
    )
    across = np.linalg.norm(np.cross(upright, base[:, None]), axis=-1)
    return np.arctan2(across, np.einsum("tbi,ti->tb", upright, np.broadcast_to(base, (len(turns), 3))))
