wildcard_constraints:
    stage=r"\d+",


rule write_so_far:
    """The study's page while it runs: stage 0 is the first case by the first model, each other one a case by all models.

    The page has the name of the report, which takes its place, and is therefore no output of this rule.
    """
    input:
        lambda wildcards: expand(
            "results/{study}/{kind}/{model}/{case}.nc",
            study=wildcards.study,
            kind=["envelopes", "samples"],
            model=MODELS if int(wildcards.stage) else MODELS[0],
            case=list(CASES)[max(int(wildcards.stage) - 1, 0)],
        ),
    output:
        touch("results/{study}/so-far/{stage}"),
    log:
        "logs/{study}/write_so_far/{stage}.log",
    priority: 1
    conda:
        "../envs/blockshake.yaml"
    params:
        study=CHECKED.model_dump(mode="json"),
        results="results/{study}",
        html="reports/{study}.html",
        source=source_of("write_so_far"),
    script:
        "../scripts/write_so_far.py"


rule make_report:
    """The study as one self-contained page and as a PDF, from the same content."""
    input:
        unpack(lambda wildcards: files_of_report()),
    output:
        html=report(
            "reports/{study}.html",
            category="Study",
            caption="../report/study.rst",
            labels={"study": "{study}", "format": "HTML"},
        ),
        pdf=report(
            "reports/{study}.pdf",
            category="Study",
            caption="../report/study.rst",
            labels={"study": "{study}", "format": "PDF"},
        ),
    log:
        "logs/{study}/make_report.log",
    benchmark:
        "logs/{study}/make_report.tsv"
    conda:
        "../envs/blockshake.yaml"
    params:
        study=CHECKED.model_dump(mode="json"),
        results="results/{study}",
        yaml_contents=yaml_contents(lambda wildcards: files_of_report()),
        source=source_of("make_report"),
    script:
        "../scripts/make_report.py"


rule make_case_report:
    """One case of the study as a page and as a PDF, from the results of this case alone."""
    input:
        unpack(lambda wildcards: files_of_report(wildcards.case)),
    output:
        html=report(
            "reports/{study}-{case}.html",
            category="Study",
            caption="../report/case.rst",
            labels={"study": "{study}", "case": "{case}", "format": "HTML"},
        ),
        pdf=report(
            "reports/{study}-{case}.pdf",
            category="Study",
            caption="../report/case.rst",
            labels={"study": "{study}", "case": "{case}", "format": "PDF"},
        ),
    log:
        "logs/{study}/make_case_report/{case}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        study=CHECKED.model_dump(mode="json"),
        case="{case}",
        results="results/{study}",
        yaml_contents=yaml_contents(lambda wildcards: files_of_report(wildcards.case)),
        source=source_of("make_case_report"),
    script:
        "../scripts/make_case_report.py"
