"""A run in pieces of bounded wall time: between two pieces come news, checkpoints and interrupts."""

import logging
import time

from blockshake.solvers.interrupts import held_interrupts
from blockshake.solvers.status import PAUSED, STEP

_log = logging.getLogger(__name__)
_NEWS = 10.0  # s of wall time between lines of progress
_FIRST_PIECE = 100  # steps; later pieces grow and shrink towards _PIECE
_PIECE = 0.25  # s of wall time


class Due:
    """Whether an interval of wall time has passed since it last had, or since the start.

    ``interval`` [s]; zero is always due.
    """

    def __init__(self, interval):
        self._interval, self._last = interval, time.monotonic()

    def __call__(self):
        """True once an interval."""
        now = time.monotonic()
        if now - self._last < self._interval:
            return False
        self._last = now
        return True


def run_in_pieces(start, integrate, time_step, end_time, checkpoint):
    """Run a solver to its end, from its checkpoint where there is one and from the start elsewhere.

    Parameters
    ----------
    start : callable
        ``start()`` gives the parts of the run before its first step: a tuple whose first entry is the
        solver's progress, with its ``clock``.
    integrate : callable
        ``integrate(pause, *parts)`` goes on to step ``pause`` at most and gives ``code, culprit, parts``: a code of
        `blockshake.solvers.status`, the body that ended the run or -1, and the parts as they are then.
    time_step, end_time : float
        [s], for the news.
    checkpoint : Checkpoint

    Returns
    -------
    code, culprit, parts
        As from the last piece. The checkpoint is taken away.

    Raises
    ------
    KeyboardInterrupt
        An interrupt came. The run is saved where a checkpoint is asked for, and the message says how to go on.

    Notes
    -----
    A piece has twice the steps of the one before, or half of them, where that took less than `_PIECE` or more
    than twice as long. No result depends on where the pieces end.
    """
    with held_interrupts() as interrupted:
        parts = checkpoint.load()
        if parts is None:
            parts = start()
        else:
            _log.info("goes on from %.3f s", parts[0].clock[STEP] * time_step)
        news, saving = Due(_NEWS), Due(checkpoint.interval)
        code, steps = PAUSED, _FIRST_PIECE
        while code == PAUSED:
            began = time.monotonic()
            code, culprit, parts = integrate(int(parts[0].clock[STEP]) + steps, *parts)
            steps = _next_piece(steps, time.monotonic() - began)
            reached = parts[0].clock[STEP] * time_step
            if news():
                _log.info("%.3f of %.3f s", reached, end_time)
            stop = interrupted()
            if code == PAUSED and (stop or saving()):
                checkpoint.save(parts)
            if stop:
                raise KeyboardInterrupt(f"interrupted at {reached:.3f} s; {checkpoint.advice()}")
    checkpoint.remove()
    return code, culprit, parts


def _next_piece(steps, spent):
    """Steps of the next piece after one that took ``spent`` seconds of wall time."""
    if spent < _PIECE:
        return 2 * steps
    return max(steps // 2, 1) if spent > 2.0 * _PIECE else steps
