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
    conda:
        "../envs/blockshake.yaml"
    script:
        "../scripts/compile_kernels.py"


rule simulate_batch:
    """Some samples of a case by a model, or the twin of the first one; a single sample is a batch whose first is its last.

    Each finished sample goes at once to the store, from which a killed batch resumes: the store is
    no declared output, because Snakemake deletes those of a killed job.
    """
    input:
        unpack(run_files),
    output:
        "results/{study}/runs/{model}/{case}/{batch}.nc",
    log:
        "logs/{study}/simulate_batch/{model}/{case}/{batch}.log",
    conda:
        "../envs/blockshake.yaml"
    resources:
        runtime=240,
    params:
        runs=sample_runs,
        seed=lookup(dpath="ensemble/seed", within=config),
        store="results/store",
        source=lambda wildcards: source_of("simulate_batch", wildcards.model),
    script:
        "../scripts/simulate_batch.py"


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
    conda:
        "../envs/blockshake.yaml"
    params:
        cases=[case for case in CASES.values()],
        motions={motion: BASELINES[motion] for motion in LADDER_MOTIONS},
        ladder=lookup(dpath="ladder", within=config),
        time_step=LS_DEM_STEP,
        store="results/store",
        source=source_of("climb_ladder", "ls-dem"),
    script:
        "../scripts/climb_ladder.py"
