rule calibrate_stiffness:
    """Contact stiffness of every sample of a case from the wave speed in a tower of four of its blocks."""
    input:
        structure=structure_file,
        kernels=kernels("ls-dem"),
    output:
        stiffness="results/{study}/stiffness/{case}.csv",
        waves="results/{study}/waves/{case}.nc",
    log:
        "logs/{study}/calibrate_stiffness/{case}.log",
    benchmark:
        "logs/{study}/calibrate_stiffness/{case}.tsv"
    priority: for_first_picture
    conda:
        "../envs/blockshake.yaml"
    params:
        structure=lambda wildcards: CASES[wildcards.case]["structure"],
        samples=lambda wildcards: values_of(
            wildcards.case, "ls-dem", but=("friction", "motion")
        ),
        linked=lookup(dpath="ensemble/linked", within=config),
        store="results/store",
        yaml_contents=yaml_contents(structure_file),
        source=source_of("calibrate_stiffness"),
    script:
        "../scripts/calibrate_stiffness.py"
