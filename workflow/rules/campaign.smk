def campaign_kernels(wildcards):
    """Mark that the kernels of the virtual campaign's model are compiled."""
    from blockshake.virtual.settings import load_settings

    return kernels(load_settings(HOME / "config" / "virtual-campaign.yaml").model)


rule make_virtual_campaign:
    """A campaign like the one that ships in data/: synthetic tests with an effect drawn by seed, and their truth.

    It is made here and copied there by hand, so that an edit of a solver does not move the data.
    """
    input:
        settings=beside(HOME / "config" / "virtual-campaign.yaml"),
        structure=lambda wildcards: definition("structures", wildcards.structure),
        kernels=campaign_kernels,
    output:
        campaign="results/virtual-campaign/{structure}/campaign.yaml",
        truth="results/virtual-truth/{structure}/truth.json",
    log:
        "logs/make_virtual_campaign/{structure}.log",
    params:
        source=source_of("make_virtual_campaign", *SOLVERS),
    script:
        "../scripts/make_virtual_campaign.py"
