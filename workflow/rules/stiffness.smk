LS_DEM_STEP = (
    config["models"].get("ls-dem", {}).get("time_step", SOLVERS["ls-dem"].time_step)
)


rule calibrate_stiffness:
    """Contact stiffness of every sample of a case from the wave speed in a tower of four of its blocks."""
    input:
        design="results/{study}/design.csv",
        structure=structure_file,
        kernels=kernels("ls-dem"),
    output:
        stiffness="results/{study}/stiffness/{case}.csv",
        waves="results/{study}/waves/{case}.nc",
    log:
        "logs/{study}/calibrate_stiffness/{case}.log",
    params:
        structure=lambda wildcards: CASES[wildcards.case]["structure"],
        linked=lookup(dpath="ensemble/linked", within=config),
        store="results/store",
        source=source_of("calibrate_stiffness"),
    script:
        "../scripts/calibrate_stiffness.py"


rule compare_definitions:
    """Contact stiffness by the definition of a wave's arrival and by damping, and the peak of a stack with each."""
    input:
        structure=definition("structures", config["cases"][0]["structure"]),
        motion=definition("motions", config["cases"][0]["motion"]),
        kernels=kernels("ls-dem"),
    output:
        "results/{study}/stiffness-definitions.nc",
    log:
        "logs/{study}/compare_definitions.log",
    params:
        case=lookup(dpath="cases/0", within=config),
        time_step=LS_DEM_STEP,
        store="results/store",
        source=source_of("compare_definitions", "ls-dem"),
    script:
        "../scripts/compare_definitions.py"
