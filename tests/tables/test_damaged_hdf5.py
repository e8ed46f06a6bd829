"""A global heap whose objects lead nowhere holds the HDF5 library for ever: such files are refused unread."""

import struct

import pytest
import xarray as xr

from blockshake.tables.damaged_hdf5 import has_endless_heap

HEAP = b"GCOL\x01\x00\x00\x00"


@pytest.fixture
def good(tmp_path):
    path = tmp_path / "good.nc"
    xr.Dataset({"a": (("x", "y"), [[1.0, 2.0]])}, {"x": ["one"], "y": ["a", "b"]}).to_netcdf(path)
    return path


def _objects(content):
    """Places and indices of the objects in the first heap of a file."""
    start = content.index(HEAP)
    end, place = start + struct.unpack_from("<Q", content, start + 8)[0], start + 16
    while place < end:
        index, length = struct.unpack_from("<H6xQ", content, place)
        yield place, index
        place += length if index == 0 else 16 + -(-length // 8) * 8


def test_what_the_library_wrote_is_read(good):
    assert {index == 0 for _, index in _objects(good.read_bytes())} == {False, True}
    assert not has_endless_heap(good)


@pytest.mark.parametrize("length", [0, 2**64 - 16, 2**64 - 20])
def test_an_object_without_a_way_to_the_next_is_found(good, length):
    content = bytearray(good.read_bytes())
    place, _ = next(one for one in _objects(content) if (one[1] == 0) == (length == 0))
    struct.pack_into("<Q", content, place + 8, length)
    good.write_bytes(content)
    assert has_endless_heap(good)


def test_zeroed_bytes_in_a_heap_are_found(good):
    content = bytearray(good.read_bytes())
    place = content.index(HEAP) + 16
    content[place : place + 64] = bytes(64)
    good.write_bytes(content)
    assert has_endless_heap(good)


@pytest.mark.parametrize(
    "content",
    [
        b"\x89HDF\r\n\x1a\n\x09\x08\x08" + HEAP + bytes(64),
        b"x",
        b"\x89HDF\r\n\x1a\n\x00",
        HEAP,
        b"\x89HDF\r\n\x1a\n\x02\x08\x08" + HEAP,
    ],
)
def test_other_and_cut_files_are_left_to_their_readers(tmp_path, content):
    path = tmp_path / "odd.nc"
    path.write_bytes(content)
    assert not has_endless_heap(path)
