rule calibrate_stiffness:
    """Contact stiffness of every sample from the wave speed in a tower of four blocks."""
    input:
        design="results/{study}/design.csv",
        tower="config/structures/configuration-2.yaml",
        kernels=kernels("ls-dem"),
    output:
        stiffness="results/{study}/stiffness.csv",
        waves="results/{study}/waves.nc",
    log:
        "logs/{study}/calibrate_stiffness.log",
    benchmark:
        "benchmarks/{study}/calibrate_stiffness.jsonl"
    conda:
        "../envs/blockshake.yaml"
    params:
        linked=lookup(dpath="ensemble/linked", within=config, default={}),
        source=source_digest(*sources.STIFFNESS),
    script:
        "../scripts/calibrate_stiffness.py"
