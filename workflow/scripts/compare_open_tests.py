from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.calibration.comparison import compare_open_tests

with logging_to(snakemake.log[0]) as say:
    of, store = snakemake.params, Store(snakemake.params.store, snakemake.params.source, say)
    compared = compare_open_tests(of.case, of.campaign, snakemake.wildcards.model, of.given, store)
    write_dataset(snakemake.output[0], compared)
