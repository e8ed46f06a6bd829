import doctest
import importlib

import pytest

from blockshake.files import PACKAGE

ROOMS = ("statistics", "study", "pages")
MODULES = [
    ".".join(("blockshake", *path.relative_to(PACKAGE).with_suffix("").parts))
    for room in ROOMS
    for path in sorted(PACKAGE.joinpath(room).rglob("*.py"))
    if ">>> " in path.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_give_what_they_show(name):
    module = importlib.import_module(name)
    found = doctest.testmod(module)
    assert found.attempted > 0
    assert found.failed == 0
