"""What the simulation of measured tests gets wrong, the cause, the extended model and its gain.

Libraries and calibrations are named by their content: equal structures, motions and sensors have equal ones, whatever
campaign they are of, so that a second campaign simulates nothing but its own extension.
"""

import json
import re
from functools import cache


def by_name(folders, without):
    """Folders of campaigns by the names of their results."""
    from blockshake.diagnosis.plan import result_name

    named = {result_name(folder, without): str(folder) for folder in folders}
    if len(named) < len(folders):
        sys.exit("blockshake: expected campaigns in folders of different names")
    return named


DIAGNOSIS = config.get("diagnosis") or {}
EFFORT = config.get("effort", DIAGNOSIS.get("effort", "standard"))
WITHOUT = config.get("without", [])
if "campaign" in config:
    CAMPAIGNS = by_name([config["campaign"]], WITHOUT)
else:
    CAMPAIGNS = by_name(
        config.get("campaigns", DIAGNOSIS.get("campaigns", [])), WITHOUT
    )
LICENCE = "data/licence/hidden-effects.json"  # how often the procedure was right
LIBRARY_SOURCE = source_digest(*sources.LIBRARY)
CALIBRATION_SOURCE = source_digest(*sources.CALIBRATION)
DIAGNOSIS_SOURCE = source_digest(*sources.DIAGNOSIS)


config["diagnosed"], config["diagnosis_effort"] = list(CAMPAIGNS.values()), EFFORT


@cache
def plan(campaign):
    """Plan of a campaign by its name; made when a rule first asks, since it reads the open tests."""
    from blockshake.diagnosis.plan import plan_diagnosis

    try:
        return plan_diagnosis(CAMPAIGNS[campaign], EFFORT, WITHOUT)
    except InputError as error:
        print(f"blockshake: {error}", file=sys.stderr, flush=True)
        os._exit(2)


def library_names(campaign):
    """Libraries of a campaign's open tests, test by test."""
    return [
        plan(campaign).library(test, LIBRARY_SOURCE) for test in plan(campaign).tests
    ]


def library_files(campaign, kind="{solver}.nc"):
    """Files of these libraries by both solvers, test by test."""
    return expand(
        "results/libraries/{library}/" + kind,
        library=library_names(campaign),
        solver=SOLVERS,
    )


def calibration_libraries(wildcards):
    """Libraries that a calibration is made of: those of the first campaign that has it."""
    for campaign in CAMPAIGNS:
        if plan(campaign).calibration(CALIBRATION_SOURCE) == wildcards.calibration:
            return library_files(campaign)
    raise ValueError(f"no campaign has the calibration {wildcards.calibration}")


def considered_effects():
    """Names of the effects that are considered."""
    from blockshake.diagnosis.plan import considered

    return considered(WITHOUT)


def test_files(campaign, role):
    """What describes a campaign, and the files of its tests that are sealed or that are judged by."""
    given = load_campaign(CAMPAIGNS[campaign])
    if role == "sealed":
        tests = [test for test in given.tests.values() if test.role == "sealed"]
    else:
        tests = [given.tests[name] for name in plan(campaign).tests]
    files = [given.folder / "campaign.yaml", Path(given.structure)]
    for test in tests:
        path = given.folder / test.file
        files += [
            path,
            path.with_name(f"{path.stem}-acc.csv"),
            given.folder / test.motion,
        ]
    return [str(path) for path in files if path.is_file()]


wildcard_constraints:
    campaign="|".join(map(re.escape, CAMPAIGNS)) or "none",
    solver="|".join(SOLVERS),
    library="[0-9a-f]{12}",
    calibration="[0-9a-f]{12}",


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
    benchmark:
        "benchmarks/simulate_library/{library}-{solver}.jsonl"
    conda:
        "../envs/blockshake.yaml"
    threads: 1
    resources:
        mem_mb=2000,
        runtime=480,
    params:
        source=LIBRARY_SOURCE,
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
    script:
        "../scripts/calibrate_decision.py"


rule read_measured:
    """Sensors checked against each other, their faults taken out, and the open tests read off."""
    input:
        lambda wildcards: test_files(wildcards.campaign, "open"),
    output:
        parity="results/diagnosis/{campaign}/parity.json",
        readings="results/diagnosis/{campaign}/measured.nc",
    log:
        "logs/diagnosis/{campaign}/read_measured.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        source=DIAGNOSIS_SOURCE,
    script:
        "../scripts/read_measured.py"


checkpoint decide:
    """Which effects the open tests speak for; frozen with its hash before a sealed test is opened."""
    input:
        readings=rules.read_measured.output.readings,
        libraries=lambda wildcards: library_files(wildcards.campaign),
        histories=lambda wildcards: library_files(
            wildcards.campaign, "{solver}-histories.nc"
        ),
        calibration=lambda wildcards: "results/libraries/calibrations/"
        + plan(wildcards.campaign).calibration(CALIBRATION_SOURCE)
        + ".json",
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
        effort=EFFORT,
        effects=lambda wildcards: considered_effects(),
        source=DIAGNOSIS_SOURCE,
    script:
        "../scripts/decide.py"


rule extend_model:
    """Ensembles by one solver: recalibrated on the open tests, and extended by the cause, for sealed tests too."""
    input:
        frozen="results/diagnosis/{campaign}/frozen.json",
        decision="results/diagnosis/{campaign}/decision.json",
        readings=rules.read_measured.output.readings,
        libraries=lambda wildcards: library_files(wildcards.campaign),
        kernels=lambda wildcards: kernels(wildcards.solver),
    output:
        "results/diagnosis/{campaign}/extended/{solver}.nc",
    log:
        "logs/diagnosis/{campaign}/extend_model/{solver}.log",
    benchmark:
        "benchmarks/diagnosis/{campaign}/extend_model/{solver}.jsonl"
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        effects=lambda wildcards: considered_effects(),
        store="results/store/diagnosis",
        source=LIBRARY_SOURCE,
        judged_by=DIAGNOSIS_SOURCE,
    script:
        "../scripts/extend_model.py"


def decided(wildcards):
    """Physical causes of a campaign and whether its sensors have a fault; asks for the decision first."""
    files = checkpoints.decide.get(**wildcards).output
    parity = f"results/diagnosis/{wildcards.campaign}/parity.json"
    causes = json.loads(Path(files.decision).read_text())["causes"]
    return causes, bool(json.loads(Path(parity).read_text())["findings"])


def extended_files(wildcards):
    """Extended ensembles by both solvers, where a physical cause was found."""
    causes, _ = decided(wildcards)
    return expand(
        f"results/diagnosis/{wildcards.campaign}/extended/{{solver}}.nc",
        solver=SOLVERS if causes else [],
    )


def gain_file(wildcards):
    """The gain, where a cause was found, there are sealed tests and the effort has members to predict them with."""
    from blockshake.diagnosis.plan import sealed_tests

    causes, faulty = decided(wildcards)
    asked = plan(wildcards.campaign)
    measurable = (causes and asked.effort.members) or (faulty and not causes)
    if measurable and sealed_tests(asked.campaign):
        return f"results/diagnosis/{wildcards.campaign}/gain.json"
    return []


rule measure_gain:
    """What naming the cause gains on the sealed tests, against three rivals: the one rule that reads them."""
    input:
        frozen="results/diagnosis/{campaign}/frozen.json",
        decision="results/diagnosis/{campaign}/decision.json",
        readings=rules.read_measured.output.readings,
        libraries=lambda wildcards: library_files(wildcards.campaign),
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
        effort=EFFORT,
        source=DIAGNOSIS_SOURCE,
    script:
        "../scripts/measure_gain.py"


rule conclude:
    """The verdict: sensors, decision and gain put together."""
    input:
        parity=rules.read_measured.output.parity,
        decision="results/diagnosis/{campaign}/decision.json",
        misfit="results/diagnosis/{campaign}/misfit.nc",
        gain=gain_file,
    output:
        "results/diagnosis/{campaign}/verdict.json",
    log:
        "logs/diagnosis/{campaign}/conclude.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        effort=EFFORT,
        source=DIAGNOSIS_SOURCE,
    script:
        "../scripts/conclude.py"


rule predict_twins:
    """How long a test can be predicted: twins that differ by no more than what is measured can tell."""
    input:
        histories=expand(
            "results/libraries/{{library}}/{solver}-histories.nc", solver=SOLVERS
        ),
        kernels=[kernels(solver) for solver in SOLVERS],
    output:
        "results/libraries/{library}/predictability.nc",
    log:
        "logs/predict_twins/{library}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        library=LIBRARY_SOURCE,
        source=DIAGNOSIS_SOURCE,
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
                "measured.nc",
                "decision.json",
                "misfit.nc",
                "evidence.nc",
                "frozen.json",
                "verdict.json",
            ],
        ),
        gain=gain_file,
        horizons=lambda wildcards: [
            f"results/libraries/{name}/predictability.nc"
            for name in library_names(wildcards.campaign)
        ],
        templates=expand(
            "src/blockshake/report/templates/{name}",
            name=["report.html.j2", "report.typ"],
        ),
        licence=[LICENCE] if Path(LICENCE).exists() else [],
    output:
        html=report("reports/diagnosis-{campaign}.html", category="Diagnosis"),
        pdf=report("reports/diagnosis-{campaign}.pdf", category="Diagnosis"),
    log:
        "logs/diagnosis/{campaign}/make_diagnosis_report.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        folder=lambda wildcards: CAMPAIGNS[wildcards.campaign],
        results="results/diagnosis/{campaign}",
        effort=EFFORT,
        licence=LICENCE,
        source=source_digest(*sources.REPORT, *sources.DIAGNOSIS),
    script:
        "../scripts/make_diagnosis_report.py"
