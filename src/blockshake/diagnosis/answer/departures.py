"""Rows of the tests as forces on blocks, measured and explained: what an engineer looks at."""

import numpy as np
import xarray as xr

from blockshake.diagnosis.evidence.nuisances import expected_rows
from blockshake.forces.seen.wrench_histories import force_at

_NAMES = ("measured", "deviation", "explained")
_LEAST = 1e-3  # of a virtual displacement along x, squared: below it a force on the block makes no row
_MOVES = {"turn": ("rotation of the slab", "rad"), "lift": ("vertical motion of the slab", "m")}


def departures(seen, evidence, explained):
    """Forces on blocks that alone would make the rows, measured and by the causes.

    Parameters
    ----------
    seen : list of ReconstructedTest
    evidence : Evidence or None
    explained : list of Explanation
        Of the causes in the answer, a second one given the first.

    Returns
    -------
    xarray.Dataset
        Along ``instant``, of all tests one after the other: ``test`` and ``time`` [s]; ``measured``, ``deviation`` and
        ``explained(instant, body)`` [N]: the force along x at the mass centre that makes the instant's rows less what
        undamaged blocks make, by least squares; its standard deviation by the sensors; that of the causes at their
        best.
    """
    names = [seen[0].structure.body_names[body] for body in seen[0].free]
    parts = []
    for number, test in enumerate(evidence.tests if evidence else ()):
        rows = test.rows
        forces = sum((explanation.rows[number] for explanation in explained), np.zeros(len(rows.value)))
        measured = rows.value - expected_rows(test)
        instants, index = np.unique(rows.instant, return_inverse=True)
        found = np.full((3, len(instants), len(names)), np.nan)
        for column, body in enumerate(test.seen.free):
            unit = rows.along(force_at(test.seen, int(body), np.array([1.0, 0.0, 0.0])))
            square = np.bincount(index, unit**2)
            known = square > _LEAST
            sources = np.concatenate(list(rows.noise.values()), axis=1).T
            noise = np.stack([np.bincount(index, unit * source) for source in sources])
            for row, value in enumerate((np.bincount(index, unit * measured), np.sqrt((noise**2).sum(axis=0)),
                                           np.bincount(index, unit * forces))):  # fmt: skip
                found[row, known, column] = value[known] / square[known]
        parts.append(
            xr.Dataset(
                {name: (("instant", "body"), found[row]) for row, name in enumerate(_NAMES)},
                {
                    "test": ("instant", [test.seen.name] * len(instants)),
                    "time": ("instant", test.seen.motion.time[instants], {"units": "s"}),
                    "body": names,
                },
            )
        )
    if not parts:
        return _no_departures(names)
    return xr.concat(parts, dim="instant").map(lambda forces: forces.assign_attrs(units="N"))


def _no_departures(names):
    none = {name: (("instant", "body"), np.zeros((0, len(names)))) for name in _NAMES}
    return xr.Dataset(none, {"test": ("instant", np.zeros(0, "U1")), "time": ("instant", []), "body": names})


def departures_of_no_test(structure):
    """Departures of bodies and of the slab where no test was read: as of `departures` and `slab_departures`, empty."""
    names = [name for name, driven in zip(structure.body_names, structure.driven, strict=True) if not driven]
    slab = [name for move in _MOVES for name in (move, f"{move}_explained")]
    none = {name: ("reading", np.zeros(0)) for name in slab}
    labels = {"slab_test": ("reading", np.zeros(0, "U1")), "slab_time": ("reading", np.zeros(0))}
    return _no_departures(names).merge(xr.Dataset(none, labels))


def largest(shown):
    """The largest departure in words."""
    force = shown["measured"].to_numpy()
    if not np.isfinite(force).any():
        return "motion of the slab"
    sure = np.abs(force) / shown["deviation"].to_numpy()
    instant, body = np.unravel_index(np.nanargmax(sure), sure.shape)
    return (
        f"{shown['body'].values[body]} in {shown['test'].values[instant]} at {float(shown['time'][instant]):.2f} s: "
        f"{force[instant, body] / 1e3:+.3g} kN that the model does not have"
    )


def slab_departures(seen, slabs, explained, parts):
    """Rotation and vertical displacement of the slab, measured and by the causes.

    Parameters
    ----------
    seen : list of ReconstructedTest
    slabs : list of SlabMotion
    explained : dict of str to Explanation
        From `explain_slab`.
    parts : sequence of Part
        The decision.

    Returns
    -------
    xarray.Dataset
        Along ``reading``, of all tests one after the other: ``slab_test`` and ``slab_time`` [s]; ``turn`` [rad] and
        ``lift`` [m], from rest; ``turn_explained`` and ``lift_explained``, those of the most probable cause at its
        best.
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
