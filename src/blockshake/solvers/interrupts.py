"""Interrupts (Ctrl-C) that wait until no compiled kernel is handing results back to Python."""

import contextlib
import signal
import threading

from blockshake.jit import compiling


@contextlib.contextmanager
def held_interrupts():
    """Context in which an interrupt is noted and not raised; its value is a function that says whether one came.

    Notes
    -----
    Numba builds the named tuples that a kernel returns by calling Python, and an interrupt that came during the
    kernel is raised in that call. Numba does not look for the exception: it goes on with a null pointer, and the
    process dies of a segmentation fault. Numba's compiler is ordinary Python, in which an interrupt is raised at once.
    Outside the main thread, and where interrupts are ignored, nothing changes.
    """
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield lambda: False
        return
    noted = []

    def note(number, frame):
        if compiling():
            handler(number, frame)
        noted.append(number)

    signal.signal(signal.SIGINT, note)
    try:
        yield lambda: bool(noted)
    finally:
        signal.signal(signal.SIGINT, handler)
