from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.limit_states.limit_states import limit_states_of_case

with logging_to(snakemake.log[0]):
    given, of = snakemake.input, snakemake.params
    found = limit_states_of_case(given.batches, of.case, given.base, of.linked, of.limits, of.seed)
    write_dataset(snakemake.output[0], found)
