rule make_report:
    """The study as one self-contained page and as a PDF, and its findings on the paper, from the same content."""
    input:
        unpack(lambda wildcards: files_of_report()),
        ladder_motions=expand(
            "results/{study}/motions/{motion}.nc", study=STUDY, motion=MOTIONS
        ),
        shipped=[
            definition("structures", f"configuration-{place}")
            for place in (1, 2, 3, 4)
        ],
    output:
        html=report("reports/{study}.html", category="Study"),
        pdf=report("reports/{study}.pdf", category="Study"),
        paper="results/{study}/the-paper.json",
    log:
        "logs/{study}/make_report.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        study=CHECKED.model_dump(mode="json"),
        results="results/{study}",
        logs="logs/{study}",
        said=said(lambda wildcards: files_of_report()),
        source=source_of("make_report"),
    script:
        "../scripts/make_report.py"


rule make_case_report:
    """One case of the study as a page and as a PDF, from the results of this case alone."""
    input:
        unpack(lambda wildcards: files_of_report(wildcards.case)),
    output:
        html=report("reports/{study}-{case}.html", category="Study"),
        pdf=report("reports/{study}-{case}.pdf", category="Study"),
    log:
        "logs/{study}/make_case_report/{case}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        study=CHECKED.model_dump(mode="json"),
        case="{case}",
        results="results/{study}",
        logs="logs/{study}",
        said=said(lambda wildcards: files_of_report(wildcards.case)),
        source=source_of("make_case_report"),
    script:
        "../scripts/make_case_report.py"
