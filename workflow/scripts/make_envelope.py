from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.ensemble import join_batches, sample_figures
from blockshake.study.ensembles.envelope import envelope

with logging_to(snakemake.log[0]):
    ensemble = join_batches(snakemake.input.batches)
    write_dataset(
        snakemake.output.envelope, envelope(ensemble, snakemake.params.largest_drift), decimals={"m": 7}
    )
    write_dataset(snakemake.output.samples, sample_figures(ensemble))
