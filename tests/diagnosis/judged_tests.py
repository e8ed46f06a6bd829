"""Made-up tests with made-up ensembles."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.misfit.judged_test import JudgedTest

MODELS = ("ls-dem", "nscd-rigid")
CELLS = ("rotation slab-a", "rotation a-b", "slip slab-a", "slip a-b", "drift b")
TIME = np.arange(100) / 50.0


def cells(values):
    """Cells of `as_cells` from values (..., n_times, n_cells)."""
    values = np.asarray(values, dtype=float)
    quantity, where = zip(*(name.split() for name in CELLS), strict=True)
    dims = ("run", "time", "cell")[3 - values.ndim :]
    return xr.DataArray(
        values,
        dims=dims,
        coords={
            "time": TIME[: values.shape[-2]],
            "cell": list(CELLS),
            "quantity": ("cell", list(quantity)),
            "where": ("cell", list(where)),
            "unit": ("cell", ["rad" if name == "rotation" else "m" for name in quantity]),
        },
    )


def judged(name, measured, members, horizon=None):
    """`JudgedTest`; ``members`` by kind, (n_members, n_times, n_cells), half of them by each solver."""
    count = len(next(iter(members.values())))
    horizon = np.full(len(CELLS), TIME[-1]) if horizon is None else np.asarray(horizon, dtype=float)
    return JudgedTest(
        name,
        cells(measured),
        {kind: cells(values) for kind, values in members.items()},
        np.repeat(MODELS, count // 2),
        horizon,
    )
