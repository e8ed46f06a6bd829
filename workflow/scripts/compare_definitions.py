from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.stiffness.definitions import compare_definitions

LONGEST = 6.0  # s; the first strong swings

with logging_to(snakemake.log[0]):
    of, case = snakemake.params, snakemake.params.case
    shaken = case, of.time_step, min(case["duration"], LONGEST)
    compared = compare_definitions(*shaken, of.store, of.source)
    write_dataset(snakemake.output[0], compared)
