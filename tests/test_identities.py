"""A unit of work is named by all of its fields: another value of any of them is another unit."""

from dataclasses import dataclass, fields, replace

import numpy as np
import pytest

from blockshake.diagnosis.gain.extended_model import Extension
from blockshake.diagnosis.nominal.clean_runs import _CleanRun
from blockshake.diagnosis.nominal.nominal_model import draw_nominal
from blockshake.diagnosis.nominal.planned_test import PlannedTest
from blockshake.diagnosis.nominal.simulated_test import _Histories
from blockshake.diagnosis.outcomes.runs import _Outcome
from blockshake.dynamics.motion import ground_motion
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import Sensors
from blockshake.measurement.sensors.instruments import Instruments
from blockshake.store import Unit, described
from blockshake.study.calibration.readings import _Readings
from blockshake.study.ensembles.batch import _SampleRun
from blockshake.study.fragility.climb import _Level
from blockshake.study.stiffness.wave_speed import _Stiffness

STRUCTURE = load_structure("configuration-1")
ROWS = np.linspace(0.0, 1.0, 11), {"x": np.linspace(0.0, 1.0, 11)}
MOTION = ground_motion("push", *ROWS, "acceleration")
PLANNED = PlannedTest(STRUCTURE, MOTION, 1.0, Sensors(), ("slab-face",))
DRAW = draw_nominal(STRUCTURE, "nscd-rigid", 0)
# by the name of a field two values of it
VALUES = {
    "structure": (STRUCTURE, STRUCTURE.with_parameters({"restitution": 0.4})),
    "motion": (MOTION, MOTION.scaled(1.0 + 1e-12), ground_motion("shove", *ROWS, "acceleration")),
    "model": ("nscd-rigid", "ls-dem"),
    "solver": ("nscd-rigid", "ls-dem"),
    "parameters": ({"restitution": 0.5}, {"restitution": 0.5, "nscd.theta": 0.6}),
    "time_step": (1e-3, 5e-4),
    "duration": (1.0, 2.0),
    "joints": ((), (("slab", "block-1"),)),
    "output_rate": (None, 200.0),
    "tower": (STRUCTURE, STRUCTURE.with_parameters({"restitution": 0.4})),
    "instruments": (Instruments(), Instruments(marker_noise=2e-4)),
    "noise": (1, 2),
    "body": (1, 2),
    "scale": (1.0, 2.0),
    "shares": (np.zeros(8), np.ones(8)),
    "tests": ((("a", PLANNED, ("c",)),), (("b", PLANNED, ("c",)),), (("a", PLANNED, ()),)),
    "number": (0, 1),
    "planned": (PLANNED, replace(PLANNED, duration=2.0)),
    "draw": (DRAW, replace(DRAW, seed=DRAW.seed + 1), replace(DRAW, places=DRAW.places + 1e-6)),
    "extension": (None, Extension((), 0, "a")),
}


def kinds():
    """Every kind of unit of the package."""
    return [one for one in Unit.__subclasses__() if one.__module__.startswith("blockshake.")]


def test_all_kinds_are_looked_at():
    assert {one.__name__ for one in kinds()} == {
        "_CleanRun", "_Histories", "_Outcome", "_Readings", "_Level", "_SampleRun", "_Stiffness",
    }  # fmt: skip


@pytest.mark.parametrize("kind", [_CleanRun, _Histories, _Outcome, _Readings, _Level, _SampleRun, _Stiffness])
def test_another_value_of_any_field_is_another_unit(kind):
    names = [field.name for field in fields(kind)]
    unit = kind(**{name: VALUES[name][0] for name in names})
    assert unit.identity == kind(**{name: VALUES[name][0] for name in names}).identity
    others = {replace(unit, **{name: value}).identity for name in names for value in VALUES[name][1:]}
    assert len(others) == sum(len(VALUES[name]) - 1 for name in names)
    assert unit.identity not in others


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (np.arange(4.0), np.arange(4.0).reshape(2, 2)),
        (np.zeros(2), np.zeros(2, dtype=np.int64)),
        ({"a": 1.0}, {"a": 2.0}),
        ((1, 2), (2, 1)),
        (1.0, None),
    ],
)
def test_values_that_differ_are_described_apart(one, other):
    assert described(one) != described(other)
    assert described(one) == described(one)


def test_what_nothing_is_known_of_is_refused():
    @dataclass(frozen=True)
    class Odd(Unit):
        what: object

    with pytest.raises(TypeError, match="no description of a object"):
        _ = Odd(object()).identity
