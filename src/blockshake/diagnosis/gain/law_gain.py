"""Gain on the laws of the joints: statics of sealed tests before and after the extension, which no chaos blurs."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.gain.gain import EXTENDED, RECALIBRATED, contrast
from blockshake.diagnosis.laws.law_table import law_of
from blockshake.diagnosis.laws.null_laws import tamed, tamed_error

_FEWEST = 4  # members that tell a law
_REPLICATES = 1000
_INTERVAL = (0.05, 0.95)
_NOTICEABLE = 9.0  # squared distance that a rival must exceed: three standard deviations


def law_gain(tests, broken):
    """Distances of the broken laws on sealed tests from each ensemble, and the gain of the extended one.

    Parameters
    ----------
    tests : dict of str to (xarray.Dataset, dict of str to dict of str to xarray.Dataset)
        By sealed test: its reading, and the runs of every ensemble by solver, as from `extended_runs`.
    broken : sequence of str
        Laws that the open tests break.

    Returns
    -------
    xarray.Dataset
        ``law_distance(law_kind, law_cell)`` [standard deviations] of the laws that a sealed test and the ensembles
        tell, coordinates ``cell_test`` and ``cell_law``; ``law_gain``, ``law_gain_lower`` and ``law_gain_upper(
        law_rival)`` [1], NaN where no law is left to gain on.

    Notes
    -----
    A distance is in standard deviations of the nominal members and the law's error. Gain is ``(D_rival - D_extended) /
    (D_rival - 1)`` with the mean squares D: 1 is what chance leaves. Intervals of 90 % by bootstrap of the members.
    """
    kinds = list(next(iter(tests.values()))[1]) if tests else []
    cells, values = [], []
    for name, (reading, ensembles) in tests.items():
        told = [str(law) for law in reading["law"].values] if "law" in reading.dims else []
        for law in broken:
            if law not in told:
                continue
            members = {kind: _members(by_model, law) for kind, by_model in ensembles.items()}
            own, error = (float(reading[key].sel(law=law)) for key in ("law_value", "law_error"))
            if np.isfinite(own) and all(len(one) >= _FEWEST for one in members.values()):
                spread = max(np.std(members["nominal"], ddof=1), law_of(law).spread / 3.0)
                sigma = np.hypot(spread, tamed_error(law, own, error) if np.isfinite(error) else 0.0)
                cells.append((name, law))
                values.append({kind: (tamed(law, own) - one) / sigma for kind, one in members.items()})
    rivals = [kind for kind in kinds if kind != EXTENDED]
    distance = np.array([[one[kind].mean() for one in values] for kind in kinds]).reshape(
        len(kinds), len(cells)
    )
    gain = np.full((3, len(rivals)), np.nan)
    for place, rival in enumerate(rivals):
        if cells and np.mean(distance[kinds.index(rival)] ** 2) > _NOTICEABLE:
            gain[0, place] = _gain(distance[kinds.index(rival)], distance[kinds.index(EXTENDED)])
            gain[1:, place] = np.quantile(_drawn(values, rival), _INTERVAL)
    return xr.Dataset(
        {
            "law_distance": (("law_kind", "law_cell"), distance),
            **{
                name: ("law_rival", one)
                for name, one in zip(("law_gain", "law_gain_lower", "law_gain_upper"), gain, strict=True)
            },
        },
        {
            "law_kind": kinds,
            "law_rival": rivals,
            "cell_test": ("law_cell", [test for test, _ in cells]),
            "cell_law": ("law_cell", [law for _, law in cells]),
        },
    )


def law_contrast(gained):
    """Gain of `law_gain` against the recalibrated model in the form of the verdict; None without one."""
    own = gained.sel(law_rival=RECALIBRATED) if RECALIBRATED in gained["law_rival"] else None
    if own is None or np.isnan(own["law_gain"]):
        return None
    return contrast(*(float(own[name]) for name in ("law_gain", "law_gain_lower", "law_gain_upper")))


def _members(by_model, law):
    """Values of a law over the members of all solvers that tell it, on the law's scale."""
    found = [
        one["law_value"].sel(law=law).to_numpy() for one in by_model.values() if law in one["law"].values
    ]
    values = np.concatenate(found) if found else np.empty(0)
    return tamed(law, values[np.isfinite(values)])


def _gain(rival, extended):
    before, after = np.mean(rival**2), np.mean(extended**2)
    return (before - after) / (before - 1.0)


def _drawn(values, rival):
    """Gains with the members drawn anew."""
    generator = np.random.default_rng(len(values))
    found = []
    for _ in range(_REPLICATES):
        means = [
            [one[kind][generator.integers(len(one[kind]), size=len(one[kind]))].mean() for one in values]
            for kind in (rival, EXTENDED)
        ]
        found.append(_gain(*np.array(means)))
    return found
