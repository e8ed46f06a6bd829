rule study_convergence:
    """Two short runs of LS-DEM with time step, nodes, inset and grid varied one at a time."""
    input:
        structure=lambda wildcards: definition(
            "structures", config["convergence"]["structure"]
        ),
        kernels=kernels("ls-dem"),
    output:
        "results/{study}/convergence.csv",
    log:
        "logs/{study}/study_convergence.log",
    params:
        convergence=lookup(dpath="convergence", within=config),
        store="results/store",
        source=source_of("study_convergence", "ls-dem"),
    script:
        "../scripts/study_convergence.py"
