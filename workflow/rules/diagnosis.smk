"""What the simulation of measured tests gets wrong, the cause, the extended model and its gain.

Libraries and calibrations are named by their content: equal structures, motions and sensors have equal ones, whatever
campaign they are of, so that a second campaign simulates nothing but its own extension and further draws of a cause
that no campaign had before.
"""


wildcard_constraints:
    campaign="|".join(map(re.escape, CAMPAIGNS)) or "none",
    solver="|".join(NULL_MODELS),
    library="[0-9a-f]{12}",
    calibration="[0-9a-f]{12}",
    candidate="[^/]+",


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


rule simulate_library:
    """Simulated tests of one structure under one motion: nominal ones, and with every candidate effect."""
    input:
        kernels=lambda wildcards: kernels(wildcards.solver),
    output:
        features="results/libraries/{library}/{solver}.nc",
        histories="results/libraries/{library}/{solver}-histories.nc",
    log:
        "logs/simulate_library/{library}-{solver}.log",
    conda:
        "../envs/blockshake.yaml"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=480,
    params:
        shared=LIBRARY_SOURCE,
        source=solver_source,
        store="results/store/diagnosis",
    script:
        "../scripts/simulate_library.py"


rule calibrate_decision:
    """Every draw of the libraries judged by all others: what scores are worth."""
    input:
        calibration_libraries,
    output:
        "results/libraries/calibrations/{calibration}.json",
    log:
        "logs/calibrate_decision/{calibration}.log",
    conda:
        "../envs/blockshake.yaml"
    resources:
        mem_mb=4000,
    params:
        effects=lambda wildcards: considered_effects(),
        store="results/store/diagnosis",
        source=CALIBRATION_SOURCE,
    script:
        "../scripts/calibrate_decision.py"


rule read_measured:
    """Sensors checked against each other, their faults taken out, and the open tests read off."""
    input:
        lambda wildcards: test_files(wildcards.campaign, "open"),
    output:
        parity="results/diagnosis/{campaign}/parity.json",
        readings="results/diagnosis/{campaign}/measured.nc",
        forces="results/diagnosis/{campaign}/forces.nc",
    log:
        "logs/diagnosis/{campaign}/read_measured.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        without=WITHOUT,
        source=source_of("read_measured"),
    script:
        "../scripts/read_measured.py"


checkpoint decide:
    """Which effects the open tests speak for; frozen with its hash before a sealed test is opened."""
    input:
        readings=rules.read_measured.output.readings,
        forces=rules.read_measured.output.forces,
        libraries=lambda wildcards: library_files(wildcards.campaign),
        histories=lambda wildcards: library_files(
            wildcards.campaign, "{solver}-histories.nc"
        ),
        calibration=calibration_file,
    output:
        decision="results/diagnosis/{campaign}/decision.json",
        misfit="results/diagnosis/{campaign}/misfit.nc",
        evidence="results/diagnosis/{campaign}/evidence.nc",
        frozen="results/diagnosis/{campaign}/frozen.json",
    log:
        "logs/diagnosis/{campaign}/decide.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effects=lambda wildcards: considered_effects(),
        source=source_of("decide"),
    script:
        "../scripts/decide.py"


rule simulate_cause:
    """More draws with one candidate than the library has, of one structure under one motion."""
    input:
        kernels=lambda wildcards: kernels(wildcards.solver),
        library="results/libraries/{library}/{solver}.nc",
    output:
        "results/libraries/{library}/{solver}/{candidate}.nc",
    log:
        "logs/simulate_cause/{library}-{solver}-{candidate}.log",
    conda:
        "../envs/blockshake.yaml"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=480,
    params:
        shared=LIBRARY_SOURCE,
        source=solver_source,
        store="results/store/diagnosis",
        further_draws=lambda wildcards: effort().further_draws,
        asked_by=lambda wildcards: source_of("simulate_cause", wildcards.solver),
    script:
        "../scripts/simulate_cause.py"


rule size_cause:
    """The size of the first cause, from all draws with it; frozen before a sealed test is opened."""
    input:
        frozen="results/diagnosis/{campaign}/frozen.json",
        decision="results/diagnosis/{campaign}/decision.json",
        readings=rules.read_measured.output.readings,
        libraries=lambda wildcards: library_files(wildcards.campaign),
        further=further_files,
    output:
        posterior="results/diagnosis/{campaign}/size.json",
        frozen="results/diagnosis/{campaign}/frozen-size.json",
    log:
        "logs/diagnosis/{campaign}/size_cause.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        effects=lambda wildcards: considered_effects(),
        source=source_of("size_cause"),
    script:
        "../scripts/size_cause.py"


rule extend_model:
    """Ensembles by one solver: recalibrated on the open tests, and extended by the cause, for sealed tests too."""
    input:
        frozen="results/diagnosis/{campaign}/frozen.json",
        decision="results/diagnosis/{campaign}/decision.json",
        posterior=size_files,
        motions=lambda wildcards: sealed_motions(wildcards.campaign),
        readings=rules.read_measured.output.readings,
        libraries=lambda wildcards: library_files(wildcards.campaign),
        further=cause_files,
        kernels=lambda wildcards: kernels(wildcards.solver),
    output:
        "results/diagnosis/{campaign}/extended/{solver}.nc",
    log:
        "logs/diagnosis/{campaign}/extend_model/{solver}.log",
    conda:
        "../envs/blockshake.yaml"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=480,
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        members=lambda wildcards: effort().members,
        effects=lambda wildcards: considered_effects(),
        store="results/store/diagnosis",
        source=solver_source,
        judged_by=source_of("extend_model"),
    script:
        "../scripts/extend_model.py"


rule measure_gain:
    """What naming the cause gains on the sealed tests, against three rivals: the one rule that reads them."""
    input:
        frozen="results/diagnosis/{campaign}/frozen.json",
        decision="results/diagnosis/{campaign}/decision.json",
        readings=rules.read_measured.output.readings,
        libraries=lambda wildcards: library_files(wildcards.campaign),
        posterior=size_files,
        extended=extended_files,
        parity=rules.read_measured.output.parity,
        sealed=lambda wildcards: test_files(wildcards.campaign, "sealed"),
    output:
        gain="results/diagnosis/{campaign}/gain.nc",
        consequences="results/diagnosis/{campaign}/consequences.nc",
        summary="results/diagnosis/{campaign}/gain.json",
    log:
        "logs/diagnosis/{campaign}/measure_gain.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        source=source_of("measure_gain"),
    script:
        "../scripts/measure_gain.py"


rule conclude:
    """The verdict: sensors, decision and gain put together."""
    input:
        parity=rules.read_measured.output.parity,
        decision="results/diagnosis/{campaign}/decision.json",
        misfit="results/diagnosis/{campaign}/misfit.nc",
        posterior=size_files,
        gain=gain_files,
    output:
        "results/diagnosis/{campaign}/verdict.json",
    log:
        "logs/diagnosis/{campaign}/conclude.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        runs=lambda wildcards: [
            plan(wildcards.campaign).runs,
            plan(wildcards.campaign).further_runs,
        ],
        source=source_of("conclude"),
    script:
        "../scripts/conclude.py"


rule predict_twins:
    """How long a test can be predicted: twins that differ by no more than what is measured can tell."""
    input:
        histories=expand(
            "results/libraries/{{library}}/{solver}-histories.nc", solver=NULL_MODELS
        ),
        kernels=[kernels(solver) for solver in NULL_MODELS],
    output:
        "results/libraries/{library}/predictability.nc",
    log:
        "logs/predict_twins/{library}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        shared=LIBRARY_SOURCE,
        twins=lambda wildcards: effort().twins,
        source=source_of("predict_twins", *NULL_MODELS),
    script:
        "../scripts/predict_twins.py"


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
        gain=gain_files,
        templates=TEMPLATES,
        track_record=[TRACK_RECORD] if Path(TRACK_RECORD).exists() else [],
    output:
        html=report("reports/diagnosis-{campaign}.html", category="Diagnosis"),
        pdf=report("reports/diagnosis-{campaign}.pdf", category="Diagnosis"),
    log:
        "logs/diagnosis/{campaign}/make_diagnosis_report.log",
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
