from pathlib import Path

from blockshake.log import logging_to
from blockshake.virtual.generate import generate_campaign
from blockshake.virtual.settings import load_settings

with logging_to(snakemake.log[0]) as say:
    generate_campaign(
        load_settings(snakemake.input.settings),
        snakemake.wildcards.structure,
        Path(snakemake.output.campaign).parent,
        Path(snakemake.output.truth).parent,
        snakemake.params.source,
        say,
    )
