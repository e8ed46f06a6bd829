from blockshake.files import write_dataset
from blockshake.geometry.reference_block import half_width
from blockshake.log import logging_to
from blockshake.study.ensembles.ensemble import POSES, join_batches, sample_figures
from blockshake.study.ensembles.envelope import envelope_of_case

with logging_to(snakemake.log[0]):
    of, batches = snakemake.params, snakemake.input.batches
    largest_drift = of.largest_drift or half_width(of.structure)
    write_dataset(snakemake.output.envelope, envelope_of_case(batches, largest_drift), decimals={"m": 7})
    figures = sample_figures(join_batches(batches, (*POSES, "marker_displacement")))
    write_dataset(snakemake.output.samples, figures)
