from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.ensemble import DECIMALS, figures_of_case
from blockshake.study.ensembles.envelope import envelope_of_case
from blockshake.study.ensembles.shown_samples import shown_of_case

with logging_to(snakemake.log[0]):
    of, batches, made = snakemake.params, snakemake.input.batches, snakemake.output
    envelope = envelope_of_case(batches, of.largest_drift, of.structure)
    write_dataset(made.envelope, envelope, decimals={"m": 7})
    write_dataset(made.samples, figures_of_case(batches))
    write_dataset(made.shown, shown_of_case(batches), DECIMALS)
