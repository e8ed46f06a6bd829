"""A decision frozen by its hash before sealed tests are opened, so that nothing in them can have moved it."""

import json
from pathlib import Path

from blockshake.errors import InputError
from blockshake.files import file_digest, write_json


def freeze(path, decision, tests):
    """Write the digest of a decision's file and the tests that it rests on."""
    write_json(path, {"decision": file_digest(decision), "tests": list(tests)})


def check_frozen(path, decision):
    """Refuse a decision that is another than the frozen one.

    Raises
    ------
    InputError
    """
    frozen = json.loads(Path(path).read_text())["decision"]
    found = file_digest(decision)
    if found != frozen:
        raise InputError(decision, "", f"expected the decision that was frozen as {frozen}, found {found}")
