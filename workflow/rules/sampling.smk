rule draw_samples:
    """Latin hypercube of the random variables with controlled correlation."""
    output:
        design="results/{study}/design.csv",
        summary="results/{study}/design.json",
    log:
        "logs/{study}/draw_samples.log",
    priority: for_first_picture
    conda:
        "../envs/blockshake.yaml"
    params:
        ensemble=lookup(dpath="ensemble", within=config),
        source=source_of("draw_samples"),
    script:
        "../scripts/draw_samples.py"
