"""Libraries of several tests, on one scale and ready to score readings."""

from typing import NamedTuple

import numpy as np

from blockshake.diagnosis.features.tamed_features import feature_scale
from blockshake.diagnosis.inference.candidate_scores import ScoreLibrary
from blockshake.diagnosis.libraries.candidates import NOMINAL, effect_of
from blockshake.store import load_made


def load_tables(paths):
    """Datasets of `library` by test and solver, a list of mappings, from files ordered by test and then by solver."""
    tables = []
    for path in paths:
        table = load_made(path)
        if not tables or table.attrs["model"] in tables[-1]:
            tables.append({})
        tables[-1][table.attrs["model"]] = table
    return tables


def runs_of(table, key=NOMINAL):
    """Runs of one candidate, or nominal ones, of a library's features."""
    return table.isel(run=np.flatnonzero(table["candidate"].to_numpy() == key))


class ScaledLibrary(NamedTuple):
    """A library ready to score readings, and the scale of the features of each test."""

    library: ScoreLibrary
    scales: list


def score_library(tables, effects):
    """`ScaledLibrary`: libraries of several tests, ready to score readings.

    Parameters
    ----------
    tables : list of dict of str to xarray.Dataset
        By test and solver: features from `library`.
    effects : sequence of str
        Names of the effects that are considered.
    """
    keys = list(dict.fromkeys(tables[0][next(iter(tables[0]))]["candidate"].values.tolist()))
    keys = [key for key in keys if key == NOMINAL or effect_of(key) in effects]
    scales = [feature_scale([runs_of(one) for one in by_model.values()]) for by_model in tables]
    tamed = [
        {model: {key: scale.tamed(runs_of(table, key)) for key in keys} for model, table in by_model.items()}
        for by_model, scale in zip(tables, scales, strict=True)
    ]
    sizes = {
        model: {key: runs_of(table, key)["size"].to_numpy() for key in keys if key != NOMINAL}
        for model, table in tables[0].items()
    }
    return ScaledLibrary(ScoreLibrary(tamed, sizes), scales)
