def run_files(wildcards):
    """All that the samples of a case by a model are simulated from, by name."""
    study, model, case = wildcards.study, wildcards.model, wildcards.case
    return {
        **case_files(wildcards),
        "base": (
            f"results/{study}/inputs/{case}.nc"
            if CASES[case]["input"] == "measured"
            else []
        ),
        "design": f"results/{study}/design.csv",
        "stiffness": stiffness_file(model, study, case),
        "kernels": kernels(model),
    }


def stiffness_file(model, study, case):
    """Calibrated stiffness of the samples, for the models that have any: an edit of LS-DEM reruns no NSCD."""
    return f"results/{study}/stiffness/{case}.csv" if SOLVERS[model].calibrated else []


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
    """Those of the samples of an ensemble."""
    case, rate = case_definition(wildcards), config["output_rate"]
    return runs_of(wildcards.model, case, output_rate=rate)


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
        batch=batch_ids(CHECKED.samples(model, wildcards.case)),
    )


LS_DEM_STEP = (
    config["models"].get("ls-dem", {}).get("time_step", SOLVERS["ls-dem"].time_step)
)
LADDER_MOTIONS = config["ladder"]["motions"] or list(
    dict.fromkeys(case["motion"] for case in config["cases"])
)


rule compile_kernels:
    """A solver compiled once, before jobs that would all do it."""
    output:
        "results/kernels/{model}-{digest}.json",
    log:
        "logs/compile_kernels/{model}-{digest}.log",
    script:
        "../scripts/compile_kernels.py"


rule simulate_batch:
    """Some samples of a case by a model; a single sample is a batch whose first is its last.

    Each finished sample goes at once to the store, from which a killed batch resumes: the store is
    no declared output, because Snakemake deletes those of a killed job.
    """
    input:
        unpack(run_files),
    output:
        "results/{study}/runs/{model}/{case}/{batch}.nc",
    log:
        "logs/{study}/simulate_batch/{model}/{case}/{batch}.log",
    resources:
        runtime=240,
    params:
        runs=sample_runs,
        seed=lookup(dpath="ensemble/seed", within=config),
        store="results/store",
        source=lambda wildcards: source_of("simulate_batch", wildcards.model),
    script:
        "../scripts/simulate_batch.py"


rule run_twins:
    """The first sample a little stronger and at half the step, and one block alone: the floor of a model's numerics."""
    input:
        unpack(run_files),
    output:
        "results/{study}/twins/{model}/{case}.nc",
    log:
        "logs/{study}/run_twins/{model}/{case}.log",
    resources:
        runtime=240,
    params:
        runs=sample_runs,
        seed=lookup(dpath="ensemble/seed", within=config),
        store="results/store",
        source=lambda wildcards: source_of("run_twins", wildcards.model),
    script:
        "../scripts/run_twins.py"


rule climb_ladder:
    """The paper's ladder of intensities with nominal parameters: what the cases' scales were taken from."""
    input:
        structures=[
            definition("structures", case["structure"]) for case in CASES.values()
        ],
        motions=[definition("motions", motion) for motion in LADDER_MOTIONS],
        kernels=kernels("ls-dem"),
    output:
        "results/{study}/ladder.json",
    log:
        "logs/{study}/climb_ladder.log",
    params:
        cases=[case for case in CASES.values()],
        motions={motion: BASELINES[motion] for motion in LADDER_MOTIONS},
        ladder=lookup(dpath="ladder", within=config),
        time_step=LS_DEM_STEP,
        store="results/store",
        source=source_of("climb_ladder", "ls-dem"),
    script:
        "../scripts/climb_ladder.py"
