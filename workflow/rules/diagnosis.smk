"""What the simulation of measured tests gets wrong, the cause, the extended model and its gain.

Equal structures, motions and sensors have equal ensembles, whatever campaign they are of: their runs are kept in the
store, so that a second campaign simulates nothing but its own extension.
"""


wildcard_constraints:
    campaign="|".join(map(re.escape, CAMPAIGNS)) or "none",
    solver="|".join(NULL_MODELS),
    number=r"\d+",


rule diagnose:
    """The verdict and the report of every campaign to diagnose."""
    input:
        expand(
            "reports/diagnosis-{campaign}.{kind}",
            campaign=CAMPAIGNS,
            kind=["html", "pdf"],
        ),


rule verdicts:
    """The verdict on every campaign to diagnose, without a report."""
    input:
        expand("results/diagnosis/{campaign}/verdict.json", campaign=CAMPAIGNS),


checkpoint decide:
    """The sensors checked, the open tests seen, and what they speak for; frozen before a sealed test is opened."""
    input:
        tests=lambda wildcards: test_files(wildcards.campaign, "open"),
        outcomes=lambda wildcards: outcome_files(wildcards.campaign),
        clean=lambda wildcards: clean_files(wildcards.campaign),
    output:
        parity="results/diagnosis/{campaign}/parity.json",
        decision="results/diagnosis/{campaign}/decision.json",
        evidence="results/diagnosis/{campaign}/evidence.nc",
        frozen="results/diagnosis/{campaign}/frozen.json",
    log:
        "logs/diagnosis/{campaign}/decide.log",
    benchmark:
        "logs/diagnosis/{campaign}/decide.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        without=WITHOUT,
        source=source_of("decide"),
    script:
        "../scripts/decide.py"


rule simulate_clean:
    """Open tests simulated without any cause, and the evidence of every cause in them: by chance."""
    input:
        tests=lambda wildcards: test_files(wildcards.campaign, "open"),
        kernels=lambda wildcards: kernels(wildcards.solver),
    output:
        "results/diagnosis/{campaign}/clean/{solver}.json",
    log:
        "logs/diagnosis/{campaign}/simulate_clean/{solver}.log",
    benchmark:
        "logs/diagnosis/{campaign}/simulate_clean/{solver}.tsv"
    conda:
        "../envs/blockshake.yaml"
    resources:
        runtime=480,
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        draws=lambda wildcards: plan(wildcards.campaign).clean,
        source=lambda wildcards: source_of("simulate_clean", wildcards.solver),
        store="results/store/diagnosis",
    script:
        "../scripts/simulate_clean.py"


rule simulate_nominal:
    """Simulated tests of one structure under one motion by nominal models, and replicates."""
    input:
        tests=lambda wildcards: test_files(wildcards.campaign, "open"),
        kernels=lambda wildcards: kernels(wildcards.solver),
    output:
        "results/diagnosis/{campaign}/ensembles/{number}-{solver}.nc",
    log:
        "logs/diagnosis/{campaign}/simulate_nominal/{number}-{solver}.log",
    benchmark:
        "logs/diagnosis/{campaign}/simulate_nominal/{number}-{solver}.tsv"
    conda:
        "../envs/blockshake.yaml"
    resources:
        runtime=480,
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        draws=lambda wildcards: effort().draws,
        twins=lambda wildcards: effort().twins,
        source=solver_source,
        store="results/store/diagnosis",
    script:
        "../scripts/simulate_nominal.py"


rule simulate_outcomes:
    """A batch of tests of which it is known alone whether the body fell, by several models of one solver."""
    input:
        tests=lambda wildcards: motion_files(wildcards.campaign),
        kernels=lambda wildcards: kernels(wildcards.solver),
    output:
        "results/diagnosis/{campaign}/outcomes/{number}-{solver}.nc",
    log:
        "logs/diagnosis/{campaign}/simulate_outcomes/{number}-{solver}.log",
    benchmark:
        "logs/diagnosis/{campaign}/simulate_outcomes/{number}-{solver}.tsv"
    conda:
        "../envs/blockshake.yaml"
    resources:
        runtime=480,
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        draws=lambda wildcards: effort().outcomes,
        source=lambda wildcards: source_of("simulate_outcomes", wildcards.solver),
        store="results/store/diagnosis",
    script:
        "../scripts/simulate_outcomes.py"


rule describe_misfit:
    """The nominal ensembles beside what was measured, as long as each joint can be predicted."""
    input:
        parity="results/diagnosis/{campaign}/parity.json",
        ensembles=lambda wildcards: ensemble_files(wildcards.campaign),
        tests=lambda wildcards: test_files(wildcards.campaign, "open"),
    output:
        "results/diagnosis/{campaign}/misfit.nc",
    log:
        "logs/diagnosis/{campaign}/describe_misfit.log",
    benchmark:
        "logs/diagnosis/{campaign}/describe_misfit.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        source=source_of("describe_misfit"),
    script:
        "../scripts/describe_misfit.py"


rule extend_model:
    """Ensembles by one solver on the sealed tests: nominal, recalibrated, extended by the causes, and a placebo.

    Of the sealed files it reads where the blocks stood at the start, and no reading.
    """
    input:
        frozen="results/diagnosis/{campaign}/frozen.json",
        decision="results/diagnosis/{campaign}/decision.json",
        parity="results/diagnosis/{campaign}/parity.json",
        motions=lambda wildcards: sealed_motions(wildcards.campaign),
        sealed=lambda wildcards: test_files(wildcards.campaign, "sealed"),
        tests=lambda wildcards: test_files(wildcards.campaign, "open"),
        ensembles=lambda wildcards: ensemble_files(
            wildcards.campaign, [wildcards.solver]
        ),
        kernels=lambda wildcards: kernels(wildcards.solver),
    output:
        "results/diagnosis/{campaign}/extended/{solver}.nc",
    log:
        "logs/diagnosis/{campaign}/extend_model/{solver}.log",
    benchmark:
        "logs/diagnosis/{campaign}/extend_model/{solver}.tsv"
    conda:
        "../envs/blockshake.yaml"
    resources:
        runtime=480,
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        members=lambda wildcards: effort().members,
        store="results/store/diagnosis",
        source=solver_source,
        judged_by=source_of("extend_model"),
    script:
        "../scripts/extend_model.py"


rule measure_gain:
    """What naming the cause gains on the sealed tests, against its rivals: the one rule that reads what they measured."""
    input:
        frozen="results/diagnosis/{campaign}/frozen.json",
        decision="results/diagnosis/{campaign}/decision.json",
        parity="results/diagnosis/{campaign}/parity.json",
        tests=lambda wildcards: test_files(wildcards.campaign, "open"),
        ensembles=lambda wildcards: ensemble_files(wildcards.campaign),
        extended=extended_files,
        outcomes=lambda wildcards: outcome_files(wildcards.campaign),
        sealed=lambda wildcards: test_files(wildcards.campaign, "sealed"),
    output:
        gain="results/diagnosis/{campaign}/gain.nc",
        summary="results/diagnosis/{campaign}/gain.json",
    log:
        "logs/diagnosis/{campaign}/measure_gain.log",
    benchmark:
        "logs/diagnosis/{campaign}/measure_gain.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        source=source_of("measure_gain"),
    script:
        "../scripts/measure_gain.py"


rule conclude:
    """The verdict: sensors, decision and gain put together."""
    input:
        parity="results/diagnosis/{campaign}/parity.json",
        decision="results/diagnosis/{campaign}/decision.json",
        gain=gain_files,
        tests=lambda wildcards: test_files(wildcards.campaign, "open"),
    output:
        "results/diagnosis/{campaign}/verdict.json",
    log:
        "logs/diagnosis/{campaign}/conclude.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        runs=lambda wildcards: plan(wildcards.campaign).runs,
        source=source_of("conclude"),
    script:
        "../scripts/conclude.py"


rule make_diagnosis_report:
    """The diagnosis as one self-contained page and as a PDF, from the same content."""
    input:
        tests=lambda wildcards: test_files(wildcards.campaign, "open"),
        results=expand(
            "results/diagnosis/{{campaign}}/{name}",
            name=[
                "parity.json",
                "decision.json",
                "evidence.nc",
                "verdict.json",
            ],
        ),
        misfit=misfit_files,
        gain=gain_files,
        templates=TEMPLATES,
        track_record=[TRACK_RECORD] if Path(TRACK_RECORD).exists() else [],
    output:
        html=report(
            "reports/diagnosis-{campaign}.html",
            category="Diagnosis",
            caption="../report/diagnosis.rst",
            labels={"campaign": "{campaign}", "format": "HTML"},
        ),
        pdf=report(
            "reports/diagnosis-{campaign}.pdf",
            category="Diagnosis",
            caption="../report/diagnosis.rst",
            labels={"campaign": "{campaign}", "format": "PDF"},
        ),
    log:
        "logs/diagnosis/{campaign}/make_diagnosis_report.log",
    benchmark:
        "logs/diagnosis/{campaign}/make_diagnosis_report.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        results=lambda wildcards, input: str(Path(input.results[0]).parent),
        effort=EFFORT,
        track_record=lambda wildcards: TRACK_RECORD,
        source=source_of("make_diagnosis_report"),
    script:
        "../scripts/make_diagnosis_report.py"
