from pathlib import Path

from blockshake.log import logging_to
from blockshake.virtual.generate import generate_campaign
from blockshake.virtual.settings import load_settings

with logging_to(snakemake.log[0]) as say:
    structure = snakemake.wildcards.structure
    settings = load_settings(snakemake.input.settings, structure)
    folders = Path(snakemake.output.campaign).parent, Path(snakemake.output.truth).parent
    generate_campaign(settings, structure, *folders, snakemake.params.source, say)
