"""A store gives back whole units as they were put there, and never a part of one, or another's."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
import xarray as xr

from blockshake.errors import InputError
from blockshake.files import write_dataset
from blockshake.store import Store, Unit, kept, load_made

DATASET = xr.Dataset(
    {"v": ("time", np.linspace(0.0, 1.0, 500) ** 3, {"units": "m"}), "who": ("k", ["a", "bc"])}
)


@dataclass(frozen=True)
class Made(Unit):
    """A unit of a value that is known, made by a function of the checkpoint's path."""

    given: object
    make: ClassVar = None

    def made(self, checkpoint):
        return type(self).make(checkpoint)


def unit(given, make):
    return type("Made", (Made,), {"make": staticmethod(make)})(given)


def _put(folder, name="a"):
    """A unit of some name; its path."""
    run = DATASET.assign_attrs(status="completed")
    return Store(folder, "source").dataset("a run", unit(name, lambda _: run))


def _cut(path):
    path.write_bytes(path.read_bytes()[:-1000])


def _emptied(path):
    path.write_bytes(b"")


def _flipped(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def _foreign(path):
    write_dataset(path, DATASET)


def _of_another_name(path):
    path.write_bytes(_put(path.parent, "other").read_bytes())


def _a_folder(path):
    path.unlink()
    path.mkdir()


def test_a_kept_dataset_is_an_ordinary_file(tmp_path):
    path = _put(tmp_path / "store")
    assert kept(path)
    assert not kept(path.with_name("other.nc"))
    xr.testing.assert_equal(xr.load_dataset(path), DATASET)
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("damage", [_cut, _emptied, _flipped, _foreign, _of_another_name, _a_folder])
def test_damage_is_seen(damage, tmp_path):
    path = _put(tmp_path)
    damage(path)
    assert not kept(path)


def test_a_value_is_made_once_and_a_damaged_one_anew(tmp_path):
    made = []

    def make(_):
        made.append({"peak": 0.1 + 0.2, "none": float("nan"), "text": "é"})
        return made[-1]

    first = Store(tmp_path / "store", "source").value(unit("key", make))
    assert first["peak"] == 0.1 + 0.2
    assert np.isnan(first["none"])
    assert Store(tmp_path / "store", "source").value(unit("key", make))["text"] == "é"
    assert len(made) == 1
    (path,) = (tmp_path / "store").iterdir()
    for count, damage in enumerate((_cut, _emptied, _flipped), start=2):
        damage(path)
        assert Store(tmp_path / "store", "source").value(unit("key", make))["peak"] == 0.1 + 0.2
        assert len(made) == count
        assert kept(path)


def test_what_fails_leaves_nothing(tmp_path):
    with pytest.raises(TypeError):
        Store(tmp_path / "store", "source").value(unit("key", lambda _: {"a": object()}))
    assert list((tmp_path / "store").iterdir()) == []


@pytest.mark.parametrize("damage", [_cut, _emptied, lambda path: path.write_text("time,x"), _a_folder])
def test_a_damaged_file_of_an_earlier_job_is_one_line(damage, tmp_path):
    write_dataset(tmp_path / "a.nc", DATASET)
    xr.testing.assert_identical(load_made(tmp_path / "a.nc"), DATASET)
    damage(tmp_path / "a.nc")
    with pytest.raises(
        InputError, match=r"a\.nc: expected the netCDF file that an earlier job made; delete it"
    ) as error:
        load_made(tmp_path / "a.nc")
    assert "\n" not in str(error.value)


def test_a_run_is_made_once_by_each_source_and_the_line_says_how_it_ended(tmp_path):
    lines, made = [], []

    def make(checkpoint):
        made.append(checkpoint)
        return DATASET.assign_attrs(status="falling", reason="a block")

    path = Store(tmp_path, "source", lines.append).dataset("run 1", unit((1.0, np.arange(3.0)), make))
    assert Store(tmp_path, "source", lines.append).dataset("run 1", unit((1.0, np.arange(3.0)), make)) == path
    assert [line.partition("; took")[0] for line in lines] == [
        "run 1, simulated: falling a block",
        "run 1, kept: falling a block",
    ]
    assert made == [path.with_suffix(".checkpoint")]
    xr.testing.assert_equal(xr.load_dataset(path), DATASET)
    others = [("other", (1.0, np.arange(3.0))), ("source", (1.0, np.arange(1.0, 4.0))), ("source", (2.0,))]
    for source, given in others:
        assert Store(tmp_path, source, lines.append).dataset("run 1", unit(given, make)) != path
    assert len(made) == 4
