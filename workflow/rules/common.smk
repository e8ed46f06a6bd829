"""Shared by the rules: the checked configuration, ids for paths, digests of sources."""

import contextlib
import os
import sys
from pathlib import Path

# scripts find the package around the workflow, a checkout's or an installed one, in any environment
ROOT = Path(workflow.basedir.removesuffix("workflow"))
ABOVE = ROOT / "src" if (ROOT / "src").is_dir() else ROOT.parents[1]
sys.path.insert(0, str(ABOVE))
# one thread a job, BLAS included
os.environ.update(
    PYTHONPATH=str(ABOVE),
    OMP_NUM_THREADS="1",
    OPENBLAS_NUM_THREADS="1",
    MKL_NUM_THREADS="1",
    NUMEXPR_NUM_THREADS="1",
)

from snakemake.logging import logger
from snakemake.utils import update_config

from blockshake.errors import BAD_INPUT, InputError
from blockshake.files import HOME, PACKAGE, load_yaml, parse_yaml, shipped
from blockshake.log import Failures
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.simulation.models import MODELS as SOLVERS, solver_of
from blockshake.sources import script_sources, source_digest
from blockshake.study.analyses import ANALYSES
from blockshake.study.config import StudyConfig, check_config
from blockshake.study.growth import reached
from blockshake.validation import validated
from blockshake.working_folder import (
    end_with_command,
    end_with_folder,
    hold,
    start_jobs,
)

# of a diagnosis, on the command line: they take the place of the study's own
GIVEN = ("campaign", "campaigns", "effort", "without")


@contextlib.contextmanager
def refusing():
    """End with one line on bad input and exit 2."""
    try:
        yield
    except InputError as error:
        print(f"blockshake: {error}", file=sys.stderr, flush=True)
        os._exit(BAD_INPUT)


def hold_folder():
    """Keep other commands out of the current folder until this one ends, and have its jobs end with it.

    It ends itself with the command that started it, such as `blockshake diagnose`.
    """
    with refusing():
        hold(Path.cwd())
    end_with_command()
    start_jobs()


def study_config():
    """The configuration checked, with the defaults of its schema; what it names is checked once, not in every job."""
    study = {key: value for key, value in config.items() if key not in GIVEN}
    where = " + ".join(map(str, workflow.configfiles))
    with refusing():
        if workflow.exec_mode == workflow.exec_mode.DEFAULT:
            return check_config(study, where)
        return validated(StudyConfig, study, where)


def configuration():
    """The configuration as the program reads YAML, which is not how Snakemake does: octal numbers, keys twice."""
    settings, read = workflow.config_settings, {}
    own = [path for path in workflow.configfiles if path not in settings.configfiles]
    with refusing():
        for path in (*own, *settings.configfiles):
            update_config(read, load_yaml(path))
    update_config(read, with_numbers(dict(settings.config)))
    return read


def with_numbers(value):
    """A value of `--config` with the numbers in its lists and mappings, which Snakemake leaves as texts."""
    if isinstance(value, dict):
        return {key: with_numbers(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [with_numbers(entry) for entry in value]
    try:
        number = parse_yaml(value, "--config") if isinstance(value, str) else None
    except InputError:
        return value
    return number if isinstance(number, (int, float)) else value


def definition(kind, name):
    """Path of a structure or motion: a shipped one by its name, else the file named."""
    path = shipped(kind, name)
    return by_content(beside(path) if path.exists() else name)


def beside(path):
    """Path of a file that ships with the program: from the current folder where it lies in it."""
    path = Path(path)
    return str(path.relative_to(Path.cwd()) if Path.cwd() in path.parents else path)


def source_of(script, *models):
    """Digest of all that a script imports, and of the solvers of the models that it runs."""
    return source_digest(*script_sources(script, *models))


FAILURES = Failures()


onstart:
    refuse_future()
    hold_folder()
    # the user may ask to go on, and a cluster may start killed jobs again
    settings = workflow.execution_settings
    # on this machine jobs start at any rate: for a limit Snakemake looks at all that are ready again every second
    if workflow.local_exec:
        workflow.scheduler.job_rate_limiter = None
    FAILURES.watch(logger, settings.keep_going, settings.retries)


onerror:
    FAILURES.end()


if workflow.remote_exec:
    end_with_folder(Path.cwd())


config.update(configuration())
CHECKED = reached(study_config(), "results")
config.update(CHECKED.model_dump(mode="json"))

TEMPLATES = sorted(
    map(beside, {*PACKAGE.rglob("*.j2"), *PACKAGE.glob("pages/templates/*")})
)
STUDY = config["name"]
MODELS = list(config["models"])
CASES = {case["name"]: case for case in config["cases"]}
MEASURED = [name for name, case in CASES.items() if case["measured"]]
BASELINES = {motion: baseline for _, motion, baseline in CHECKED.named_motions()}
MOTIONS = {Path(motion).stem: motion for motion in BASELINES}


wildcard_constraints:
    study="|".join([STUDY]),
    model="|".join({**SOLVERS, **config["models"]}),
    case="|".join(CASES),
    motion="|".join(MOTIONS),
    digest="[0-9a-f]{12}",
