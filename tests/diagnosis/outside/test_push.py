"""The start of a push: found where rows tell of it, and else said to be then or earlier."""

from types import SimpleNamespace

import numpy as np
import pytest

from blockshake.diagnosis.evidence.likelihood import from_rows
from blockshake.diagnosis.outside.push import explain_push

TIME = np.arange(4.0, 6.0, 0.05)  # s; a joint is open
FORCE, NOISE = 2000.0, 100.0  # N
RISE = 0.25  # s


@pytest.mark.parametrize(("start", "before"), [(1.0, ["t1"]), (4.75, [])])
def test_a_push_from_before_the_first_opening_is_said_to_start_then_or_earlier(start, before):
    rows = FORCE * np.clip((TIME - start) / RISE, 0.0, 1.0)
    rows += np.random.default_rng(3).normal(0.0, NOISE, len(TIME))
    likelihood = from_rows([NOISE**2 * np.eye(len(TIME))], [rows], [])
    points = SimpleNamespace(
        place="block-2@0", by_test=[SimpleNamespace(time=TIME, unit=np.ones(len(TIME)))], tests=["t1"]
    )
    fit = explain_push(likelihood, points, 30e3).best
    assert fit.mean[0] == pytest.approx(FORCE, rel=0.05)
    assert fit.values.get("before", []) == before
    assert fit.values["starts"]["t1"] == pytest.approx(max(start, TIME[0] - RISE), abs=0.1)
