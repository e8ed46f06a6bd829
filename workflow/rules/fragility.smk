FRAGILITY = config.get("fragility") or {}


rule climb_samples:
    """Some samples of a case, each at rising intensities until its potential collapse; finished runs are in the store."""
    input:
        unpack(case_files),
        stiffness=lambda wildcards: stiffness_file(
            FRAGILITY["model"], wildcards.study, wildcards.case
        ),
        kernels=lambda wildcards: kernels(FRAGILITY["model"]),
    output:
        "results/{study}/climbs/{case}/{batch}.nc",
    log:
        "logs/{study}/climb_samples/{case}/{batch}.log",
    benchmark:
        "logs/{study}/climb_samples/{case}/{batch}.tsv"
    conda:
        "../envs/blockshake.yaml"
    resources:
        runtime=240,
    params:
        runs=lambda wildcards: runs_of(
            FRAGILITY["model"], case_keys(wildcards.case, "intensity")
        ),
        batch=lambda wildcards: values_of(
            wildcards.case, FRAGILITY["model"], wildcards.batch
        ),
        seed=lookup(dpath="ensemble/seed", within=config),
        ladder=lookup(dpath="ladder", within=config),
        store="results/store",
        yaml_contents=yaml_contents(case_files),
        source=lambda wildcards: source_of("climb_samples", FRAGILITY["model"]),
    script:
        "../scripts/climb_samples.py"


rule fit_fragility:
    """Probability of a potential collapse by intensity: shares at the levels, and a lognormal curve through them."""
    input:
        lambda wildcards: expand(
            "results/{study}/climbs/{case}/{batch}.nc",
            study=wildcards.study,
            case=wildcards.case,
            batch=batch_ids(FRAGILITY["size"]),
        ),
    output:
        "results/{study}/fragility/{case}.nc",
    log:
        "logs/{study}/fit_fragility/{case}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        source=source_of("fit_fragility"),
    script:
        "../scripts/fit_fragility.py"


rule fit_cloud:
    """Fragilities of samples that draw their motions, over the intensity of these."""
    input:
        unpack(case_files),
        samples="results/{study}/samples/{model}/{case}.nc",
    output:
        "results/{study}/clouds/{model}/{case}.nc",
    log:
        "logs/{study}/fit_cloud/{model}/{case}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        case=case_definition,
        yaml_contents=yaml_contents(case_files),
        seed=lookup(dpath="ensemble/seed", within=config),
        largest_drift=lookup(dpath="ladder/largest_drift", within=config),
        source=source_of("fit_cloud"),
    script:
        "../scripts/fit_cloud.py"
