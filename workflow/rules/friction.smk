rule calibrate_friction:
    """The mean friction whose ensembles fit a measured test best: one job a case, its samples in the store."""
    input:
        structure=lambda wildcards: definition(
            "structures", CASES[wildcards.case]["structure"]
        ),
        motion=lambda wildcards: definition("motions", CASES[wildcards.case]["motion"]),
        tower="config/structures/configuration-2.yaml",
        campaign=lambda wildcards: campaign_files(wildcards.case),
        kernels=kernels(FRICTION_SEARCH.get("model", "nscd-rigid")),
    output:
        "results/{study}/friction/{case}.json",
    log:
        "logs/{study}/calibrate_friction/{case}.log",
    benchmark:
        "benchmarks/{study}/calibrate_friction/{case}.jsonl"
    conda:
        "../envs/blockshake.yaml"
    params:
        case=case_definition,
        measured=lambda wildcards: CASES[wildcards.case]["measured"],
        search=FRICTION_SEARCH,
        ensemble=lookup(dpath="ensemble", within=config),
        models=lookup(dpath="models", within=config),
        output_rate=lookup(dpath="output_rate", within=config),
        store="results/store",
        source=source_digest(
            *sources.friction_sources(FRICTION_SEARCH.get("model", "nscd-rigid"))
        ),
    script:
        "../scripts/calibrate_friction.py"
