"""A killed rule of many runs goes on from those that are finished: each is made once, and the bytes are the same."""

import pandas as pd
import pytest
from cut_runs import CutShortError

from blockshake import store
from blockshake.files import content_digest, write_json
from blockshake.store import Store
from blockshake.study.config import Ladder
from blockshake.study.ensembles.batch import CaseRuns
from blockshake.study.fragility import climb
from blockshake.study.sampling.sample_table import write_design
from blockshake.study.stiffness import wave_speed

CASE = {
    "structure": "configuration-1",
    "motion": "basso-tirreno",
    "scale": 1.0,
    "baseline": "auto",
    "duration": 0.05,
}
RUNGS = Ladder(first=0.5, increment=0.25, highest=1.25)
DESIGN = pd.DataFrame({"materials.concrete.youngs_modulus": [3e10, 3.5e10, 4e10]})


def _climb(path, store):
    runs = CaseRuns(CASE, "nscd-rigid", {"time_step": 1e-3}, {})
    climbed = climb.climb_samples(runs, pd.DataFrame(index=[0]), RUNGS, Store(store, "source"))
    write_json(path, climbed["drift_ratio"].values.tolist())


def _calibrate(path, store):
    write_design(path, wave_speed.calibrate_design("configuration-2", DESIGN, {}, Store(store, "source")))


# what makes the rule's file, the module and the function that makes a unit, and how many units are let through
RULES = {
    "climbs": (_climb, climb, "simulate", 2),
    "stiffness": (_calibrate, wave_speed, "calibrate_stiffness", 1),
}


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
