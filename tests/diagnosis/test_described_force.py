"""Forces from outside as the laws describe them, as entries of a structure file."""

import numpy as np
import pytest

from blockshake.diagnosis.gain.described_force import as_parameters, members_with_force
from blockshake.diagnosis.laws.findings import OutsideForce
from blockshake.diagnosis.libraries.null_model import draw_nominal
from blockshake.geometry.structure import load_structure

STRUCTURE = load_structure("configuration-1")


def force(law, unit="N", **values):
    tests = {"one": values, "two": {name: value + 0.2 for name, value in values.items()}}
    return OutsideForce(
        bodies=("block-2", "block-1"), height=0.5, law=law, scores={law: 0.0},
        amplitude=-2e3, lower=-2.5e3, upper=-1.5e3, unit=unit, tests=tests,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("law", "values", "entry"),
    [
        ("steady", {}, {"amplitude": -2e3}),
        ("constant", {"start": 1.0}, {"amplitude": -2e3, "start": 1.1}),
        ("pulse", {"start": 1.0, "end": 1.2}, {"amplitude": -2e3, "start": 1.1, "end": 1.3}),
        ("damper", {}, {"damping": 2e3}),
        ("proportional", {}, {"stiffness": 2e3}),
    ],
)
def test_a_law_is_an_external_force_of_the_structure(law, values, entry):
    (found,) = as_parameters(force(law, **values), -2e3, STRUCTURE)["external_forces"]
    assert found == {"body": "block-2", "position": [0.0, 0.0, 0.5]} | {
        name: pytest.approx(value) for name, value in entry.items()
    }
    assert STRUCTURE.with_parameters({"external_forces": [found]}).file.external_forces[0].body == "block-2"


def test_a_spring_beyond_a_gap_is_a_stop():
    given = force("spring", gap=0.02, side=1.0).model_copy(update={"amplitude": 1e6})
    (stop,) = as_parameters(given, 1e6, STRUCTURE)["stoppers"]
    assert stop == {
        "body": "block-2", "position": [0.0, 0.0, 0.5], "axis": "+x", "gap": pytest.approx(0.12), "stiffness": 1e6,
    }  # fmt: skip


def test_members_fill_the_interval_of_the_amplitude():
    draws = [draw_nominal(STRUCTURE, "nscd-rigid", number) for number in range(20)]
    members = members_with_force(force("steady"), draws, STRUCTURE)
    sizes = [draw.parameters["external_forces"][0]["amplitude"] for draw, _ in members]
    assert np.mean(sizes) == pytest.approx(-2e3)
    assert np.mean((np.array(sizes) > -2.5e3) & (np.array(sizes) < -1.5e3)) == pytest.approx(0.9)
    assert all(effects == [] for _, effects in members)
