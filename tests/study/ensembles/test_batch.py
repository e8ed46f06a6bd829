"""Samples of a study's models: which solver runs them, and which runs two models share."""

import pandas as pd

from blockshake.dynamics.load_motion import load_motion
from blockshake.store import Store
from blockshake.study.ensembles import batch
from blockshake.study.ensembles.batch import CaseRuns, simulate_samples

CASE = {"structure": "configuration-1", "duration": 2.0}
PULLING = {"time_step": 1e-5, "parameters": {"ls_dem.pulling": True}}


def test_a_model_runs_its_solver_with_its_settings_and_shares_runs_that_are_the_same(
    make_run, tmp_path, monkeypatch
):
    asked = []

    def simulated(structure, motion, model, parameters, *, time_step, **_):
        asked.append((model, time_step, parameters))
        return make_run(0.01)

    monkeypatch.setattr(batch, "simulate", simulated)
    monkeypatch.setattr(
        batch,
        "joint_figures",
        lambda run, structure: run[[name for name in run if name.startswith(("joint", "blow"))]],
    )
    rows = pd.DataFrame({"friction.concrete.concrete": [0.7]})
    store, motion = Store(tmp_path, "source", print), load_motion("basso-tirreno")

    def files_of(model, settings):
        return simulate_samples(CaseRuns(CASE, model, settings, {}), lambda sample, row: motion, rows, store)

    printed = files_of("ls-dem-as-printed", PULLING)
    assert asked == [("ls-dem", 1e-5, {"ls_dem.pulling": True, "friction.concrete.concrete": 0.7})]
    assert files_of("ls-dem-pulling", PULLING) == printed
    assert files_of("ls-dem", PULLING) == printed
    assert len(asked) == 1
    assert files_of("ls-dem", {"time_step": 1e-5}) != printed
    assert asked[1] == ("ls-dem", 1e-5, {"friction.concrete.concrete": 0.7})
