"""Which sources make which result: what a workflow rule watches, so that an edit reruns just what it touches.

Nothing is listed by hand: a script's sources are the files that it imports, directly or not.
"""

import ast
import functools

from blockshake.files import HOME, PACKAGE

_SCRIPTS = HOME / "workflow" / "scripts"
# These name things, write logs, or decide what is in the names of the files made: they compute nothing.
_COMPUTE_NOTHING = (
    "jit.py",
    "log.py",
    "quantities.py",
    "sources.py",
    "diagnosis/libraries/efforts.py",
    "diagnosis/libraries/plan.py",
    "diagnosis/libraries/repeated_readings.py",
)
# Of these only the functions that are taken count, each with its own imports.
_BY_FUNCTION = ("diagnosis/steps.py",)


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
        Files of the package, and functions of files as ``FILE:FUNCTION``, for `blockshake.files.source_digest`.
    """
    return _closure([_SCRIPTS / f"{script}.py", *_modules_of(models)])


def kernel_sources(*models):
    """Sources of what a model's driver runs."""
    return _closure(_modules_of(models))


def module_sources(module, *models):
    """Sources of what a module computes, given as its path in the package, with the models that it runs."""
    return _closure([PACKAGE / module, *_modules_of(models)])


@functools.cache
def compiled_sources():
    """All files that hold kernels, and what these import: the rest may change without compiling anew."""
    return _closure(
        path
        for path in PACKAGE.rglob("*.py")
        if "\nfrom blockshake.jit import" in path.read_text(encoding="utf-8")
    )


def _modules_of(models):
    from blockshake.simulation.models import model_of

    return [_file(module) for model in models for module in model_of(model).modules]


def _closure(paths):
    """Names of the files that these import, directly or not, and of these themselves, sorted."""
    found, left = set(), [(path, None) for path in paths]
    while left:
        path, function = left.pop()
        name = path.relative_to(PACKAGE).as_posix() if path.is_relative_to(PACKAGE) else None
        mark = f"{name}:{function}" if name in _BY_FUNCTION else name
        if mark in found or name in _COMPUTE_NOTHING:
            continue
        if name is not None and path.name != "__init__.py":
            found.add(mark)
        left += _imported(path, function if name in _BY_FUNCTION else None)
    return tuple(sorted(found))


@functools.cache
def _imported(path, function):
    """Files that a file imports, or its top and one of its functions, with the name that is taken of each."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    if function is None:
        nodes = list(ast.walk(tree))
    else:
        defined = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
        nodes = [node for node in tree.body if node not in defined]
        nodes += [node for one in defined if one.name == function for node in ast.walk(one)]
    found = []
    for node in nodes:
        if not isinstance(node, ast.ImportFrom) or not (node.module or "").startswith("blockshake"):
            continue
        for alias in node.names:
            inside = _file(f"{node.module}.{alias.name}")
            found.append((inside, None) if inside.is_file() else (_file(node.module), alias.name))
    return found


def _file(module):
    """File of a module or of a package."""
    path = PACKAGE.joinpath(*module.split(".")[1:])
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
