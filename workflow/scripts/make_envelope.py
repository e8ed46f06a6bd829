from blockshake.files import write_dataset
from blockshake.geometry.reference_block import half_width
from blockshake.log import logging_to
from blockshake.study.ensembles.ensemble import POSES, join_batches, sample_figures
from blockshake.study.ensembles.envelope import envelope

with logging_to(snakemake.log[0]):
    ensemble = join_batches(snakemake.input.batches, POSES)
    of = snakemake.params
    largest_drift = of.largest_drift or half_width(of.structure)
    write_dataset(snakemake.output.envelope, envelope(ensemble, largest_drift), decimals={"m": 7})
    write_dataset(snakemake.output.samples, sample_figures(ensemble))
