"""How a run ended, in lines."""

import numpy as np

from blockshake.dynamics.system import FINISHED
from blockshake.geometry.rotations import rotation_matrices
from blockshake.simulation.run_histories import drift_histories

_AT_HAND = 2**14  # times that are read at once
_ROCKS = 2e-3  # rad, of a lean that no joint's elasticity makes


def ending(run, structure):
    """Status of a run, the time that it reached, and the largest drift and lift of a block, in words; and a remark
    where a block rocked, in which the flat faces of LS-DEM and the corners of NSCD are known to differ, or "".

    The run file is open or loaded. Drift is the horizontal displacement of a mass centre against the first driven body,
    in whatever direction, and lift its displacement upwards: neither is the opening of a joint, its uplift.
    """
    words = f"{run.attrs['status']} at {run.attrs['end_time']:.4g} s"
    if run.attrs["status"] in FINISHED and run.attrs["reason"]:
        words += f" ({run.attrs['reason']})"
    overlap = run.attrs.get("numerics_overlap_as_laid", 0.0)
    if overlap > 0.0:
        words += f"; overlaps of up to {1e3 * overlap:.2g} mm were taken up at the start"
    largest = _largest(run, structure)
    base = " against the base" if structure.driven.any() else ""
    for name, way in (("drift", f"horizontally{base}"), ("lift", "upwards")):
        if name in largest:
            size, body, when = largest[name]
            words += f"; largest {name} {1e3 * size:.3g} mm at {when:.4g} s, of the mass centre of "
            words += f"{structure.body_names[body]} {way}"
    lean, body, _ = largest.get("lean", (0.0, 0, 0.0))
    if lean < _ROCKS:
        return words, ""
    return words, (
        f"{structure.body_names[body]} leans by up to {1e3 * lean:.3g} mrad: an impact of LS-DEM's flat faces keeps "
        "more spin than one of NSCD's corners, so that the models differ in rocking (docs/theory/rocking.md)"
    )


def _largest(run, structure):
    """Largest drift and lift [m] and lean [rad] in a run: each its size, the body's number and its time [s], by name.

    Without a driven body places are those in the inertial frame. Empty where nothing is free or known.
    """
    found, free = {}, np.flatnonzero(~structure.driven)
    for begin in range(0, run.sizes["time"] if len(free) else 0, _AT_HAND):
        rows = np.append(0, np.arange(begin, min(begin + _AT_HAND, run.sizes["time"])))
        part = run[["position", "orientation"]].isel(time=rows).load()
        part = part.isel(time=np.isfinite(part["position"]).all(("body", "axis")).to_numpy())
        if not part.sizes["time"]:
            continue
        turns = rotation_matrices(part["orientation"].to_numpy())
        moved = drift_histories(structure, part["position"].to_numpy(), turns)
        sizes = {
            "drift": np.hypot(moved[..., 0], moved[..., 1]),
            "lift": np.maximum(moved[..., 2], 0.0),
            "lean": _leans(structure, turns),
        }
        for name, size in sizes.items():
            row, column = np.unravel_index(size[:, free].argmax(), (len(size), len(free)))
            most = float(size[row, free[column]])
            if most > found.get(name, (-1.0,))[0]:
                found[name] = most, int(free[column]), float(part["time"][row])
    return found


def _leans(structure, turns):
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
