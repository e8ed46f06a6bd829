"""A run in pieces of bounded wall time: between two pieces come news, checkpoints, interrupts, and rows are kept."""

import logging
import time

from blockshake.interrupts import held_interrupts
from blockshake.jit import compiling
from blockshake.solvers.checkpoint import AT_HAND
from blockshake.solvers.record import NEXT_RECORD, PAUSED, STEP, empty_record, last_step, rows_at_hand

_log = logging.getLogger(__name__)
_NEWS = 10.0  # s of wall time between lines of progress
_FIRST_PIECE = 100  # steps; later pieces grow and shrink towards _PIECE
_PIECE = 0.25  # s of wall time
_SAVING = 60.0  # s of wall time between savings


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


def run_in_pieces(start, integrate, rows_of, times, time_step, checkpoint, kept=None):
    """Run a solver to its end, from its checkpoint where there is one and from the start elsewhere.

    Parameters
    ----------
    start : callable
        ``start()`` gives the parts of the run before its first step, but for the record: a tuple whose first entry is
        the solver's progress, with its ``clock``.
    integrate : callable
        ``integrate(pause, *parts)`` goes on to step ``pause`` at most and gives ``code, culprit, *parts``: a code of
        `blockshake.solvers.record`, the body that ended the run or -1, and the last of the parts, where the others
        have changed in place. The last part is the record.
    rows_of : callable
        ``rows_of(*parts)`` gives the record as `Rows`.
    times : float64 array, shape (n_times,)
        The record [s].
    time_step : float
        [s]
    checkpoint : Checkpoint
    kept : KeptRows, optional
        Where the record goes whenever some rows of it are full. By default it is in memory to the end.

    Returns
    -------
    code, culprit, parts
        As from the last piece, the record with the rows that were not handed over. The checkpoint is taken away,
        unless rows are kept: they and the checkpoint are of use until the run file is written.

    Raises
    ------
    KeyboardInterrupt
        An interrupt came. The run is saved where a checkpoint is requested, and the message states how to go on.

    Notes
    -----
    A piece has twice the steps of the one before, or half of them, where that took less than `_PIECE` or more
    than twice as long. No result depends on where the pieces end.

    Interrupts are held meanwhile. Numba builds the named tuples that a kernel returns by calling Python, and an
    interrupt that came during the kernel is raised in that call. Numba does not look for the exception: it goes on with
    a null pointer, and the process dies of a segmentation fault. Numba's compiler is ordinary Python, in which an
    interrupt is raised at once.
    """
    most = len(times) if kept is None else AT_HAND

    def record_from(first, progress, room=0):
        n_rows = rows_at_hand(times, first, progress.clock[STEP], time_step, most)
        return empty_record(first, n_rows, len(progress.state.position), room)

    with held_interrupts(at_once=compiling) as interrupted:
        parts = checkpoint.load()
        if parts is not None and _has_all_rows(parts[-1], times, checkpoint, kept):
            _log.info("goes on from %.3f s", parts[0].clock[STEP] * time_step)
        else:
            if kept is not None:
                kept.begin(checkpoint.key)
            parts = start()
            parts = (*parts, record_from(0, parts[0]))
        news, saving = Due(_NEWS), Due(_SAVING)
        code, steps, full = PAUSED, _FIRST_PIECE, last_step(times, parts[-1], time_step)
        while code == PAUSED:
            began, before = time.monotonic(), int(parts[0].clock[STEP])
            pause = min(before + steps, full)
            code, culprit, *changed = integrate(pause, *parts)
            parts = (*parts[: len(parts) - len(changed)], *changed)
            steps = _next_piece(pause - before, time.monotonic() - began)
            progress, record = parts[0], parts[-1]
            if code == PAUSED and progress.clock[STEP] == full:
                first, until = int(record.first[0]), int(progress.clock[NEXT_RECORD])
                kept.put(first, rows_of(*parts).at(slice(until - first)))
                parts = (*parts[:-1], record_from(until, progress, record.joint_force.shape[1]))
                full = last_step(times, parts[-1], time_step)
            reached = progress.clock[STEP] * time_step
            if news():
                _log.info("%.3f of %.3f s", reached, times[-1])
            stop = interrupted()
            if code == PAUSED and (stop or saving()):
                checkpoint.save(parts)
            if stop:
                raise KeyboardInterrupt(f"interrupted at {reached:.3f} s; {checkpoint.advice()}")
    if kept is None:
        checkpoint.remove()
    return code, culprit, parts


def _has_all_rows(record, times, checkpoint, kept):
    """Whether the record of a checkpoint is whole, or all rows before it are kept."""
    if kept is None:
        return len(record.energy) == len(times)
    return kept.goes_on(checkpoint.key, int(record.first[0]))


def _next_piece(steps, spent):
    """Steps of the next piece after one that took ``spent`` seconds of wall time."""
    if spent < _PIECE:
        return 2 * steps
    return max(steps // 2, 1) if spent > 2.0 * _PIECE else steps
