"""An edit reruns the jobs that run the edited module and what follows from them, no other, and no old compiled code."""

import contextlib
import functools

import pytest
from ledger import DONE
from watched import EDITS, modules_of
from work import BOTH, WORKS

pytestmark = pytest.mark.faults
# models that the scripts of rules run, but for those whose jobs name one
_MODELS = {"climb_samples": ("nscd-rigid",)}
GATHER = {"all", "diagnose"}  # rules without a script


@pytest.fixture(scope="module")
def copied(whole, tmp_path_factory):
    """Copies of the finished works, by name, whose sources may be edited."""
    return functools.cache(
        lambda work: whole(work).checkout.copied(tmp_path_factory.mktemp("edited") / "copy")
    )


@pytest.fixture(scope="module")
def jobs_of(copied):
    """All jobs of the works, by name."""
    return functools.cache(lambda work: with_scripts(copied(work).due(*WORKS[work], "--forceall")))


def with_scripts(jobs):
    """Jobs that run something."""
    return [job for job in jobs if job.rule not in GATHER]


@contextlib.contextmanager
def edited(checkout, **changes):
    """Sources changed for a while: by file, a function from its text to another."""
    before = {checkout.source(name): checkout.source(name).read_text() for name in changes}
    try:
        for name, change in changes.items():
            text = before[checkout.source(name)]
            assert change(text) != text
            checkout.source(name).write_text(change(text))
        yield
    finally:
        for path, text in before.items():
            path.write_text(text)


def with_constant(text):
    return text + "\nANSWER = 42\n"


def exchanged(old, new):
    """Change of a text that stands once."""

    def change(text):
        assert text.count(old) == 1
        return text.replace(old, new)

    return change


def runs_module(job, module):
    """Whether a job runs a module, by an account that knows nothing of the program's own."""
    models = _MODELS.get(
        job.rule, [job.wildcards[key] for key in ("model", "solver") if key in job.wildcards]
    )
    if job.rule == "compile_kernels":
        return module in modules_of(None, *models)
    return module in modules_of(job.rule, *models)


def named(jobs):
    """Rules and wildcards of jobs, without the digests in names."""
    kept = ("study", "model", "solver", "case", "batch", "motion", "campaign")
    return {(job.rule, *(job.wildcards.get(key, "") for key in kept)) for job in jobs}


@pytest.mark.parametrize(
    ("work", "module"),
    [
        pytest.param(work, module, marks=[pytest.mark.short_faults] * (work == "study"))
        for work in EDITS
        for module in EDITS[work]
    ],
)
def test_an_edit_reruns_what_runs_the_module_and_what_follows(work, module, copied, jobs_of):
    checkout = copied(work)
    with edited(checkout, **{module: with_constant}):
        due = with_scripts(checkout.due(*WORKS[work]))
    DONE[f"{work}: a constant of a module edited, the jobs due held against its users"] += 1
    own = [job for job in due if "Params have changed" in job.reason or "Missing output" in job.reason]
    follow = [job for job in due if "Input files updated by another job" in job.reason]
    wanted = named(job for job in jobs_of(work) if runs_module(job, module))
    assert wanted <= named(due), "less is run again than runs the module"
    assert named(own) <= wanted, "more is run again than runs the module"
    assert named(due) <= wanted | named(follow), "a job is run again that follows from nothing"


@pytest.mark.parametrize("work", BOTH)
def test_comments_and_explanations_rerun_nothing(work, copied):
    checkout = copied(work)
    modules = sorted(path.relative_to(checkout.source("")) for path in checkout.source("").rglob("*.py"))
    with edited(checkout, **{str(name): lambda text: text + "\n\n# a comment\n" for name in modules}):
        assert checkout.due(*WORKS[work]) == []
    DONE[f"{work}: a comment in every module"] += 1


def test_an_edit_of_an_effort_reruns_what_takes_the_number(copied):
    checkout = copied("diagnosis")
    more = exchanged("tests=0, draws=0, members=0, twins=0", "tests=1, draws=4, members=4, twins=1")
    with edited(checkout, **{"diagnosis/nominal/plan.py": more}):
        due = checkout.due(*WORKS["diagnosis"])
    DONE["diagnosis: numbers of an effort edited"] += 1
    own = [job for job in due if "Params have changed" in job.reason or "Missing output" in job.reason]
    simulated = {"simulate_nominal", "describe_misfit"}
    assert {job.rule for job in own} - {"compile_kernels"} == {*simulated, "conclude"}
    assert {job.rule for job in due} - {"compile_kernels"} == {
        *simulated, "conclude", "make_diagnosis_report", "diagnose"
    }  # fmt: skip


# in compiled kernels: half a kick of Newton's law, half a step's mean velocity
KERNELS = {
    "ls-dem": ("solvers/ls_dem/loop.py", exchanged("gained = 0.5 * dt", "gained = 0.51 * dt")),
    "nscd-rigid": ("solvers/nscd/step.py", exchanged("((1.0 - theta) * old", "((1.01 - theta) * old")),
}


@pytest.mark.parametrize("model", KERNELS)
def test_an_edit_of_a_kernel_runs_no_old_machine_code(model, whole, tmp_path):
    checkout = whole("study").checkout.copied(tmp_path / "copy")
    batches = {one: f"results/small/runs/{one}/configuration-1/000-004.nc" for one in KERNELS}
    paths = {one: checkout.folder / batches[one] for one in batches}
    before = {one: (path.read_bytes(), path.stat().st_mtime_ns) for one, path in paths.items()}
    source, change = KERNELS[model]
    with edited(checkout, **{source: change}):
        answer = checkout.snakemake(*batches.values())
        assert answer.returncode == 0, answer.stdout + answer.stderr
        for one, path in paths.items():
            assert (path.read_bytes() != before[one][0]) == (one == model)
            assert (path.stat().st_mtime_ns != before[one][1]) == (one == model)
    answer = checkout.snakemake(*batches.values())
    DONE[f"study: a constant of a kernel of {model} edited and put back, results compared"] += 1
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert all(path.read_bytes() == before[one][0] for one, path in paths.items())


def test_an_edit_of_the_decision_decides_anew(copied):
    checkout = copied("diagnosis")
    decision = checkout.folder / "results" / "diagnosis" / "small-campaign" / "decision.json"
    before = decision.read_bytes()
    with edited(checkout, **{"diagnosis/answer/size.py": exchanged("(0.05, 0.5, 0.95)", "(0.1, 0.5, 0.9)")}):
        answer = checkout.snakemake(*WORKS["diagnosis"])
        assert answer.returncode == 0, answer.stdout + answer.stderr
        assert decision.read_bytes() != before
    answer = checkout.snakemake(*WORKS["diagnosis"])
    DONE["diagnosis: a constant of the decision edited and put back, results compared"] += 1
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert decision.read_bytes() == before
