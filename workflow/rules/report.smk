rule make_report:
    """The study as one self-contained page and as a PDF, and its findings on the paper, from the same content."""
    input:
        structures=[
            definition("structures", case["structure"]) for case in CASES.values()
        ],
        campaigns=[campaign_files(case) for case in MEASURED],
        shipped=[
            definition("structures", f"configuration-{place}")
            for place in (1, 2, 3, 4)
        ]
        + [beside(HOME / "config" / f"{name}.yaml") for name in ("study", "paper")],
        peer=beside(HOME / "data" / "peers" / "lmgc90.nc"),
        templates=expand(
            beside(PACKAGE / "report" / "document" / "templates" / "{name}"),
            name=["report.html.j2", "report.typ"],
        ),
        motions=expand(
            "results/{study}/motions/{motion}.nc", study=STUDY, motion=MOTIONS
        ),
        design=f"results/{STUDY}/design.csv",
        design_summary=f"results/{STUDY}/design.json",
        stiffness=expand(
            "results/{study}/stiffness/{case}.csv", study=STUDY, case=CASES
        ),
        waves=expand("results/{study}/waves/{case}.nc", study=STUDY, case=CASES),
        bases=expand("results/{study}/inputs/{case}.nc", study=STUDY, case=MEASURED),
        convergence=(
            f"results/{STUDY}/convergence.csv" if config.get("convergence") else []
        ),
        definitions=f"results/{STUDY}/stiffness-definitions.nc",
        envelopes=expand(
            "results/{study}/envelopes/{model}/{case}.nc",
            study=STUDY,
            model=MODELS,
            case=CASES,
        ),
        samples=expand(
            "results/{study}/samples/{model}/{case}.nc",
            study=STUDY,
            model=MODELS,
            case=CASES,
        ),
        comparisons=expand(
            "results/{study}/comparisons/{model}/{case}.nc",
            study=STUDY,
            model=MODELS,
            case=MEASURED,
        ),
        differences=expand(
            "results/{study}/differences/{case}.nc", study=STUDY, case=CASES
        ),
        friction=expand(
            "results/{study}/friction/{case}.json",
            study=STUDY,
            case=FRICTION_SEARCH.get("cases", []),
        ),
        sensitivities=expand(
            "results/{study}/sensitivities/{model}/{case}.nc",
            study=STUDY,
            model=MODELS,
            case=CASES,
        ),
    output:
        html=report("reports/{study}.html", category="Study"),
        pdf=report("reports/{study}.pdf", category="Study"),
        paper="results/{study}/the-paper.json",
    log:
        "logs/{study}/make_report.log",
    benchmark:
        "benchmarks/{study}/make_report.jsonl"
    conda:
        "../envs/blockshake.yaml"
    params:
        study=CHECKED.model_dump(mode="json"),
        results="results/{study}",
        benchmarks="benchmarks/{study}",
        source=source_of("make_report"),
    script:
        "../scripts/make_report.py"
