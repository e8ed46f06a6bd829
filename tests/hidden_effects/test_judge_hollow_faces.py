"""Clean cases with hollow faces: the plan, the truth that makes them, and the table of decisions."""

import json

import numpy as np
import xarray as xr
from case_truth import true_numerics
from judge_hollow_faces import DEPTHS, EACH, planned, table
from make_case import make_case

from blockshake.diagnosis.verdict.verdict import Verdict


def _verdict(decision, causes=()):
    return Verdict(
        decision=decision, causes=causes, probabilities={}, misfit={"p": 0.5, "where": ""}, runs=0, word="one of"
    )  # fmt: skip


def test_every_depth_has_its_cases_by_the_solver_that_knows_faces():
    cases = planned()
    assert len({name for name, *_ in cases}) == len({seed for _, seed, _ in cases}) == EACH * len(DEPTHS)
    assert {true_numerics(seed)[0] for _, seed, _ in cases} == {"ls-dem"}
    assert [depth for *_, depth in cases] == [depth for depth in DEPTHS for _ in range(EACH)]


def test_what_is_called_stands_in_the_table():
    rows = table({1e-4: [_verdict("none"), _verdict("named", ("weak-joint",))], 3e-3: [_verdict("unknown")]})
    assert rows.splitlines()[2:] == ["| 0.1 | 2 | 1 | weak-joint |", "| 3 | 1 | 0 | unknown |"]


def test_the_structure_of_the_campaign_is_flat_and_the_true_blocks_are_not(tmp_path):
    _, seed, _ = planned()[0]
    made = {}
    for hollow in (0.0, 1e-3):
        folder, truth = tmp_path / f"{hollow}", tmp_path / f"truth-{hollow}"
        make_case(seed, "none", "large", folder, truth, sealed=False, hollow=hollow)
        assert "hollow" not in (folder / "structure.yaml").read_text()
        assert json.loads((truth / "truth.json").read_text())["hollow"] == hollow
        made[hollow] = xr.load_dataset(folder / "alkion-250.nc")["marker_displacement"]
    assert np.nanmax(np.abs(made[0.0] - made[1e-3])) > 1e-3
