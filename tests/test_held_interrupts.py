"""An interrupt (Ctrl-C) waits until it can be raised."""

import os
import signal
import threading

import pytest
import xarray as xr

from blockshake.files import write_dataset
from blockshake.interrupts import delayed_interrupts, held_interrupts


def _interrupt():
    os.kill(os.getpid(), signal.SIGINT)


@pytest.fixture(autouse=True)
def heeded_interrupts():
    """Interrupts raise, also where the tests run in a shell's background and would ignore them."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_interrupts_wait_until_asked_for():
    with held_interrupts() as interrupted:
        assert not interrupted()
        _interrupt()
        assert interrupted()
    with pytest.raises(KeyboardInterrupt):
        _interrupt()


def test_ignored_interrupts_stay_ignored():
    """As in a background job of a shell."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with held_interrupts() as interrupted:
        _interrupt()
        assert not interrupted()


def test_another_thread_is_left_alone():
    seen = []

    def work():
        with held_interrupts() as interrupted:
            seen.append(interrupted())

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [False]


def test_a_delayed_interrupt_is_raised_at_the_end():
    passed = []

    def work():
        with delayed_interrupts():
            _interrupt()
            passed.append("the interrupt")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert passed == ["the interrupt"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_interrupt_while_a_file_is_written_leaves_no_lock(tmp_path, monkeypatch):
    """One that came among xarray's locks left a lock taken, and the process waited for itself for ever."""
    written = xr.Dataset.to_netcdf

    def interrupted(self, *given, **named):
        _interrupt()
        return written(self, *given, **named)

    monkeypatch.setattr(xr.Dataset, "to_netcdf", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_dataset(tmp_path / "a.nc", xr.Dataset({"a": ("x", [1.0, 2.0])}))
    assert list(tmp_path.iterdir()) == []
    monkeypatch.undo()
    write_dataset(tmp_path / "a.nc", xr.Dataset({"a": ("x", [1.0, 2.0])}))
    assert xr.load_dataset(tmp_path / "a.nc")["a"].values.tolist() == [1.0, 2.0]
