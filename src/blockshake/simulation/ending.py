"""How a run ended, in a line."""

import numpy as np

from blockshake.dynamics.system import FINISHED
from blockshake.geometry.rotations import rotation_matrices
from blockshake.simulation.run_histories import drift_histories

_AT_HAND = 2**14  # times that are read at once


def ending(run, structure):
    """Status of a run, the time that it reached, and its largest drift, in words.

    The run file is open or loaded. The drift is that of the mass centre that moved farthest, in whatever direction,
    against the first driven body.
    """
    words = f"{run.attrs['status']} at {run.attrs['end_time']:.4g} s"
    if run.attrs["status"] in FINISHED and run.attrs["reason"]:
        words += f" ({run.attrs['reason']})"
    overlap = run.attrs.get("numerics_overlap_as_laid", 0.0)
    if overlap > 0.0:
        words += f"; overlaps of up to {1e3 * overlap:.2g} mm were taken up at the start"
    largest = None
    for begin in range(0, 0 if structure.driven.all() else run.sizes["time"], _AT_HAND):
        rows = np.append(0, np.arange(begin, min(begin + _AT_HAND, run.sizes["time"])))
        drift = _largest_drift(run[["position", "orientation"]].isel(time=rows).load(), structure)
        if drift is not None and (largest is None or drift[0] > largest[0]):
            largest = drift
    if largest is None:
        return words
    size, body, when = largest
    base = " on the base" if structure.driven.any() else ""
    moved = f"the middle of {structure.body_names[body]} from its place{base}, in any direction"
    return f"{words}; largest drift {1e3 * size:.3g} mm at {when:.4g} s: {moved}"


def _largest_drift(run, structure):
    """Largest drift [m], the body's number and the time [s] in a part of a run that begins with its start, or None."""
    reached = np.isfinite(run["position"]).all(("body", "axis")).to_numpy()
    if not reached.any():
        return None
    moved = run.isel(time=reached)
    drift = drift_histories(structure, moved["position"].to_numpy(), rotation_matrices(moved["orientation"]))
    size = np.where(structure.driven, 0.0, np.linalg.norm(drift, axis=-1))
    row, body = np.unravel_index(size.argmax(), size.shape)
    return size[row, body], body, float(moved["time"][row])
