rule make_virtual_campaign:
    """The synthetic test that ships in data/: one run with parameters drawn from Table 2, seen through noisy markers.

    It is made here and copied there by hand, so that an edit of a solver does not move the data.
    """
    input:
        structure=lambda wildcards: definition(
            "structures", CASES[wildcards.case]["structure"]
        ),
        motion=lambda wildcards: definition("motions", CASES[wildcards.case]["motion"]),
        kernels=kernels("ls-dem"),
    output:
        test="results/{study}/virtual-campaign/{case}/virtual.nc",
        campaign="results/{study}/virtual-campaign/{case}/campaign.yaml",
        truth="results/{study}/virtual-truth/{case}.json",
    log:
        "logs/{study}/make_virtual_campaign/{case}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        case=lambda wildcards: CASES[wildcards.case],
        linked=lookup(dpath="ensemble/linked", within=config, default={}),
        source=source_digest(*sources.VIRTUAL_CAMPAIGN),
    script:
        "../scripts/make_virtual_campaign.py"
