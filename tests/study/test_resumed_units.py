"""A killed rule of many runs goes on from those that are finished: each is made once, and the bytes are the same."""

import numpy as np
import pandas as pd
import pytest

from blockshake import store
from blockshake.files import content_digest, write_json
from blockshake.store import Store
from blockshake.study.config import Ladder
from blockshake.study.convergence import convergence
from blockshake.study.convergence.settings import Convergence
from blockshake.study.convergence.table import write_convergence
from blockshake.study.ensembles import ladder
from blockshake.study.sampling.latin_hypercube import write_design
from blockshake.study.stiffness import definitions, wave_speed

CASE = {
    "structure": "configuration-1",
    "motion": "basso-tirreno",
    "scale": 1.0,
    "baseline": "auto",
    "duration": 0.05,
}
RUNGS = Ladder(first=0.5, increment=0.25, highest=1.25)
SHORT = Convergence(
    structure="configuration-1",
    frequency=20.0,
    duration=0.1,
    time_steps=(1e-4, 5e-5),
    node_spacings=(0.4, 0.8),
    perimeter_insets=(0.006, 0.012),
    grid_spacings=(0.1,),
)
DESIGN = pd.DataFrame({"materials.concrete.youngs_modulus": [3e10, 3.5e10, 4e10]})


class CutShortError(Exception):
    pass


def _climb(path, store):
    climbed = [CASE], {"alkion": "auto"}, 1e-4, RUNGS
    write_json(path, ladder.climb_ladders(*climbed, Store(store, "source")))


def test_a_structure_of_two_cases_is_climbed_once_for_the_longer_one(tmp_path, monkeypatch):
    climbed = []
    monkeypatch.setattr(
        ladder, "climb", lambda structure, runs, *_: climbed.append(runs.case["duration"]) or []
    )
    cases = [CASE, CASE | {"duration": 0.1}]
    ladder.climb_ladders(cases, {"alkion": "auto"}, 1e-4, RUNGS, Store(tmp_path, "source"))
    assert climbed == [0.1]


def _converge(path, store):
    write_convergence(path, convergence.study_convergence(SHORT, Store(store, "source")))


def _calibrate(path, store):
    write_design(path, wave_speed.calibrate_design("configuration-2", DESIGN, {}, Store(store, "source")))


def _compare(path, store):
    compared = definitions.compare_definitions({**CASE, "duration": 0.02}, 1e-4, Store(store, "source"))
    path.write_bytes(b"".join(np.ascontiguousarray(one).tobytes() for one in compared.data_vars.values()))


# what makes the rule's file, the module and the function that makes a unit, and how many units are let through
RULES = {
    "ladder": (_climb, ladder, "simulate", 2),
    "convergence": (_converge, convergence, "rocking_block", 5),
    "stiffness": (_calibrate, wave_speed, "calibrate_stiffness", 1),
    "definitions, wave tests": (_compare, definitions, "send_step", 5),
    "definitions, peaks": (_compare, definitions, "simulate", 1),
}


@pytest.fixture(autouse=True)
def _few(monkeypatch):
    monkeypatch.setattr(definitions, "RESTITUTIONS", (0.5,))
    monkeypatch.setattr(definitions, "FREE_FACTORS", (1.0,))
    monkeypatch.setattr(definitions, "DEFINITIONS", ("10 %", "50 %"))


@pytest.mark.parametrize("rule", RULES)
def test_a_killed_rule_makes_each_unit_once(rule, tmp_path, monkeypatch):
    make_file, module, name, allowed = RULES[rule]
    made, make_unit = [], getattr(module, name)

    def counted(*given, **choices):
        if len(made) == limit:
            raise CutShortError
        unit = make_unit(*given, **choices)
        made.append(unit)
        return unit

    monkeypatch.setattr(module, name, counted)
    limit = None
    make_file(tmp_path / "whole", tmp_path / "of-whole")
    units, limit = len(made), allowed
    made.clear()
    with pytest.raises(CutShortError):
        make_file(tmp_path / "cut", tmp_path / "store")
    assert not (tmp_path / "cut").exists()
    assert len(made) == allowed < units
    limit = None
    make_file(tmp_path / "cut", tmp_path / "store")
    assert len(made) == units
    assert (tmp_path / "cut").read_bytes() == (tmp_path / "whole").read_bytes()
    make_file(tmp_path / "again", tmp_path / "store")
    assert len(made) == units
    # other sources are other units
    monkeypatch.setattr(store, "content_digest", lambda source, *given: content_digest("edited", *given))
    limit = units
    with pytest.raises(CutShortError):
        make_file(tmp_path / "edited", tmp_path / "store")
