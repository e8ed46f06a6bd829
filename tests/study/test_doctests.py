import doctest
import importlib

import pytest

import blockshake
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
    public = {getattr(blockshake, name).__qualname__ for name in blockshake.__all__}
    runner = doctest.DocTestRunner()
    for example in doctest.DocTestFinder().find(module):
        if example.name.rpartition(".")[2] not in public:  # these have a test of their own
            runner.run(example)
    assert runner.summarize(verbose=False).failed == 0
