"""Ensembles of simulated tests: histories of several models along one dimension."""

from typing import NamedTuple

import numpy as np
import xarray as xr

from blockshake.diagnosis.nominal.nominal_model import Draw, draw_nominal, draw_twin
from blockshake.diagnosis.nominal.planned_test import PlannedTest
from blockshake.diagnosis.nominal.simulated_test import simulated_histories

# kinds of members
NOMINAL, TWIN = "nominal", "twin"
RECALIBRATED, EXTENDED, PLACEBO, DISCREPANCY = "recalibrated", "extended", "placebo", "discrepancy"


class Member(NamedTuple):
    """A model of one kind that simulates one test; ``extension`` as of `simulated_histories`."""

    kind: str
    number: int
    test: str
    planned: PlannedTest
    draw: Draw
    extension: object = None


def nominal_members(test, planned, model, count, twins):
    """List of `Member`: nominal draws of a test by one solver, and draw 0 with its twins."""
    draws = [(NOMINAL, number, draw_nominal) for number in range(count)]
    draws += [(TWIN, number, draw_twin) for number in range(twins + 1)]
    return [
        Member(kind, number, test, planned, drawn(planned.structure, model, number))
        for kind, number, drawn in draws
    ]


def simulate_members(members, store):
    """Histories of a list of `Member` by one solver, kept in a `Store`.

    Returns
    -------
    xarray.Dataset
        Histories of `read_histories` along ``run``, NaN after the end of a shorter run; coordinates ``kind``,
        ``test``, ``number`` and ``status``. Attributes ``model`` and ``top``.
    """
    parts = []
    for done, member in enumerate(members, start=1):
        words = f"{member.test} {member.draw.model} {member.kind} {member.number} {done}/{len(members)}"
        parts.append(simulated_histories(words, member.planned, member.draw, store, member.extension))
    whole = xr.concat(
        parts, dim="run", join="outer", coords="minimal", compat="override", combine_attrs="drop_conflicts"
    )
    labels = {
        "kind": [one.kind for one in members],
        "test": [one.test for one in members],
        "number": [one.number for one in members],
        "status": [one.attrs["status"] for one in parts],
    }
    whole = whole.drop_attrs(deep=False).assign_attrs(model=members[0].draw.model, top=parts[0].attrs["top"])
    return whole.assign_coords({name: ("run", values) for name, values in labels.items()})


def runs_of(ensemble, **labels):
    """The runs with some labels, such as ``kind``, in the order of their numbers, as long as the longest of them."""
    chosen = np.logical_and.reduce([ensemble[name].to_numpy() == label for name, label in labels.items()])
    return ensemble.isel(run=np.flatnonzero(chosen)).dropna("time", how="all", subset=["drift"])
