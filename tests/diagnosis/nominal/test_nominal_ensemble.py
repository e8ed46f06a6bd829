"""Ensembles of a formula that stands in for the solvers: kinds, kept tests, twins."""

import numpy as np
import pytest
import xarray as xr
from tiny_campaign import prescribed_run

from blockshake.diagnosis.nominal import simulated_test
from blockshake.diagnosis.nominal.ensemble import NOMINAL, TWIN, nominal_members, runs_of, simulate_members
from blockshake.diagnosis.nominal.nominal_model import MODELS
from blockshake.diagnosis.nominal.planned_test import PlannedTest
from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.store import Store


@pytest.fixture
def planned(two_blocks, monkeypatch):
    monkeypatch.setattr(simulated_test, "simulate", prescribed_run)
    time = np.linspace(0.0, 2.0, 201)
    motion = ground_motion("shake", time, {"x": 1.5 * np.sin(7.0 * time)}, "acceleration")
    structure = load_structure(two_blocks)
    return PlannedTest(structure, motion, 2.0, Sensors(), tuple(one.name for one in structure.file.markers))


def test_a_test_that_is_kept_is_not_simulated_again(planned, tmp_path):
    lines = []
    members = nominal_members("t", planned, MODELS[0], 3, 2)
    first = simulate_members(members, Store(tmp_path, "source", lines.append))
    again = simulate_members(members, Store(tmp_path, "source", lines.append))
    xr.testing.assert_identical(first, again)
    assert [line.split(":")[0].rpartition(" ")[2] for line in lines] == [
        # twin 0 is draw 0
        *["simulated"] * 3, "kept", *["simulated"] * 2, *["kept"] * 6,
    ]  # fmt: skip
    simulate_members(members[:1], Store(tmp_path, "another", lines.append))
    assert lines[-1].split(":")[0].endswith("simulated")


def test_members_are_labelled_by_kind_and_number(planned, tmp_path):
    members = nominal_members("t", planned, MODELS[1], 3, 2)
    found = simulate_members(members, Store(tmp_path, "source"))
    assert found.attrs["model"] == MODELS[1]
    assert runs_of(found, kind=NOMINAL)["number"].values.tolist() == [0, 1, 2]
    assert runs_of(found, kind=TWIN, test="t").sizes["run"] == 3
    assert (found["status"] == "completed").all()


def test_an_extension_changes_the_experiment_and_the_name_in_the_store(planned, tmp_path):
    class Louder:
        digest = "louder"

        def __call__(self, experiment):
            return experiment.with_instruments(marker_noise=10.0 * experiment.instruments.marker_noise)

    members = nominal_members("t", planned, MODELS[0], 1, 0)[:1]
    both = [members[0], members[0]._replace(kind="extended", extension=Louder())]
    found = simulate_members(both, Store(tmp_path, "source"))
    rough = found["slip"].diff("time").std(("time", "joint"))
    assert rough[1] > 3.0 * rough[0]
