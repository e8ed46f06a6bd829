"""The law that a force follows in all tests, and the evidence that it needs."""

import numpy as np
import pytest

from blockshake.diagnosis.laws.outside_force import law_of_tests
from blockshake.forces.outside.force_laws import fit_laws
from blockshake.forces.outside.push_history import PushHistory

TIME = np.arange(0.0, 6.0, 0.01)
MOVED = 0.04 * np.sin(2.0 * np.pi * 0.7 * TIME)
RATE = np.gradient(MOVED, TIME)
ERROR = 500.0  # N
BOTH = {"one": 0, "two": 1}


def fits(force, seed):
    nothing = np.zeros(len(TIME))
    return fit_laws(
        TIME,
        PushHistory(
            body=1, height=0.0, force=force + np.random.default_rng(seed).normal(0.0, ERROR, len(TIME)),
            error=nothing + ERROR, told=np.ones(len(TIME), dtype=bool), distance=nothing,
            edge=nothing, friction=nothing, lower=nothing - np.inf, upper=nothing + np.inf, by_lever=nothing,
            displacement=MOVED, velocity=RATE,
        ),
    )  # fmt: skip


def found(force):
    return law_of_tests({test: fits(force, seed) for test, seed in BOTH.items()})


@pytest.mark.parametrize(
    ("law", "force"),
    [
        ("steady", np.full(len(TIME), 900.0)),
        ("constant", np.where(TIME > 2.0, 900.0, 0.0)),
        ("proportional", -5e4 * MOVED),
        ("damper", -8e3 * RATE),
        ("spring", -1e6 * np.maximum(MOVED - 0.02, 0.0)),
        ("pulse", np.where((TIME > 3.0) & (TIME < 3.1), 9e3, 0.0)),
    ],
)
def test_a_law_is_named_with_its_fit_in_every_test(law, force):
    assert found(force).law == law
    assert list(found(force).tests) == list(BOTH)
    assert found(force).scores[law] == 0.0


def test_noise_alone_follows_no_law():
    assert found(np.zeros(len(TIME))) is None


def test_a_force_that_one_test_alone_shows_is_that_tests():
    own = {"one": fits(np.full(len(TIME), 2000.0), 0), "two": fits(np.zeros(len(TIME)), 1)}
    assert list(law_of_tests(own).tests) == ["one"]


def test_a_little_force_is_not_evidence_enough():
    """By its information alone the steady force would be shown: readings are not as independent as it takes them."""
    weak = np.full(len(TIME), 150.0)
    assert fits(weak, 0)[0].name == "steady"
    assert found(weak) is None


def test_of_laws_that_fit_nearly_alike_the_simplest_is_taken():
    """A force that five instants lack is steady: by its information alone it would begin with the sixth."""
    late = np.where(TIME > 0.045, 1000.0, 0.0)
    assert fits(late, 0)[0].name == "constant"
    assert found(late).law == "steady"
