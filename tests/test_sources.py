"""Every rule watches all the sources that its script runs: else an edit would rerun nothing."""

import ast
from pathlib import Path

import pytest

from blockshake import sources
from blockshake.files import PACKAGE

ROOT = PACKAGE.parents[1]
WATCHED = {
    "describe_motion": sources.MOTION,
    "draw_samples": sources.DESIGN,
    "calibrate_friction": sources.friction_sources("nscd-rigid"),
    "calibrate_stiffness": sources.STIFFNESS,
    "make_envelope": sources.ENVELOPE,
    "compare_with_measurement": sources.COMPARISON,
    "measure_sensitivity": sources.SENSITIVITY,
    "compare_definitions": sources.DEFINITIONS,
    "make_report": sources.REPORT,
    "climb_ladder": sources.LADDER,
    "study_convergence": sources.CONVERGENCE,
    "make_virtual_campaign": sources.VIRTUAL_CAMPAIGN,
    "simulate_library": sources.LIBRARY,
    "simulate_cause": sources.LIBRARY,
    "calibrate_decision": sources.CALIBRATION,
    "read_measured": sources.DIAGNOSIS,
    "decide": sources.DIAGNOSIS,
    "size_cause": sources.DIAGNOSIS,
    "extend_model": sources.DIAGNOSIS,
    "measure_gain": sources.DIAGNOSIS,
    "conclude": sources.DIAGNOSIS,
    "predict_twins": sources.DIAGNOSIS,
    "make_diagnosis_report": (*sources.REPORT, *sources.DIAGNOSIS),
}
# What names things or writes logs and computes nothing; and the dispatcher that imports every solver, where a run's
# own rule watches the one that runs.
IGNORED = {
    # what these decide is in the names of the files that are made
    "diagnosis/plan.py",
    "diagnosis/repeated_readings.py",
    "__init__.py",
    "log.py",
    "sources.py",
    "jit.py",
    "quantities.py",
    "study/simulation.py",
    "study/batch.py",
}


def imported_modules(path, seen=None):
    """Files of the package that a file imports, directly or not."""
    seen = set() if seen is None else seen
    for node in ast.walk(ast.parse(Path(path).read_text())):
        if not isinstance(node, (ast.Import, ast.ImportFrom)):
            continue
        names = [node.module] if isinstance(node, ast.ImportFrom) else [alias.name for alias in node.names]
        if isinstance(node, ast.ImportFrom):
            names += [f"{node.module}.{alias.name}" for alias in node.names]
        for name in names:
            if not name or not name.startswith("blockshake"):
                continue
            module = PACKAGE.joinpath(*name.split(".")[1:])
            for file in (module.with_suffix(".py"), module / "__init__.py"):
                if file.is_file() and file not in seen:
                    seen.add(file)
                    imported_modules(file, seen)
    return seen


def watched(file, listed):
    relative = file.relative_to(PACKAGE)
    return (
        relative.name in IGNORED
        or str(relative) in IGNORED
        or any(relative == Path(one) or Path(one) in relative.parents for one in listed)
    )


@pytest.mark.parametrize("script", sorted(WATCHED))
def test_rule_watches_what_its_script_imports(script):
    missed = [
        str(file.relative_to(PACKAGE))
        for file in imported_modules(ROOT / "workflow" / "scripts" / f"{script}.py")
        if not watched(file, WATCHED[script])
    ]
    assert missed == []


@pytest.mark.parametrize("model", ["ls-dem", "nscd-rigid"])
def test_batch_watches_its_own_solver_and_not_the_other(model):
    listed = sources.batch_sources(model)
    own, other = (
        ("solvers/ls_dem", "solvers/nscd") if model == "ls-dem" else ("solvers/nscd", "solvers/ls_dem")
    )
    assert own in listed
    assert other not in listed
    missed = [
        str(file.relative_to(PACKAGE))
        for file in imported_modules(ROOT / "workflow" / "scripts" / "simulate_batch.py")
        if not watched(file, listed) and other not in str(file)
    ]
    assert missed == []


@pytest.mark.parametrize("model", ["ls-dem", "nscd-rigid"])
def test_kernels_marked_as_compiled_are_those_a_run_watches(model):
    assert set(sources.kernel_sources(model)) <= set(sources.run_sources(model))
    assert set(sources.kernel_sources("ls-dem")) <= set(sources.STIFFNESS)


def test_every_script_is_listed():
    scripts = {path.stem for path in (ROOT / "workflow" / "scripts").glob("*.py")}
    assert scripts == {*WATCHED, "simulate_batch", "compile_kernels"}


def test_every_listed_source_exists():
    for listed in (*WATCHED.values(), sources.batch_sources("ls-dem"), sources.batch_sources("nscd-rigid")):
        for one in listed:
            assert (PACKAGE / one).exists(), one


def test_every_module_with_kernels_is_in_the_cache_digest():
    for path in PACKAGE.rglob("*.py"):
        if "from blockshake.jit import" in path.read_text() and path.name != "compile.py":
            assert watched(path, sources.KERNELS), path
