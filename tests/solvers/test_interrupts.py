"""An interrupt (Ctrl-C) while compiled kernels run: no crash, a saved run, and a message that states how to go on."""

import os
import signal
import threading

import numpy as np
import pytest

from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import MODELS
from blockshake.solvers import pieces

pytestmark = pytest.mark.usefixtures("heeded_interrupts")
TIMES = np.arange(0.0, 60.0, 0.005)


def _interrupt():
    os.kill(os.getpid(), signal.SIGINT)


def _run(model, **options):
    row = MODELS[model]
    row.solve(load_structure("configuration-1"), None, row.schema(), TIMES, row.time_step, **options)


@pytest.fixture
def interrupted_under_way(monkeypatch):
    """Interrupt a twentieth of a second after the first piece, from another thread: a kernel runs then."""

    def next_piece(steps, spent):
        if not timers:
            timers.append(threading.Timer(0.05, _interrupt))
            timers[0].start()
        return original(steps, spent)

    timers, original = [], pieces._next_piece
    monkeypatch.setattr(pieces, "_next_piece", next_piece)


@pytest.mark.parametrize("model", sorted(MODELS))
def test_a_function_call_says_how_to_go_on(model, tmp_path, interrupted_under_way):
    path = tmp_path / "run.checkpoint"
    with pytest.raises(KeyboardInterrupt, match=rf"interrupted at [0-9.]+ s; .* goes on from {path}"):
        _run(model, checkpoint=path)
    assert path.exists()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.parametrize("model", sorted(MODELS))
def test_without_a_checkpoint_it_says_so(model, interrupted_under_way):
    with pytest.raises(KeyboardInterrupt, match="nothing of it is saved"):
        _run(model)


@pytest.mark.parametrize(("spent", "steps"), [(0.0, 200), (0.3, 100), (0.6, 50), (100.0, 50)])
def test_pieces_take_about_as_long(spent, steps):
    assert pieces._next_piece(100, spent) == steps
