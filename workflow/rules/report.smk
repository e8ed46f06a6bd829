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
