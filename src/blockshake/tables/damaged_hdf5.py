"""Damage of an HDF5 file: errors of its readers, and a fault on which its library never comes back."""

import mmap
import struct

# errors that the reader of a damaged file may raise
DAMAGE = (OSError, ValueError, RuntimeError, LookupError, TypeError, AttributeError, MemoryError)
_HEAP = b"GCOL\x01\x00\x00\x00"  # of a global heap: signature, version, three reserved bytes
_BYTES = 8  # in a length; the library can write others, netCDF's never does
_HEADER = 16  # bytes, of a heap and of an object in it
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_PLACE_OF_LENGTHS = {0: 14, 1: 14, 2: 10, 3: 10}  # of the bytes in a length, by version of the superblock


def has_endless_heap(path):
    """Whether a file is HDF5 with a global heap that its library reads for ever.

    Parameters
    ----------
    path : path
        Any file, not empty.

    Notes
    -----
    A global heap is a row of objects: index, references, length, content (HDF5 File Format Specification, version 3.0,
    section III.E). Index 0 is free space, whose length counts its own header. HDF5 2.2 takes that length for the way
    to the next object, so that a length of 0, as zeroed bytes have it, holds the library at one place; a length near
    2^64 of another object does so too. Lengths that lead out of the heap are refused by the library itself.
    """
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        if content[:8] != _SIGNATURE or len(content) < _HEADER:
            return False
        if content[8] not in _PLACE_OF_LENGTHS or content[_PLACE_OF_LENGTHS[content[8]]] != _BYTES:
            return False
        start = content.find(_HEAP)
        while start >= 0:
            if _is_endless(content, start):
                return True
            start = content.find(_HEAP, start + 1)
    return False


def _is_endless(content, start):
    """Whether the walk from object to object of the heap at a place stands still."""
    if start + _HEADER > len(content):
        return False
    end = min(start + struct.unpack_from("<Q", content, start + 8)[0], len(content))
    position = start + _HEADER
    while position + _HEADER <= end:
        index, length = struct.unpack_from("<H6xQ", content, position)
        way = length if index == 0 else (_HEADER + (length + 7) // 8 * 8) % 2**64
        if way == 0:
            return True
        position += way
    return False
