FRICTION_SEARCH = config.get("friction_calibration") or {}


rule calibrate_friction:
    """The mean friction whose ensembles fit a measured test best: one job a case, its samples in the store."""
    input:
        unpack(case_files),
        base="results/{study}/inputs/{case}.nc",
        campaign=lambda wildcards: campaign_files(wildcards.case),
        kernels=lambda wildcards: kernels(FRICTION_SEARCH["model"]),
    output:
        "results/{study}/friction/{case}.json",
    log:
        "logs/{study}/calibrate_friction/{case}.log",
    resources:
        runtime=2880,
    params:
        case=case_definition,
        measured=lambda wildcards: CASES[wildcards.case]["measured"],
        given=lambda wildcards: {
            "search": FRICTION_SEARCH,
            **{key: config[key] for key in ("ensemble", "models", "output_rate")},
        },
        store="results/store",
        source=lambda wildcards: source_of(
            "calibrate_friction", FRICTION_SEARCH["model"]
        ),
    script:
        "../scripts/calibrate_friction.py"
