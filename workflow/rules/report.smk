def files_of_report(only=None):
    """Files that the report of the study, or of one of its cases, is made of, by name."""
    cases = [only] if only else list(CASES)
    motions = {Path(CASES[case]["motion"]).stem for case in cases}
    folder = f"results/{STUDY}"
    return {
        "structures": [
            definition("structures", CASES[case]["structure"]) for case in cases
        ],
        "campaigns": [
            file
            for case in cases
            if CASES[case]["measured"]
            for file in campaign_files(case)
        ],
        "templates": TEMPLATES,
        "motions": [f"{folder}/motions/{motion}.nc" for motion in sorted(motions)],
        "design": [f"{folder}/design.{suffix}" for suffix in ("csv", "json")],
        **{
            analysis.name: [
                f"{folder}/{file}" for file in analysis.files(config, only).values()
            ]
            for analysis in ANALYSES
        },
    }


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
    params:
        study=CHECKED.model_dump(mode="json"),
        results="results/{study}",
        logs="logs/{study}",
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
    params:
        study=CHECKED.model_dump(mode="json"),
        case="{case}",
        results="results/{study}",
        logs="logs/{study}",
        source=source_of("make_case_report"),
    script:
        "../scripts/make_case_report.py"
