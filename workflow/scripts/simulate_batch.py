from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.batch import DECIMALS, batch_rows, simulate_samples
from blockshake.study.ensemble import join_batches

with logging_to(snakemake.log[0]) as say:
    finished = simulate_samples(
        snakemake.params.case,
        snakemake.wildcards.model,
        snakemake.params.settings,
        snakemake.params.output_rate,
        batch_rows(snakemake.wildcards.batch, snakemake.input.design, snakemake.input.stiffness),
        snakemake.params.linked,
        snakemake.params.store,
        snakemake.params.source,
        say,
    )
    write_dataset(snakemake.output[0], join_batches(finished), DECIMALS)
