"""Which modules each rule runs, by the bytecode of their imports: an account that knows nothing of `sources.py`."""

import functools
import os
from modulefinder import ModuleFinder
from types import CodeType

from blockshake.files import PACKAGE
from blockshake.measurement.campaigns.kinds import KINDS, Late
from blockshake.simulation.models import MODELS

SCRIPTS = PACKAGE.parents[1] / "workflow" / "scripts"
# their numbers are in parameters of rules, see `effort` in workflow/rules/diagnosed.smk
PLANS = {"diagnosis/nominal/plan.py"}
BESIDE = {
    "measurement/campaigns/kinds.py",
    "caches.py",
    "log.py",
    "sources.py",
}  # what these compute is in no result
# modules that the tests of faults edit, by the work whose jobs are then due
EDITS = {
    "study": (
        "solvers/ls_dem/driver.py", "solvers/nscd/driver.py", "study/ensembles/envelope.py",
        "study/stiffness/wave_speed.py", "study/sampling/distributions.py", "dynamics/intensity.py",
        "study/report/report.py", "errors.py",
    ),
    "diagnosis": (
        "solvers/ls_dem/driver.py", "diagnosis/evidence/likelihood.py", "diagnosis/answer/decide.py",
        "diagnosis/misfit/judged_test.py", "diagnosis/verdict/grade.py", "parity/marker_faults.py",
        "diagnosis/report/odds_section.py",
    ),
}  # fmt: skip
STEPS = "diagnosis/steps.py"  # a rule runs one function of it


@functools.cache
def modules_of(script, *models):
    """Files of the package that a rule's script runs, with the drivers of models; a step as ``FILE:FUNCTION``.

    Without a script, those of the drivers alone, which are compiled.
    """
    found = set()
    left = [_file(module) for model in models for module in MODELS[model].modules]
    left += [_place(*one) for one in _imports(SCRIPTS / f"{script}.py")] if script else []
    while left:
        name = left.pop()
        if name and name not in found | PLANS | BESIDE:
            found.add(name)
            file, _, function = name.partition(":")
            left += [_place(*one) for one in _imports(PACKAGE / file, function)]
    return {name for name in found if not name.endswith("__init__.py")}


@functools.cache
def _imports(path, function=""):
    """Modules and names that a file imports at any depth, or at its top and in one of its functions."""
    found, left = set(), [compile(path.read_text(), path, "exec")]
    while left:
        code = left.pop()
        for what, taken in ModuleFinder().scan_opcodes(code):
            if what == "absolute_import":
                found |= {(taken[1], name) for name in taken[0] or ("",)}
        if "kind" in code.co_names:  # of a campaign, with a column of its row
            named = [getattr(kind, name, None) for kind in KINDS for name in code.co_names]
            found |= {tuple(one) for one in named if isinstance(one, Late)}
        inner = [one for one in code.co_consts if isinstance(one, CodeType)]
        left += [
            one for one in inner if not function or code.co_name != "<module>" or one.co_name == function
        ]
    return found


def _place(module, name):
    """File that an imported name comes from, None for another package's."""
    if not module.startswith("blockshake"):
        return None
    file = _file(f"{module}.{name}") or _file(module)
    return f"{file}:{name}" if file == STEPS else file


def _file(module):
    """File of a module or a package, None where there is none."""
    path = PACKAGE.parent.joinpath(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return os.path.relpath(path, PACKAGE) if path.is_file() else None
