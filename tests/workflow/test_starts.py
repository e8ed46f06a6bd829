"""A job starts fast: what is slow to import is loaded where it is called, or drawn with."""

import ast
import inspect

import pytest
from snakemake.scheduling.job_scheduler import JobScheduler
from watched import SCRIPTS, modules_of

from blockshake.files import PACKAGE

# CPU seconds of an import: 0.5 of scipy.signal, which brings scipy.stats; 0.5 of scipy.optimize; 0.5 of matplotlib
SLOW = ("scipy.optimize", "scipy.signal", "scipy.stats", "openpyxl", "sklearn")
DRAWING = ("matplotlib", "PIL", "jinja2", "typst")
REPORTS = ("make_report", "make_case_report", "make_diagnosis_report", "write_so_far")


def imported_at_the_top(file):
    """Modules, and names of modules, that a file of the package imports before anything is called."""
    names = set()
    for node in ast.parse((PACKAGE / file).read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        if isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
    return names


@pytest.mark.parametrize("script", sorted(path.stem for path in SCRIPTS.glob("*.py")))
def test_no_rule_imports_what_it_may_not_call(script):
    slow = SLOW if script in REPORTS else SLOW + DRAWING
    files = {name.partition(":")[0] for name in modules_of(script)} - {"diagnosis/steps.py"}
    found = {
        (file, name)
        for file in files
        for name in imported_at_the_top(file)
        if any(f"{name}.".startswith(f"{one}.") for one in slow)
    }
    assert not found


def test_the_package_itself_imports_no_library():
    standard = {"importlib", "re", "pathlib.Path"}
    assert imported_at_the_top("__init__.py") == {*standard, "blockshake.caches.set_cache_home"}
    assert imported_at_the_top("caches.py") <= {"logging", "os", "tempfile", "pathlib.Path"}


def test_the_rate_of_jobs_that_the_workflow_takes_away_is_where_it_looks():
    assert "self.job_rate_limiter = " in inspect.getsource(JobScheduler.__init__)
    assert "if self.job_rate_limiter is not None:" in inspect.getsource(JobScheduler.schedule)
