rule compile_kernels:
    """A solver compiled once, before jobs that would all do it."""
    output:
        "results/kernels/{model}-{digest}.json",
    log:
        "logs/compile_kernels/{model}-{digest}.log",
    priority: for_first_picture
    conda:
        "../envs/blockshake.yaml"
    script:
        "../scripts/compile_kernels.py"


rule simulate_batch:
    """Some samples of a case by a model, or the replicate of the first one; a single sample is a batch whose first is its last.

    Each finished sample goes at once to the store, from which a killed batch resumes: the store is
    no declared output, because Snakemake deletes those of a killed job.
    """
    input:
        unpack(run_files),
    output:
        "results/{study}/runs/{model}/{case}/{batch}.nc",
    log:
        "logs/{study}/simulate_batch/{model}/{case}/{batch}.log",
    benchmark:
        "logs/{study}/simulate_batch/{model}/{case}/{batch}.tsv"
    priority: for_first_picture
    conda:
        "../envs/blockshake.yaml"
    resources:
        runtime=240,
    params:
        runs=sample_runs,
        batch=lambda wildcards: values_of(
            wildcards.case, wildcards.model, wildcards.batch
        ),
        seed=lookup(dpath="ensemble/seed", within=config),
        store="results/store",
        yaml_contents=yaml_contents(run_files),
        source=lambda wildcards: source_of("simulate_batch", wildcards.model),
    script:
        "../scripts/simulate_batch.py"
