"""Every rule watches all the sources that its script runs, and no more: else an edit reruns nothing, or too much."""

import subprocess
import sys

import pytest

from blockshake import sources
from blockshake.files import PACKAGE
from blockshake.simulation.models import MODELS
from blockshake.sources import compiled_sources, kernel_sources, module_sources, script_sources, source_digest

SCRIPTS = sorted(path.stem for path in (PACKAGE.parents[1] / "workflow" / "scripts").glob("*.py"))
RULES = ("diagnosed", "diagnosis")
JUDGING = ("pages/", "views/", "study/report/", "diagnosis/report/", "diagnosis/evidence/",
           "diagnosis/gain/", "diagnosis/verdict/")  # fmt: skip
SHOWING = ("section.py", "figure.py")
FOLDERS = {"ls-dem": "solvers/ls_dem/", "nscd-rigid": "solvers/nscd/"}


def files(listed):
    return {one.partition(":")[0] for one in listed}


@pytest.mark.parametrize("script", SCRIPTS)
def test_every_watched_source_exists_and_can_be_digested(script):
    listed = script_sources(script)
    assert listed
    assert all((PACKAGE / one).is_file() for one in files(listed))
    assert source_digest(*listed)


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_unpacks_calls_and_writes(script):
    text = (PACKAGE.parents[1] / "workflow" / "scripts" / f"{script}.py").read_text()
    assert len(text.splitlines()) <= 12


@pytest.mark.parametrize("model", MODELS)
def test_a_run_watches_all_that_python_imports_for_it(model):
    """Held against what an interpreter of its own loads, but for what computes nothing."""
    command = (
        "import sys; from blockshake.simulation.models import model_of; import blockshake.simulation.simulate;"
        f"model_of('{model}').schema; model_of('{model}').solve.__self__.modules;"
        f"import importlib; [importlib.import_module(one) for one in model_of('{model}').modules];"
        "print(*[one.__file__ for name, one in sys.modules.items() if name.startswith('blockshake')])"
    )
    printed = subprocess.run(
        [sys.executable, "-c", command], capture_output=True, text=True, check=True
    ).stdout
    loaded = {path.partition("/blockshake/")[2] for path in printed.split()}
    loaded = {name for name in loaded if not name.endswith("__init__.py")}
    unwatched = {"caches.py", "log.py", "quantities.py", "sources.py"}
    assert loaded - unwatched == files(module_sources("simulation/simulate.py", model)) - unwatched


@pytest.mark.parametrize(("model", "other"), [("ls-dem", "nscd-rigid"), ("nscd-rigid", "ls-dem")])
def test_a_batch_watches_its_own_solver_and_not_the_other(model, other):
    listed = script_sources("simulate_batch", model)
    assert any(one.startswith(FOLDERS[model]) for one in listed)
    assert not any(one.startswith(FOLDERS[other]) for one in listed)


@pytest.mark.parametrize("model", MODELS)
def test_kernels_of_a_model_are_among_the_sources_of_its_batches(model):
    assert set(kernel_sources(model)) <= set(script_sources("simulate_batch", model))


def test_numbas_options_are_watched_by_what_they_compile():
    """Other options are other machine code: the compiled kernels and all that they computed are then old."""
    assert "jit.py" in compiled_sources()
    for model in MODELS:
        assert "jit.py" in kernel_sources(model)
        assert "jit.py" in script_sources("simulate_batch", model)


def test_what_judges_is_no_source_of_what_is_simulated():
    for script in ("simulate_batch", "simulate_nominal"):
        listed = files(script_sources(script))
        assert not any(one.startswith(JUDGING) or one.endswith(SHOWING) for one in listed)


def test_an_ensemble_watches_its_draws_and_one_step():
    listed = script_sources("simulate_nominal")
    assert "diagnosis/nominal/nominal_model.py" in listed
    assert [one for one in listed if "steps.py" in one] == ["diagnosis/steps.py:simulate_nominal"]


@pytest.mark.parametrize(("model", "other"), [("ls-dem", "nscd-rigid"), ("nscd-rigid", "ls-dem")])
def test_an_ensemble_of_one_solver_does_not_watch_the_driver_of_the_other(model, other):
    own, unwatched = (kernel_sources(one) for one in (model, other))
    listed = script_sources("simulate_nominal", model)
    assert set(own) <= set(listed)
    assert not {one for one in unwatched if one.endswith("driver.py")} & set(listed)
    rules = [(PACKAGE.parents[1] / "workflow" / "rules" / f"{name}.smk").read_text() for name in RULES]
    assert 'source_of("simulate_nominal", wildcards.solver)' in rules[0]
    assert rules[1].count("source=solver_source") == 2


@pytest.fixture
def package(tmp_path, monkeypatch):
    monkeypatch.setattr(sources, "PACKAGE", tmp_path)
    monkeypatch.setattr(sources, "_KEPT", tmp_path / "kept")
    (tmp_path / "part").mkdir()
    (tmp_path / "part" / "a.py").write_text(
        '"""Doc."""\n\n\ndef f(x):\n    """Add one."""\n    return x + 1\n\n\ndef g():\n    return 2\n'
    )
    _forget()
    yield tmp_path
    _forget()


def _forget():
    """Forget the digests of sources: these change while a test runs, as they never do under a program."""
    source_digest.cache_clear()
    sources._read.cache_clear()
    sources._imported.cache_clear()


def _digests():
    _forget()
    return source_digest("part/a.py"), source_digest("part/a.py:f"), source_digest("part/a.py:g")


def test_the_source_digest_ignores_explanations(package):
    before = _digests()
    (package / "part" / "a.py").write_text(
        '"""Other."""\n# why\ndef f( x ):\n    """Add\n    1."""\n\n    return x+1  # one\n'
        'def g():\n    "Two."\n    return 2\n'
    )
    assert _digests() == before


def test_the_source_digest_follows_the_code_that_is_named(package):
    whole, f, g = _digests()
    text = (package / "part" / "a.py").read_text()
    (package / "part" / "a.py").write_text(text.replace("x + 1", "x + 2"))
    new_whole, new_f, new_g = _digests()
    assert new_whole != whole
    assert new_f != f
    assert new_g == g
    (package / "part" / "a.py").rename(package / "part" / "c.py")
    assert source_digest("part/c.py") != new_whole  # a moved module is another program


def test_what_a_text_came_to_is_kept_and_a_damaged_file_is_made_anew(package):
    before = _digests()
    kept = sorted((package / "kept").glob("*.json"))
    assert len(kept) == 3  # the file, and each of its functions
    for damage in (lambda path: path.write_bytes(path.read_bytes()[:-9]), lambda path: path.write_text("3"),
                   lambda path: path.write_text(path.read_text().replace("a", "b"))):  # fmt: skip
        for path in kept:
            damage(path)
        assert _digests() == before
    contents = [path.read_bytes() for path in kept]
    (package / "part" / "a.py").write_text((package / "part" / "a.py").read_text().replace("x + 1", "x + 2"))
    assert _digests()[1] != before[1]
    assert [path.read_bytes() for path in kept] == contents
