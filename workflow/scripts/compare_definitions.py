from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.stiffness.definitions import compare_definitions

LONGEST = 6.0  # s; the first strong swings

with logging_to(snakemake.log[0]):
    case = snakemake.params.case
    compared = compare_definitions(case, snakemake.params.time_step, min(case["duration"], LONGEST))
    write_dataset(snakemake.output[0], compared)
