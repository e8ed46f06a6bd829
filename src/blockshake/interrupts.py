"""Interrupts (Ctrl-C) that wait while code runs which an exception out of nowhere would break."""

import contextlib
import signal
import threading


@contextlib.contextmanager
def held_interrupts(at_once=lambda: False):
    """Context in which an interrupt is noted and not raised; its value is a function that states whether one came.

    Parameters
    ----------
    at_once : callable
        Whether an interrupt is to be raised nevertheless.

    Notes
    -----
    Outside the main thread, and where interrupts are ignored, nothing changes.
    """
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield lambda: False
        return
    noted = []

    def note(number, frame):
        if at_once():
            handler(number, frame)
        noted.append(number)

    signal.signal(signal.SIGINT, note)
    try:
        yield lambda: bool(noted)
    finally:
        signal.signal(signal.SIGINT, handler)


@contextlib.contextmanager
def delayed_interrupts():
    """Context at whose end an interrupt is raised that came in it.

    Xarray takes locks around netCDF's library. An interrupt between a lock that is taken and the block that gives it
    back leaves the lock taken, and the file is then closed under the same lock: the process waits for itself.
    """
    with held_interrupts() as interrupted:
        yield
    if interrupted():
        signal.raise_signal(signal.SIGINT)
