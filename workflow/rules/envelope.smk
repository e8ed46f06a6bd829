rule make_envelope:
    """Bounds and quantiles over the samples, what each came to, and the motion of the median and of the largest one."""
    input:
        batches=batch_files,
        structure=structure_file,
    output:
        envelope="results/{study}/envelopes/{model}/{case}.nc",
        samples="results/{study}/samples/{model}/{case}.nc",
        shown="results/{study}/shown/{model}/{case}.nc",
    log:
        "logs/{study}/make_envelope/{model}/{case}.log",
    benchmark:
        "logs/{study}/make_envelope/{model}/{case}.tsv"
    priority: for_first_picture
    conda:
        "../envs/blockshake.yaml"
    params:
        structure=lambda wildcards: CASES[wildcards.case]["structure"],
        largest_drift=lookup(dpath="ladder/largest_drift", within=config),
        yaml_contents=yaml_contents(structure_file),
        source=source_of("make_envelope"),
    script:
        "../scripts/make_envelope.py"


rule compare_with_measurement:
    """Coverage of the measured curves by the bounds of every model, with its leave-one-out reference."""
    input:
        unpack(batches_of_models),
        base="results/{study}/inputs/{case}.nc",
        campaign=measured_files,
    output:
        [f"results/{{study}}/comparisons/{model}/{{case}}.nc" for model in MODELS],
    log:
        "logs/{study}/compare_with_measurement/{case}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        models=MODELS,
        measured=lambda wildcards: CASES[wildcards.case]["measured"],
        yaml_contents=yaml_contents(measured_files),
        source=source_of("compare_with_measurement"),
    script:
        "../scripts/compare_with_measurement.py"


rule measure_sensitivity:
    """Which random variable makes the samples differ, block by block, with intervals and the level of chance."""
    input:
        batches=batch_files,
        structure=structure_file,
        design="results/{study}/design.csv",
    output:
        "results/{study}/sensitivities/{model}/{case}.nc",
    log:
        "logs/{study}/measure_sensitivity/{model}/{case}.log",
    benchmark:
        "logs/{study}/measure_sensitivity/{model}/{case}.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        case=case_definition,
        linked=lookup(dpath="ensemble/linked", within=config),
        seed=lookup(dpath="ensemble/seed", within=config),
        size=lookup(dpath="ensemble/size", within=config),
        yaml_contents=yaml_contents(structure_file),
        source=source_of("measure_sensitivity"),
    script:
        "../scripts/measure_sensitivity.py"


rule compare_models:
    """Distances of the models' ensembles from each other and from the measured curves, beside the numerics' floor."""
    input:
        unpack(files_of_models),
        base=lambda wildcards: (
            f"results/{wildcards.study}/inputs/{wildcards.case}.nc"
            if CASES[wildcards.case]["measured"]
            else []
        ),
        campaign=measured_files,
    output:
        "results/{study}/differences/{case}.nc",
    log:
        "logs/{study}/compare_models/{case}.log",
    benchmark:
        "logs/{study}/compare_models/{case}.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        models=MODELS,
        case=case_definition,
        measured=lambda wildcards: CASES[wildcards.case]["measured"],
        seed=lookup(dpath="ensemble/seed", within=config),
        size=lookup(dpath="ensemble/size", within=config),
        yaml_contents=yaml_contents(measured_files),
        source=source_of("compare_models"),
    script:
        "../scripts/compare_models.py"
