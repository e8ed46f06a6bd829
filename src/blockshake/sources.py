"""Which sources make which result: what a workflow rule watches, so that an edit reruns just what it touches.

Nothing is listed by hand: a script's sources are the files that it imports, directly or not.
"""

import ast
import contextlib
import functools
import hashlib
import json
import os
import sys
from pathlib import Path
from typing import NamedTuple

from blockshake.caches import user_cache
from blockshake.errors import InputError
from blockshake.files import HOME, PACKAGE, content_digest, write_text
from blockshake.measurement.campaigns.kinds import KINDS, CampaignKind, Late

_SCRIPTS = HOME / "workflow" / "scripts"
# These write logs, say where kernels are kept, or decide what is in the names of the files made and in the parameters
# of rules: they compute nothing else.
_COMPUTE_NOTHING = (
    "measurement/campaigns/kinds.py",
    "caches.py",
    "log.py",
    "sources.py",
    "diagnosis/nominal/plan.py",
)
_COLUMNS = {name for name, kind in CampaignKind.__annotations__.items() if kind is Late}
# Of these only the functions that are taken count, each with its own imports.
_BY_FUNCTION = ("diagnosis/steps.py",)
_READER = sys.version + Path(__file__).read_text(encoding="utf-8")  # by which a text is read
_KEPT = user_cache() / "blockshake" / "sources"  # folder of what texts came to
_HOLD_STATEMENTS = ast.stmt, ast.ExceptHandler, ast.match_case


@functools.cache
def script_sources(script, *models):
    """Sources of a rule.

    Parameters
    ----------
    script : str
        Name of the file in ``workflow/scripts``, without its suffix.
    *models : str
        Models that it runs by their names, of the table `blockshake.simulation.models.MODELS`.

    Returns
    -------
    tuple of str
        Files of the package, and functions of files as ``FILE:FUNCTION``, for `source_digest`.
    """
    return _closure([*_read(_SCRIPTS / f"{script}.py").imported, *_modules_of(models)])


@functools.cache
def kernel_sources(*models):
    """Sources of what a model's driver runs."""
    return _closure(_modules_of(models))


def module_sources(module, *models):
    """Sources of what a module computes, given as its path in the package, with the models that it runs."""
    return _closure([module, *_modules_of(models)])


@functools.cache
def compiled_sources():
    """All files that hold kernels, and what these import: the rest may change without compiling anew."""
    return _closure(
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        if "\nfrom blockshake.jit import" in path.read_text(encoding="utf-8")
    )


@functools.cache
def source_digest(*sources):
    """Twelve hexadecimal digits that identify what sources compute.

    Parameters
    ----------
    *sources : str
        Files of the package, or functions of files, such as ``"files.py"`` or
        ``"diagnosis/steps.py:decide"``.

    Notes
    -----
    Comments, docstrings and layout do not count: the digest is of the syntax trees, so that a
    better explanation reruns no simulation.
    """
    digest = hashlib.sha256()
    for source in sources:
        name, _, function = source.partition(":")
        digest.update(name.encode())
        digest.update(_read(PACKAGE / name, function).digest)
    return digest.hexdigest()[:12]


class _Source(NamedTuple):
    """A file, or its top and one of its functions."""

    digest: bytes  # of its syntax
    imported: list  # sources that it imports, as `script_sources` names them


def _modules_of(models):
    from blockshake.simulation.models import solver_of

    return [_file(module) for model in models for module in solver_of(model).modules]


def _closure(sources):
    """Sources that these import, directly or not, and these themselves, sorted."""
    taken, waiting = set(), list(sources)
    while waiting:
        source = waiting.pop()
        if source in taken or source in _COMPUTE_NOTHING:
            continue
        taken.add(source)
        name, _, function = source.partition(":")
        waiting += _read(PACKAGE / name, function).imported
    return tuple(sorted(source for source in taken if not source.endswith("__init__.py")))


@functools.cache
def _read(path, function=""):
    """Read a file, or its top and one of its functions; what a text comes to is kept, since parsing all takes long."""
    text = path.read_text(encoding="utf-8")
    kept = _KEPT / f"{content_digest(_READER, function, text)}.json"
    try:
        digest, imported, seal = json.loads(kept.read_bytes())
    except (OSError, TypeError, ValueError):  # none, or one that was cut
        seal = None
    if seal is None or seal != content_digest(digest, imported):
        digest, imported = _parsed(text, function)
        with contextlib.suppress(InputError, OSError):
            write_text(kept, json.dumps([digest, imported, content_digest(digest, imported)]))
    return _Source(bytes.fromhex(digest), [one for names in imported for one in _imported(*names)])


def _parsed(text, function):
    """Digest of the syntax of a text, or of its top and one of its functions, and modules and names that it imports."""
    tree = ast.parse(text)
    if function:
        tree.body = [node for node in tree.body if getattr(node, "name", function) == function]
    imported = []
    for statement in _statements(tree):
        _drop_docstring(statement)
        if isinstance(statement, ast.ImportFrom) and (statement.module or "").startswith("blockshake"):
            imported += [[statement.module, alias.name] for alias in statement.names]
    imported += [["", node.attr] for node in ast.walk(tree) if _is_of_kind(node)]
    return hashlib.sha256(ast.dump(tree).encode()).hexdigest(), imported


def _statements(tree):
    """Statements of a tree at any depth, and what holds them; expressions hold none."""
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        waiting += [child for child in ast.iter_child_nodes(node) if isinstance(child, _HOLD_STATEMENTS)]


def _is_of_kind(node):
    """Whether an expression is ``campaign.kind.decide`` or another column of functions of `CampaignKind`."""
    return (
        isinstance(node, ast.Attribute)
        and getattr(node.value, "attr", "") == "kind"
        and node.attr in _COLUMNS
    )


def _drop_docstring(node):
    body = getattr(node, "body", None)
    if body and isinstance(body[0], ast.Expr) and isinstance(getattr(body[0].value, "value", None), str):
        del body[0]


@functools.cache
def _imported(module, name):
    """Sources that a name of a module comes from; without a module, those of a column of `KINDS`."""
    if not module:
        return [one for kind in KINDS for one in _imported(*getattr(kind, name))]
    inside = _file(f"{module}.{name}")
    if (PACKAGE / inside).is_file():
        return [inside]
    source = _file(module)
    return [f"{source}:{name}" if source in _BY_FUNCTION else source]


def _file(module):
    """File of a module or of a package, from the package's folder."""
    path = PACKAGE.parent.joinpath(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return Path(os.path.relpath(path, PACKAGE)).as_posix()
