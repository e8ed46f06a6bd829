from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.stiffness.definitions import compare_definitions

with logging_to(snakemake.log[0]) as say:
    of = snakemake.params
    compared = compare_definitions(of.case, of.time_step, Store(of.store, of.source, say))
    write_dataset(snakemake.output[0], compared)
