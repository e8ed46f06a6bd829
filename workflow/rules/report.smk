def files_of_report(cases):
    """Files that a report of these cases is made of, by name."""
    measured = [case for case in cases if case in MEASURED]
    motions = {Path(CASES[case]["motion"]).stem for case in cases}

    def results(pattern, **named):
        return expand(f"results/{STUDY}/{pattern}", **named)

    def by_model(kind, named):
        return results(f"{kind}/{{model}}/{{case}}.nc", model=MODELS, case=named)

    return {
        "structures": [
            definition("structures", CASES[case]["structure"]) for case in cases
        ],
        "campaigns": [file for case in measured for file in campaign_files(case)],
        "templates": TEMPLATES,
        "motions": results("motions/{motion}.nc", motion=sorted(motions)),
        "design": results("design.{suffix}", suffix=["csv", "json"]),
        "stiffness": results("stiffness/{case}.csv", case=cases),
        "waves": results("waves/{case}.nc", case=cases),
        "bases": results("inputs/{case}.nc", case=measured),
        "definitions": (
            results("stiffness-definitions.nc") if next(iter(CASES)) in cases else []
        ),
        "envelopes": by_model("envelopes", cases),
        "samples": by_model("samples", cases),
        "shown": by_model("shown", cases),
        "comparisons": by_model("comparisons", measured),
        "differences": results("differences/{case}.nc", case=cases),
        "friction": results(
            "friction/{case}.json",
            case=[case for case in FRICTION_SEARCH.get("cases", []) if case in cases],
        ),
        "sensitivities": by_model("sensitivities", cases),
    }


rule make_report:
    """The study as one self-contained page and as a PDF, and its findings on the paper, from the same content."""
    input:
        unpack(lambda wildcards: files_of_report(list(CASES))),
        ladder_motions=expand(
            "results/{study}/motions/{motion}.nc", study=STUDY, motion=MOTIONS
        ),
        shipped=[
            definition("structures", f"configuration-{place}")
            for place in (1, 2, 3, 4)
        ]
        + [beside(HOME / "config" / f"{name}.yaml") for name in ("study", "paper")],
        peer=beside(HOME / "data" / "peers" / "lmgc90.nc"),
        convergence=(
            f"results/{STUDY}/convergence.csv" if config.get("convergence") else []
        ),
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
        benchmarks="benchmarks/{study}",
        source=source_of("make_report"),
    script:
        "../scripts/make_report.py"


rule make_case_report:
    """One case of the study as a page and as a PDF, from the results of this case alone."""
    input:
        unpack(lambda wildcards: files_of_report([wildcards.case])),
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
        benchmarks="benchmarks/{study}",
        source=source_of("make_case_report"),
    script:
        "../scripts/make_case_report.py"
