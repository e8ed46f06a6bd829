"""An interrupt (Ctrl-C) waits until it can be raised."""

import os
import signal
import threading

import pytest
import xarray as xr

from blockshake.files import write_dataset
from blockshake.interrupts import delayed_interrupts, held_interrupts
from blockshake.store import load_made

pytestmark = pytest.mark.usefixtures("heeded_interrupts")
DATASET = xr.Dataset({"a": ("x", [1.0, 2.0])})


def _interrupt():
    os.kill(os.getpid(), signal.SIGINT)


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


def _interrupted(called, ended):
    """A function that is interrupted as it begins, and notes that it ended."""

    def run(*given, **named):
        _interrupt()
        result = called(*given, **named)
        ended.append(called.__name__)
        return result

    return run


def test_an_interrupt_waits_until_a_file_is_written_and_leaves_no_part_of_it(tmp_path, monkeypatch):
    """Among xarray's locks it left a lock taken, and the process waited for itself for ever."""
    ended = []
    monkeypatch.setattr(xr.Dataset, "to_netcdf", _interrupted(xr.Dataset.to_netcdf, ended))
    with pytest.raises(KeyboardInterrupt):
        write_dataset(tmp_path / "a.nc", DATASET)
    assert ended == ["to_netcdf"]
    assert list(tmp_path.iterdir()) == []


def test_an_interrupt_waits_until_a_file_is_read(tmp_path, monkeypatch):
    ended = []
    write_dataset(tmp_path / "a.nc", DATASET)
    monkeypatch.setattr(xr, "open_dataset", _interrupted(xr.open_dataset, ended))
    with pytest.raises(KeyboardInterrupt):
        load_made(tmp_path / "a.nc")
    assert ended == ["open_dataset"]
