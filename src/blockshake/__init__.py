"""blockshake: how stacks of heavy blocks behave in an earthquake, and how sure we are.

The same as the command line, as functions. They are loaded when first requested, so that a rule that only draws a
figure compiles no solver.
"""

import importlib
import re
from pathlib import Path

from blockshake.caches import set_cache_home

__version__ = "0.9.0"

# the names, with their modules, that editors and type checkers read
_NAMES = Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8")
_HOMES = {name: home for home, name in re.findall(r"^from (\S+) import (\w+) as", _NAMES, re.MULTILINE)}
__all__ = list(_HOMES)
set_cache_home()


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError(f"module 'blockshake' has no attribute '{name}'")
    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__():
    return sorted(["__version__", *_HOMES])
