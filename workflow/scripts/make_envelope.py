from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.ensemble import DECIMALS, figures_of_case
from blockshake.study.ensembles.envelope import envelope_of_case
from blockshake.study.ensembles.shown_samples import shown_of_case

with logging_to(snakemake.log[0]):
    params, batches, output = snakemake.params, snakemake.input.batches, snakemake.output
    envelope = envelope_of_case(batches, params.largest_drift, params.structure)
    write_dataset(output.envelope, envelope, decimals={"m": 7})
    write_dataset(output.samples, figures_of_case(batches))
    write_dataset(output.shown, shown_of_case(batches), DECIMALS)
