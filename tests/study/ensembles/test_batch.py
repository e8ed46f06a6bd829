"""Samples of a study's models: which solver runs them, and which runs two models share."""

import numpy as np
import pandas as pd
import pytest

from blockshake.dynamics.load_motion import load_motion
from blockshake.geometry.structure import load_structure
from blockshake.store import Store
from blockshake.study.ensembles import batch
from blockshake.study.ensembles.batch import CaseRuns, samples_of, simulate_samples
from blockshake.study.ensembles.ensemble import join_batches
from blockshake.study.stiffness import wave_speed
from blockshake.study.stiffness.tower import tower_of

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


YOUNG, FRICTION, ICE = "materials.concrete.youngs_modulus", "friction.concrete.concrete", "friction.ice.ice"


@pytest.mark.parametrize(
    ("model", "changed", "again"),
    [
        ("nscd-rigid", {YOUNG: [4e10, 5e10]}, []),
        ("nscd-rigid", {ICE: [0.1, 0.2]}, []),
        ("nscd-rigid", {"ls_dem.normal_stiffness": [3e10, 4e10]}, []),
        ("nscd-rigid", {FRICTION: [0.6, 0.8]}, [0.8]),
        ("nscd-rigid", {FRICTION: [0.8, 0.9]}, [0.8, 0.9]),
        ("ls-dem", {YOUNG: [3e10, 5e10]}, [0.7]),
        ("ls-dem", {ICE: [0.1, 0.2]}, []),
    ],
)
def test_only_runs_whose_values_changed_and_that_use_them_are_made_again(
    model, changed, again, make_run, tmp_path, monkeypatch
):
    """Neither a modulus that rigid blocks have not, nor a friction of no joint, nor another solver's value matters."""
    made = []

    def simulated(structure, motion, model, parameters, **_):
        made.append(parameters[FRICTION])
        return make_run(parameters[FRICTION])

    monkeypatch.setattr(batch, "simulate", simulated)
    monkeypatch.setattr(
        batch,
        "joint_figures",
        lambda run, structure: run[[name for name in run if name.startswith(("joint", "blow"))]],
    )
    rows = pd.DataFrame({
        FRICTION: [0.6, 0.7], YOUNG: [3e10, 4e10], ICE: [0.05, 0.06], "ls_dem.normal_stiffness": [1e10, 2e10],
    })  # fmt: skip
    store, motion = Store(tmp_path, "source", print), load_motion("basso-tirreno")

    def joined(rows):
        runs = CaseRuns(CASE, model, {"time_step": 1e-3}, {})
        return join_batches(samples_of(simulate_samples(runs, lambda sample, row: motion, rows, store), rows))

    joined(rows)
    assert made == [0.6, 0.7]
    made.clear()
    after = rows.assign(**changed)
    found = joined(after)
    assert made == again
    # every sample has its own values, kept or not
    np.testing.assert_array_equal(found["sample"], [0, 1])
    np.testing.assert_array_equal(found["parameter_value"], after.to_numpy())
    top = found["peak"].sel(frame="slab", marker="block-1-face")
    np.testing.assert_allclose(top, after[FRICTION], rtol=1e-9)


def test_the_stiffness_follows_from_the_tower_alone(tmp_path, monkeypatch):
    """A friction changes no wave speed; a modulus does."""
    made = []
    monkeypatch.setattr(
        wave_speed,
        "calibrate_stiffness",
        lambda tower: made.append(tower) or {"normal_stiffness": 1.0, "shear_stiffness": 0.5},
    )
    store = Store(tmp_path, "source", print)
    design = pd.DataFrame({FRICTION: [0.6, 0.7], YOUNG: [3e10, 3e10]})
    wave_speed.calibrate_design("configuration-1", design, {}, store)
    assert len(made) == 1
    wave_speed.calibrate_design("configuration-1", design.assign(**{YOUNG: [3e10, 4e10]}), {}, store)
    assert len(made) == 2
    tower = tower_of(load_structure("configuration-1"))
    again = tower_of(tower)
    assert again.file.model_dump(exclude={"name"}) == tower.file.model_dump(exclude={"name"})
