rule measure_changes:
    """What a cause changes in the responses of a case, and its gain where the case has a measured test."""
    input:
        unpack(files_of_pair),
        base=lambda wildcards: (
            f"results/{wildcards.study}/inputs/{wildcards.case}.nc"
            if CASES[wildcards.case]["measured"]
            else []
        ),
        campaign=measured_files,
    output:
        "results/{study}/changes/{case}.nc",
    log:
        "logs/{study}/measure_changes/{case}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        models=MODELS,
        climber=FRAGILITY.get("model"),
        measured=lambda wildcards: CASES[wildcards.case]["measured"],
        yaml_contents=yaml_contents(measured_files),
        source=source_of("measure_changes"),
    script:
        "../scripts/measure_changes.py"
