"""Scenes that are handed to a peer, and the message where a peer is missing; needs no peer."""

import json

import numpy as np
import peers
import pytest
from motions import harmonic

from blockshake.geometry.structure import load_structure


def test_a_task_says_all_that_a_peer_cannot_know():
    structure, motion = load_structure("configuration-3"), harmonic(1.0)
    task = json.loads(json.dumps(peers.block_task(structure, motion, 1e-3, 100)))
    assert [body["driven"] for body in task["bodies"]] == structure.driven.tolist()
    assert np.array(task["shapes"]["block"]["vertices"]) == pytest.approx(structure.solids["block"].vertices)
    # a harmonic of 1.5 m/s2: the velocity after a quarter of a second would be -A / omega; at 0.1 s, its sine
    omega = 2.0 * np.pi
    assert task["velocity"][100][0] == pytest.approx(-1.5 / omega * np.sin(0.1 * omega), rel=1e-6)
    assert task["acceleration"][100][0] == pytest.approx(-1.5 * np.cos(0.1 * omega), rel=1e-4)


@pytest.mark.parametrize(
    ("parameters", "what"),
    [({"friction.concrete.concrete": 0.5}, "one coefficient"), ({"gravity": [0, 0, -9.8]}, "rest")],
)
def test_what_a_peer_cannot_do_is_refused(parameters, what):
    with pytest.raises(ValueError, match=what):
        peers.block_task(load_structure("configuration-1", parameters), None, 1e-3, 10)


def test_no_environment_is_no_peer(monkeypatch, tmp_path):
    monkeypatch.setattr(peers, "PYTHON", tmp_path / "python")
    assert peers.peer_version(peers.LMGC90) is None
