"""How a run ended, in a line."""

import numpy as np

from blockshake.dynamics.system import FINISHED
from blockshake.geometry.rotations import rotation_matrices
from blockshake.simulation.run_histories import drift_histories


def ending(run, structure):
    """Status of a run, the time that it reached, and its largest drift, in words.

    Parameters
    ----------
    run : xarray.Dataset
        A run file.
    structure : Structure
        The run's.

    Returns
    -------
    str
        The drift is that of the mass centre that moved farthest along x, y and z against the first driven body.
    """
    reached = np.isfinite(run["position"]).all(("body", "axis")).to_numpy()
    words = f"{run.attrs['status']} at {run.attrs['end_time']:.4g} s"
    if run.attrs["status"] in FINISHED and run.attrs["reason"]:
        words += f" ({run.attrs['reason']})"
    if not reached.any() or structure.driven.all():
        return words
    moved = run.isel(time=reached)
    drift = drift_histories(structure, moved["position"].to_numpy(), rotation_matrices(moved["orientation"]))
    size = np.where(structure.driven, 0.0, np.linalg.norm(drift, axis=-1))
    row, body = np.unravel_index(size.argmax(), size.shape)
    name, when = structure.body_names[body], float(moved["time"][row])
    return f"{words}; largest drift {1e3 * size[row, body]:.3g} mm, of {name} at {when:.4g} s"
