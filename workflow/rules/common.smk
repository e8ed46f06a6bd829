"""Shared by the rules: the checked configuration, ids for paths, digests of sources."""

import os
import sys
from pathlib import Path

# scripts find the package around the workflow, a checkout's or an installed one, in any environment
ABOVE = Path(workflow.basedir, "src")
ABOVE = ABOVE if ABOVE.is_dir() else Path(workflow.basedir).parents[1]
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
from blockshake.simulation.models import MODELS as SOLVERS
from blockshake.sources import kernel_sources, script_sources, source_digest
from blockshake.study.config import StudyConfig, check_config, shows_stiffness
from blockshake.validation import validated
from blockshake.working_folder import (
    end_with_command,
    end_with_folder,
    hold,
    start_jobs,
)

# of a diagnosis, on the command line: they take the place of the study's own
GIVEN = ("campaign", "campaigns", "effort", "without")


def refuse(error):
    """End with one line on bad input and exit 2."""
    print(f"blockshake: {error}", file=sys.stderr, flush=True)
    os._exit(BAD_INPUT)


def hold_folder():
    """Keep other commands out of the current folder until this one ends, and have its jobs end with it.

    It ends itself with the command that started it, such as `blockshake diagnose`.
    """
    try:
        hold(Path.cwd())
    except InputError as error:
        refuse(error)
    end_with_command()
    start_jobs()


def study_config():
    """The configuration checked, with the defaults of its schema; what it names is checked once, not in every job."""
    study = {key: value for key, value in config.items() if key not in GIVEN}
    where = " + ".join(map(str, workflow.configfiles))
    try:
        if workflow.exec_mode == workflow.exec_mode.DEFAULT:
            return check_config(study, where)
        return validated(StudyConfig, study, where)
    except InputError as error:
        refuse(error)


def configuration():
    """The configuration as the program reads YAML, which is not how Snakemake does: octal numbers, keys twice."""
    given, read = workflow.config_settings, {}
    own = [path for path in workflow.configfiles if path not in given.configfiles]
    try:
        for path in (*own, *given.configfiles):
            update_config(read, load_yaml(path))
    except InputError as error:
        refuse(error)
    update_config(read, with_numbers(dict(given.config)))
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
    return beside(path) if path.exists() else name


def beside(path):
    """Path of a file that ships with the program: from the current folder where it lies in it."""
    path = Path(path)
    return str(path.relative_to(Path.cwd()) if Path.cwd() in path.parents else path)


def campaign_files(case):
    """The test that a case is compared with and what describes it; never another, which may be sealed."""
    campaign = load_campaign(CASES[case]["measured"]["campaign"])
    return files_of_test(campaign, campaign.tests[CASES[case]["measured"]["test"]])


def open_files(case):
    """The tests of a case's campaign that are not sealed, and what describes them."""
    campaign = load_campaign(CASES[case]["measured"]["campaign"])
    opened = [test for test in campaign.tests.values() if test.role != "sealed"]
    files = [file for test in opened for file in files_of_test(campaign, test)]
    return list(dict.fromkeys(files))


def files_of_test(campaign, test):
    """The file of a campaign, that of one of its tests, and others that describe the test, as far as they are there."""
    files = [campaign.folder / "campaign.yaml", campaign.folder / test.file]
    beside = [
        campaign.folder / f"{Path(test.file).stem}-acc.csv",
        campaign.folder / test.motion,
        Path(campaign.structure),
    ]
    return [str(path) for path in (*files, *filter(Path.is_file, beside))]


def batches(model, case):
    """Ids of the batches of a case."""
    return batch_ids(CHECKED.samples(model, case))


def batch_ids(count):
    """Ids of the batches of so many samples: first and last sample."""
    size = config["samples_per_job"]
    return [
        f"{first:03d}-{min(first + size, count) - 1:03d}"
        for first in range(0, count, size)
    ]


def batch_files(wildcards, model=None):
    """Batch files of a case by a model, of the wildcards if none is named."""
    model = model or wildcards.model
    return expand(
        "results/{study}/runs/{model}/{case}/{batch}.nc",
        study=wildcards.study,
        model=model,
        case=wildcards.case,
        batch=batches(model, wildcards.case),
    )


def files_of_models(wildcards):
    """Batch files of a case by every model, and their twins, each under a name of its own for the rule's input."""
    twins = "results/{study}/twins/{model}/{case}.nc"
    named = {f"batches {model}": batch_files(wildcards, model) for model in MODELS}
    named |= {
        f"twins {model}": twins.format(
            study=wildcards.study, model=model, case=wildcards.case
        )
        for model in MODELS
        if CHECKED.has_twins(model, wildcards.case)
    }
    return named


def files_of_report(cases):
    """Files that a report of these cases is made of, by name."""
    measured = [case for case in cases if case in MEASURED]
    stiff = cases if shows_stiffness(config) else []
    motions = {Path(CASES[case]["motion"]).stem for case in cases}

    def results(pattern, **named):
        return expand(f"results/{STUDY}/{pattern}", **named)

    def by_model(kind, named):
        return results(f"{kind}/{{model}}/{{case}}.nc", model=MODELS, case=named)

    return {
        "structures": [
            definition("structures", CASES[case]["structure"]) for case in cases
        ],
        "campaigns": [file for case in measured for file in campaign_files(case)],
        "templates": TEMPLATES,
        "motions": results("motions/{motion}.nc", motion=sorted(motions)),
        "design": results("design.{suffix}", suffix=["csv", "json"]),
        "stiffness": results("stiffness/{case}.csv", case=stiff),
        "waves": results("waves/{case}.nc", case=stiff),
        "bases": results("inputs/{case}.nc", case=measured),
        "definitions": (
            results("stiffness-definitions.nc") if next(iter(CASES)) in stiff else []
        ),
        "envelopes": by_model("envelopes", cases),
        "samples": by_model("samples", cases),
        "shown": by_model("shown", cases),
        "comparisons": by_model("comparisons", measured),
        "differences": results("differences/{case}.nc", case=cases),
        "calibration": (
            results("calibration.json") if CALIBRATION and cases == list(CASES) else []
        ),
        "fragility": results(
            "fragility/{case}.nc",
            case=[case for case in FRAGILITY.get("cases", []) if case in cases],
        ),
        "sensitivities": by_model("sensitivities", cases),
    }


def source_of(script, *models):
    """Digest of all that a script imports, and of the solvers of the models that it runs."""
    return source_digest(*script_sources(script, *models))


def kernels(model):
    """Mark that a model's kernels are compiled.

    Its name holds their digest, so that it goes out of date just when the model's runs do. Snakemake's `ancient`
    would not do: with it a study whose compilation is due runs that and nothing else (issue 4166).
    """
    return f"results/kernels/{model}-{source_digest(*kernel_sources(model))}.json"


def campaign_kernels(wildcards):
    """Mark that the kernels of the virtual campaign's model are compiled."""
    from blockshake.virtual.settings import load_settings

    return kernels(load_settings(HOME / "config" / "virtual-campaign.yaml").model)


def stiffness_file(wildcards):
    """Calibrated stiffness of the samples, for the models that have any: an edit of LS-DEM reruns no NSCD."""
    return stiffness_of(wildcards.model, wildcards.study, wildcards.case)


def stiffness_of(model, study, case):
    """The same of a model, a study and a case by their names."""
    return f"results/{study}/stiffness/{case}.csv" if SOLVERS[model].calibrated else []


def base_file(wildcards):
    """The slab's measured motion, for the cases that it drives."""
    if CASES[wildcards.case]["input"] == "commanded":
        return []
    return f"results/{wildcards.study}/inputs/{wildcards.case}.nc"


def time_step_of(model):
    """Time step of a model [s]: the study's, or the model's own where it is not in the study."""
    return config["models"].get(model, {}).get("time_step", SOLVERS[model].time_step)


def case_definition(wildcards):
    """Keys of a case in the configuration that its runs depend on."""
    return {
        key: CASES[wildcards.case][key]
        for key in ("structure", "motion", "scale", "baseline", "duration", "input")
    }


FAILURES = Failures()


onstart:
    hold_folder()
    # the user may ask to go on, and a cluster may start killed jobs again
    asked = workflow.execution_settings
    FAILURES.watch(logger, asked.keep_going, asked.retries)


onerror:
    FAILURES.end()


if workflow.remote_exec:
    end_with_folder(Path.cwd())


config.update(configuration())
CHECKED = study_config()
config.update(CHECKED.model_dump(mode="json"))

# models that the null hypothesis of a diagnosis holds
NULL_MODELS = [name for name, model in SOLVERS.items() if model.perturbation]
TEMPLATES = expand(
    beside(PACKAGE / "report" / "document" / "templates" / "{name}"),
    name=["report.html.j2", "report.css", "report.js", "moving.js", "report.typ"],
)
STUDY = config["name"]
MODELS = list(config["models"])
CASES = {case["name"]: case for case in config["cases"]}
MEASURED = [name for name, case in CASES.items() if case["measured"]]
CALIBRATION = config.get("calibration") or {}
FRAGILITY = config.get("fragility") or {}
BASELINES = {motion: baseline for _, motion, baseline in CHECKED.named_motions()}
LADDER_MOTIONS = config["ladder"]["motions"] or list(
    dict.fromkeys(case["motion"] for case in config["cases"])
)
MOTIONS = {Path(motion).stem: motion for motion in BASELINES}


wildcard_constraints:
    study="|".join([STUDY]),
    model="|".join(SOLVERS),
    case="|".join(CASES),
    motion="|".join(MOTIONS),
    batch=r"\d\d\d+-\d\d\d+",
    digest="[0-9a-f]{12}",
