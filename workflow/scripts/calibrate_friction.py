from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.friction.search import calibrate_case

with logging_to(snakemake.log[0]) as say:
    of, store = snakemake.params, Store(snakemake.params.store, snakemake.params.source, say)
    answer = calibrate_case(of.case, of.measured, snakemake.input.base, of.given, store)
    write_json(snakemake.output[0], answer)
