from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.calibration.comparison import compare_open_tests

with logging_to(snakemake.log[0]) as say:
    params, store = snakemake.params, Store(snakemake.params.store, snakemake.params.source, say)
    compared = compare_open_tests(
        params.case, params.campaign, snakemake.wildcards.model, params.study, store
    )
    write_dataset(snakemake.output[0], compared)
