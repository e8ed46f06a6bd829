"""Motion of the slab that a sound table does not make, measured and explained."""

import numpy as np
import xarray as xr

_MOVES = {"turn": ("rotation of the slab", "rad"), "lift": ("vertical motion of the slab", "m")}


def slab_departures(seen, slabs, explained, parts):
    """Rotation and vertical displacement of the slab, measured and by the causes.

    Parameters
    ----------
    seen : list of SeenTest
    slabs : list of SlabMotion
    explained : dict of str to Explanation
        From `explain_slab`.
    parts : sequence of Part
        Of the decision.

    Returns
    -------
    xarray.Dataset
        Along ``reading``, of all tests one after the other: ``slab_test`` and ``slab_time`` [s]; ``turn`` [rad] and
        ``lift`` [m], from rest; ``turn_explained`` and ``lift_explained``, those of the likeliest cause at its best.
    """
    found = {}
    for name, (readings, unit) in _MOVES.items():
        causes = [part.causes[0].name for part in parts if part.readings == readings]
        measured = [getattr(slab, name)[slab.at] for slab in slabs]
        made = explained[causes[0]].rows if causes else [np.zeros(len(one)) for one in measured]
        for key, values in ((name, measured), (f"{name}_explained", made)):
            found[key] = ("reading", np.concatenate(values), {"units": unit})
    names = [test.name for test, slab in zip(seen, slabs, strict=True) for _ in slab.at]
    time = np.concatenate([slab.time[slab.at] for slab in slabs])
    return xr.Dataset(
        found, {"slab_test": ("reading", names), "slab_time": ("reading", time, {"units": "s"})}
    )
