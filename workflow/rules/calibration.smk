CALIBRATION = config.get("calibration") or {}


rule compare_open_tests:
    """The open tests of a case's campaign against the samples of the calibration by a model; finished runs are kept."""
    input:
        structure=structure_file,
        campaign=open_files,
        kernels=lambda wildcards: kernels(wildcards.model),
    output:
        "results/{study}/open-tests/{model}/{case}.nc",
    log:
        "logs/{study}/compare_open_tests/{model}/{case}.log",
    benchmark:
        "logs/{study}/compare_open_tests/{model}/{case}.tsv"
    conda:
        "../envs/blockshake.yaml"
    resources:
        runtime=720,
    params:
        case=lambda wildcards: {
            key: CASES[wildcards.case][key]
            for key in ("name", "structure", "duration")
        },
        campaign=lambda wildcards: CASES[wildcards.case]["measured"]["campaign"],
        study=lambda wildcards: {
            **{key: config[key] for key in ("calibration", "ensemble", "output_rate")},
            "models": {wildcards.model: config["models"][wildcards.model]},
        },
        store="results/store",
        yaml_contents=yaml_contents(structure_file, open_files),
        source=lambda wildcards: source_of("compare_open_tests", wildcards.model),
    script:
        "../scripts/compare_open_tests.py"


rule calibrate_jointly:
    """Friction, restitution, stiffness and flatness of contacts by all open tests at once."""
    input:
        [
            f"results/{{study}}/open-tests/{model}/{case}.nc"
            for model, cases in CALIBRATION.get("cases", {}).items()
            for case in cases
        ],
    output:
        "results/{study}/calibration.json",
    log:
        "logs/{study}/calibrate_jointly.log",
    benchmark:
        "logs/{study}/calibrate_jointly.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        study={key: config[key] for key in ("calibration", "ensemble", "cases")},
        source=source_of("calibrate_jointly"),
    script:
        "../scripts/calibrate_jointly.py"
