from blockshake.diagnosis.steps import conclude
from blockshake.diagnosis.verdict.verdict import write_verdict
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    write_verdict(
        snakemake.output[0], conclude(snakemake.params.folder, snakemake.params.runs, snakemake.input)
    )
