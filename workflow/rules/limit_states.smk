rule measure_limit_states:
    """The study's own limit states: probability of each, and its fragility over the intensity of the motions."""
    input:
        unpack(case_files),
        batches=batch_files,
        base=lambda wildcards: (
            f"results/{wildcards.study}/inputs/{wildcards.case}.nc"
            if CASES[wildcards.case]["measured"]
            else []
        ),
    output:
        "results/{study}/limits/{model}/{case}.nc",
    log:
        "logs/{study}/measure_limit_states/{model}/{case}.log",
    benchmark:
        "logs/{study}/measure_limit_states/{model}/{case}.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        case=case_definition,
        linked=lookup(dpath="ensemble/linked", within=config),
        limits=config["limits"],
        seed=lookup(dpath="ensemble/seed", within=config),
        yaml_contents=yaml_contents(case_files),
        source=source_of("measure_limit_states"),
    script:
        "../scripts/measure_limit_states.py"


rule measure_indices:
    """Shapley effects and Sobol indices of a case's responses, by a surrogate of the runs, where it is good enough."""
    input:
        samples="results/{study}/samples/{model}/{case}.nc",
        sensitivity="results/{study}/sensitivities/{model}/{case}.nc",
        limits=lambda wildcards: [
            f"results/{wildcards.study}/{file}"
            for analysis in ANALYSES
            if analysis.name == "limits"
            for pair, file in analysis.files(config).items()
            if pair == (wildcards.case, wildcards.model)
        ],
    output:
        "results/{study}/indices/{model}/{case}.nc",
    log:
        "logs/{study}/measure_indices/{model}/{case}.log",
    benchmark:
        "logs/{study}/measure_indices/{model}/{case}.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        case=case_definition,
        seed=lookup(dpath="ensemble/seed", within=config),
        size=lookup(dpath="ensemble/size", within=config),
        source=source_of("measure_indices"),
    script:
        "../scripts/measure_indices.py"


rule write_responses:
    """All answers in one table: a row a run, with its sampled values, its motion, its responses and how it ended."""
    input:
        design="results/{study}/design.csv",
        samples=expand(
            "results/{{study}}/samples/{model}/{case}.nc", model=MODELS, case=CASES
        ),
        limits=[
            f"results/{{study}}/{file}"
            for analysis in ANALYSES
            if analysis.name == "limits"
            for file in analysis.files(config).values()
        ],
        motions=[
            file for motion in MOTIONS.values() for file in files_of_motion(motion)
        ],
    output:
        "results/{study}/responses.csv",
    log:
        "logs/{study}/write_responses.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        study={key: config[key] for key in ("cases", "models", "limits", "ensemble")},
        source=source_of("write_responses"),
    script:
        "../scripts/write_responses.py"
