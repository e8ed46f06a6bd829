rule study_convergence:
    """What LS-DEM's time step, nodes, inset and grid change in two short runs, varied one at a time."""
    input:
        structure=definition("structures", config["convergence"]["structure"]),
        kernels=kernels("ls-dem"),
    output:
        "results/{study}/convergence.csv",
    log:
        "logs/{study}/study_convergence.log",
    benchmark:
        "benchmarks/{study}/study_convergence.jsonl"
    conda:
        "../envs/blockshake.yaml"
    resources:
        mem_mb=2000,
    params:
        convergence=lookup(dpath="convergence", within=config),
        source=source_digest(*sources.CONVERGENCE),
    script:
        "../scripts/study_convergence.py"
