"""The largest responses of one run, body by body."""

import numpy as np
import pandas as pd

from blockshake.files import AnyPath
from blockshake.geometry.rotations import rotation_matrices
from blockshake.simulation.load_run import RunSource, load_run
from blockshake.study.limit_states.measures import SeenRun, measured

_SHOWN = ("tilt", "drift", "uplift", "slip")


def largest_responses(run: RunSource, meshes: AnyPath | None = None) -> pd.DataFrame:
    """Largest tilt, drift, uplift and slip of every body in a run, by the definitions of a study's limit states.

    Parameters
    ----------
    run : str, path or xarray.Dataset
        A run file, or what `simulate` returns.
    meshes : str or path, optional
        Folder of the structure's meshes; by default that of the run file, or the current one.

    Returns
    -------
    pandas.DataFrame
        A row a body that is not driven. ``tilt``: largest angle from upright, against the base [rad]; ``drift``:
        largest horizontal displacement of the mass centre since the start, against the base [m]; ``uplift`` and
        ``slip``: largest opening and slip of its joints with bodies below, at the middle of the joint [m], NaN of a
        body that stood on none. A run that ended early counts until its end.

    Raises
    ------
    InputError
        The file is missing, truncated or no run file, or a mesh of the structure is not found.

    Examples
    --------
    >>> import blockshake
    >>> run = blockshake.simulate("my.yaml", "alkion", "nscd-rigid", duration=0.2)
    >>> largest = blockshake.largest_responses(run)
    >>> list(largest.columns), list(largest.index)
    (['tilt', 'drift', 'uplift', 'slip'], ['block-1', 'block-2'])
    >>> bool((largest["drift"] < 0.001).all())
    True
    """
    loaded, structure = load_run(run, meshes)
    turns = rotation_matrices(loaded["orientation"].to_numpy())
    whole = loaded.attrs["status"] == "completed"
    seen = SeenRun(structure, loaded["time"].to_numpy(), loaded["position"].to_numpy(), turns, whole)
    bodies = np.flatnonzero(~structure.driven)
    rows = {structure.body_names[body]: [measured(seen, name, [body]) for name in _SHOWN] for body in bodies}
    return pd.DataFrame.from_dict(rows, orient="index", columns=list(_SHOWN))
