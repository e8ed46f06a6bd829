"""An edge that crushes under load, in rows of one rocking joint that are made of known insets."""

from types import SimpleNamespace

import numpy as np
import pytest

from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.diagnosis.outside.changed_edge import explain_changed_edge

WEIGHT, ERROR = 2e5, 2e-3  # N, m
TIME = np.arange(0.0, 8.0, 0.05)
EDGE = np.where((TIME // 0.5) % 2 == 0, 1, -1)  # the joint rocks to the other edge every half second
CHANGES = np.roll(EDGE, 1) != EDGE  # it has just come down on the edge: no row
KEY = 0, 0


def explained(*insets):
    """The changed edge of tests whose edge towards +x lies further in by some history each [m]."""
    corners = np.array([[0.4, 1.0, 0.0], [-0.4, -1.0, 0.0]])
    inward = np.where(CHANGES, 0.0, WEIGHT * EDGE)
    generator = np.random.default_rng(5)
    hinge = SimpleNamespace(inward=inward, edge=EDGE)
    tests = [
        SimpleNamespace(
            rows=SimpleNamespace(
                time=TIME,
                value=inward * np.where(EDGE == 1, inset, 0.0)
                + WEIGHT * ERROR * generator.standard_normal(len(TIME)),
            ),
            hinges={KEY: hinge},
            seen=SimpleNamespace(name=f"t{number}", faces=[SimpleNamespace(corners=corners)]),
        )
        for number, inset in enumerate(insets, start=1)
    ]
    covariances = [(WEIGHT * ERROR) ** 2 * np.eye(len(TIME)) for _ in tests]
    likelihood = from_rows(covariances, [test.rows.value for test in tests], [])
    (found,) = explain_changed_edge(likelihood, tests, "slab-block-1", KEY)
    return found


def test_an_edge_that_crushes_each_time_that_it_bears_is_found_with_its_last_inset():
    steps = 0.02 * np.floor(TIME / 2.0)
    found = explained(0.0 * TIME, steps, steps[-1] + 0.0 * TIME)
    assert found.best.values["crushed"]
    assert (found.best.values["test"], found.best.values["edge"], found.best.values["lasts"]) == (
        "t2",
        1,
        True,
    )
    assert found.best.values["before"] == ["t1"]
    assert found.best.mean[0] == pytest.approx(0.06, abs=1e-3)
    assert np.concatenate(found.rows) == pytest.approx(
        np.concatenate(
            [0.0 * TIME, *(np.where(CHANGES | (EDGE == -1), 0.0, WEIGHT * one) for one in (steps, 0.06))]
        ),
        abs=3.0 * WEIGHT * ERROR,
    )


def test_an_edge_that_comes_back_has_not_crushed_and_one_that_changed_at_once_is_no_crushing():
    crushed = explained(0.0 * TIME, 0.02 * np.floor(TIME / 2.0), 0.06 + 0.0 * TIME).gain
    back = explained(0.0 * TIME, 0.06 - 0.02 * np.floor(TIME / 2.0), 0.0 * TIME)
    assert back.gain < 0.5 * crushed
    at_once = explained(0.0 * TIME, np.where(TIME > 3.9, 0.06, 0.0), 0.06 + 0.0 * TIME)
    assert "crushed" not in at_once.best.values
