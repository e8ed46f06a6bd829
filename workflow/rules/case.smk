"""Files that go from rule to rule, and the entries of a case's configuration that its runs depend on."""

from functools import cache

from blockshake.dynamics.record_set import record_files
from blockshake.files import check_past, content_digest
from blockshake.geometry.structure import load_structure
from blockshake.sources import kernel_sources
from blockshake.study.ensembles.batch import HALF_STEP, batch_values
from blockshake.study.sampling.latin_hypercube import drawn_design


wildcard_constraints:
    batch=rf"\d\d\d+-\d\d\d+|{HALF_STEP}",


def for_first_picture(wildcards):
    """Priority of a job: 1 where the first case by the first model needs it."""
    case, model = wildcards.get("case"), wildcards.get("model")
    return int(
        case in (None, next(iter(CASES)))
        and (model is None or solver_of(model) is solver_of(MODELS[0]))
    )


def by_content(path):
    """Path of a file, one in YAML `ancient`: its contents, and not its time, make a rule with `yaml_contents` run again."""
    return ancient(path) if path.endswith((".yaml", ".yml")) else path


def yaml_contents(*inputs):
    """Parameter that goes with such inputs of a rule: digests of the files in YAML, in which a comment counts nothing.

    Snakemake does not notice a change of a parameter that is a function of `input` itself.
    """
    return lambda wildcards: [
        _yaml_digest(path)
        for one in inputs
        for path in _paths(one(wildcards) if callable(one) else one)
        if path.endswith((".yaml", ".yml"))
    ]


def _paths(named):
    """Paths in lists and in values of mappings."""
    if isinstance(named, str):
        return [named]
    inside = named.values() if isinstance(named, dict) else named
    return [path for one in inside for path in _paths(one)]


@cache
def _yaml_digest(path):
    with refusing():
        return content_digest(load_yaml(path))


def refuse_future():
    """End where an input has a time ahead of the clock: Snakemake refuses every result that is older than its inputs."""
    with refusing():
        for path in {str(path) for job in workflow.dag.jobs for path in job.input}:
            if os.path.exists(path):
                check_past(path)


@cache
def campaign_files(case, every=False):
    """The test that a case is compared with, or every one that is not sealed, and what describes it."""
    measured = CASES[case]["measured"]
    campaign = load_campaign(measured["campaign"])
    tests = campaign.open.values() if every else [campaign.open[measured["test"]]]
    return [by_content(path) for path in files_of_tests(campaign, tests)]


def measured_files(wildcards):
    """The same of the case of a rule, without any where it is compared with none."""
    case = wildcards.case
    return campaign_files(case) if CASES[case]["measured"] else []


def open_files(wildcards):
    """Those of every test of a case that is not sealed."""
    return campaign_files(wildcards.case, every=True)


def files_of_tests(campaign, tests):
    """The file of a campaign, those of some of its tests, and others that describe them, as far as they are there."""
    files = [campaign.folder / "campaign.yaml", Path(campaign.structure)]
    files += [campaign.table] if campaign.table else []
    for test in tests:
        files += [campaign.folder / test.motion] if test.motion else []
        if test.file:
            path = campaign.folder / test.file
            files += [path, path.with_name(f"{path.stem}-acc.csv")]
    return [str(path) for path in dict.fromkeys(files) if path.is_file()]


def structure_file(wildcards):
    """Structure of a case."""
    return definition("structures", CASES[wildcards.case]["structure"])


def case_files(wildcards):
    """Structure and motion of a case, by name."""
    return {
        "structure": structure_file(wildcards),
        "motion": files_of_motion(CASES[wildcards.case]["motion"]),
    }


def files_of_motion(motion):
    """File of a motion, or all those of a set of records."""
    return [by_content(beside(path)) for path in record_files(motion)]


def motion_file(wildcards):
    """Files of a motion or a set of records, by the name of its results."""
    return files_of_motion(MOTIONS[wildcards.motion])


def intensity_of_records(wildcards):
    """That of the first case which chooses records of a set to a spectrum, if any."""
    asked = (
        one["intensity"] or {}
        for one in config["cases"]
        if one["motion"] == MOTIONS[wildcards.motion]
    )
    return next((one for one in asked if one.get("spectrum")), None)


def case_keys(case, *more):
    """Entries of a case in the configuration that its runs depend on."""
    keys = ("name", "structure", "motion", "baseline", "duration", *more)
    return {key: CASES[case][key] for key in keys}


def case_definition(wildcards):
    """The same of a case under one motion of its own."""
    return case_keys(wildcards.case, "scale", "input", "intensity")


def run_files(wildcards):
    """All that the samples of a case by a model are simulated from, by name."""
    study, model, case = wildcards.study, wildcards.model, wildcards.case
    return {
        **case_files(wildcards),
        "base": (
            f"results/{study}/inputs/{case}.nc" if CASES[case]["measured"] else []
        ),
        "stiffness": stiffness_file(model, study, case),
        "kernels": kernels(model),
    }


@cache
def design():
    """Values of all samples, which rules take as parameters: a batch runs again where those change that it has a use for."""
    return drawn_design(
        config["ensemble"], source_of("draw_samples"), f"results/{STUDY}"
    )


@cache
def loaded_structure(case):
    """Structure of a case."""
    return load_structure(CASES[case]["structure"])


def values_of(case, model, batch=None, but=()):
    """Sampled values of a case's batch, or of all samples, that a model has a use for, but for those of some kinds."""
    with refusing():
        values = design()
        values = values[[name for name in values if name.split(".")[0] not in but]]
        batch = batch or f"0-{len(values) - 1}"
        return batch_values(
            batch, values, loaded_structure(case), config["ensemble"]["linked"], model
        )


def stiffness_file(model, study, case):
    """Calibrated stiffness of the samples, for the models that have any: an edit of LS-DEM reruns no NSCD."""
    return (
        f"results/{study}/stiffness/{case}.csv" if solver_of(model).calibrated else []
    )


def kernels(model):
    """Mark that a model's kernels are compiled, the same for all models that run the same ones.

    Its name holds their digest, so that it goes out of date just when the model's runs do. Snakemake's `ancient`
    would not do: with it a study whose compilation is due runs that and nothing else (issue 4166).
    """
    sources = kernel_sources(model)
    first = next(name for name in SOLVERS if kernel_sources(name) == sources)
    return f"results/kernels/{first}-{source_digest(*sources)}.json"


def runs_of(model, case, **others):
    """`CaseRuns` of a case, a mapping, by a model."""
    return {
        "case": case,
        "model": model,
        "settings": config["models"][model],
        "linked": config["ensemble"]["linked"],
        **others,
    }


def sample_runs(wildcards):
    """Those of the samples of an ensemble, or of the replicate of its first one."""
    case, rate = case_definition(wildcards), config["output_rate"]
    runs = runs_of(wildcards.model, case, output_rate=rate)
    if wildcards.batch == HALF_STEP:
        step = 0.5 * runs["settings"]["time_step"]
        runs["settings"] = {**runs["settings"], "time_step": step}
    return runs


def batch_ids(count):
    """Ids of the batches of so many samples: first and last sample."""
    size = config["samples_per_job"]
    return [
        f"{first:03d}-{min(first + size, count) - 1:03d}"
        for first in range(0, count, size)
    ]


def batch_files(wildcards, model=None, case=None):
    """Batch files of a case by a model, of the wildcards if none is named."""
    model, case = model or wildcards.model, case or wildcards.case
    return expand(
        "results/{study}/runs/{model}/{case}/{batch}.nc",
        study=wildcards.study,
        model=model,
        case=case,
        batch=batch_ids(CHECKED.samples(model, case)),
    )


def batches_of_models(wildcards):
    """Batch files of a case by every model, each under a name of its own for the rule's input."""
    return {f"batches {model}": batch_files(wildcards, model) for model in MODELS}


def files_of_models(wildcards):
    """These, and the replicate of every model that has one."""
    folder, case = f"results/{wildcards.study}/runs", wildcards.case
    return batches_of_models(wildcards) | {
        f"replicate {model}": f"{folder}/{model}/{case}/{HALF_STEP}.nc"
        for model in MODELS
        if CHECKED.has_replicate(model, case)
    }


def files_of_pair(wildcards):
    """Samples of a case with a cause and of the same case without it, by every model; their fragility, where there is any."""
    pair = config["extension"]["cases"][wildcards.case], wildcards.case
    named = {
        f"{model} {word}": batch_files(wildcards, model, case)
        for model in MODELS
        for word, case in zip(("without", "with"), pair)
    }
    if set(pair) <= set((config["fragility"] or {"cases": ()})["cases"]):
        named["fragility"] = expand(
            "results/{study}/fragility/{case}.nc", study=wildcards.study, case=pair
        )
    return named


def files_of_report(only=None):
    """Files that the report of the study, or of one of its cases, is made of, by name."""
    cases = [only] if only else list(CASES)
    motions = {Path(CASES[case]["motion"]).stem for case in cases}
    folder = f"results/{STUDY}"
    return {
        "structures": [
            definition("structures", CASES[case]["structure"]) for case in cases
        ],
        "campaigns": [
            file
            for case in cases
            if CASES[case]["measured"]
            for file in campaign_files(case)
        ],
        "templates": TEMPLATES,
        "motions": [f"{folder}/motions/{motion}.nc" for motion in sorted(motions)],
        "design": [f"{folder}/design.{suffix}" for suffix in ("csv", "json")],
        "so_far": (
            [] if only else [f"{folder}/so-far/{stage}" for stage in range(len(CASES))]
        ),
        **{
            analysis.name: [
                f"{folder}/{file}" for file in analysis.files(config, only).values()
            ]
            for analysis in ANALYSES
        },
    }
