"""A file frozen by its hash before sealed tests are opened: one that was changed since is refused."""

from blockshake.errors import InputError
from blockshake.files import file_digest, load_made_json, write_json


def freeze(path, decided, tests):
    """Write the digest of a file that was decided, a decision or a size, and the tests that it rests on."""
    write_json(path, {"digest": file_digest(decided), "tests": list(tests)})


def check_frozen(path, decided):
    """Refuse a file that is another than the frozen one.

    Raises
    ------
    InputError
    """
    frozen = load_made_json(path, lambda value: str(value["digest"]))
    found = file_digest(decided)
    if found != frozen:
        raise InputError(decided, "", f"expected the file that was frozen as {frozen}, found {found}")
