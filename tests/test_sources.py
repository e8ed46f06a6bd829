"""Sources of rules, and their digests; workflow/test_watched.py holds the lists against the imports of every script."""

import pytest

from blockshake import sources
from blockshake.files import PACKAGE
from blockshake.simulation.models import MODELS
from blockshake.sources import compiled_sources, kernel_sources, script_sources, source_digest

SCRIPTS = sorted(path.stem for path in (PACKAGE.parents[1] / "workflow" / "scripts").glob("*.py"))
RULES = ("diagnosed", "diagnosis")
JUDGING = ("pages/", "views/", "study/report/", "diagnosis/report/", "diagnosis/evidence/",
           "diagnosis/gain/", "diagnosis/verdict/")  # fmt: skip
SHOWING = ("section.py", "figure.py")


def files(listed):
    return {one.partition(":")[0] for one in listed}


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_script_unpacks_calls_and_writes(script):
    text = (PACKAGE.parents[1] / "workflow" / "scripts" / f"{script}.py").read_text()
    assert len(text.splitlines()) <= 13


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


def test_an_ensemble_watches_one_step_and_its_own_solver():
    listed = script_sources("simulate_nominal")
    assert [one for one in listed if "steps.py" in one] == ["diagnosis/steps.py:simulate_nominal"]
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
