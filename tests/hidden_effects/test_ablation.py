"""Ablation: the first draws of each candidate, and the shares of answers by way of deciding."""

import numpy as np
import xarray as xr
from measure_ablation import FEW, WAYS, _first, table
from score_figures import Scored

from blockshake.diagnosis.verdict.verdict import Verdict


def _scored(truth, decision, causes=()):
    told = {
        "truth": truth, "size_class": "large" if truth != "none" else None, "seed": 1, "sealed": False,
        "tests": {}, "structure": "two-blocks", "effect": {"name": truth, "values": {}, "place": {}},
    }  # fmt: skip
    verdict = Verdict(
        decision=decision, causes=causes, probabilities={}, misfit={"p": 0.5, "where": ""}, runs=0, word="one of"
    )  # fmt: skip
    return Scored("case", told, verdict)


def test_few_draws_are_the_first_of_each_candidate_and_all_nominal_ones():
    names = ["nominal"] * 4 + ["one"] * 3 + ["other"] * 3
    draws = [0, 1, 2, 3, 0, 1, 2, 0, 1, 2]
    library = xr.Dataset(
        {"value": ("run", np.arange(10))}, {"candidate": ("run", names), "draw": ("run", draws)}
    )
    kept = _first(library, FEW)
    assert kept["value"].values.tolist() == [0, 1, 2, 3, 4, 5, 7, 8]


def test_every_way_has_its_column_of_counts():
    right, wrong = _scored("table-pitch", "named", ("table-pitch",)), _scored("none", "unknown")
    ways = list(WAYS)
    scored = {way: [right, wrong] for way in ways} | {ways[0]: [right, _scored("none", "none")]}
    rows = {
        line.split(" | ")[0].strip("| "): line.strip("| ").split(" | ")[1:]
        for line in table(scored).splitlines()
    }
    assert rows["answer"] == ways
    assert rows["false alarms"] == ["0 of 1", "1 of 1", "1 of 1", "1 of 1"]
    assert rows["truth named or in the set"] == ["1 of 1"] * 4
