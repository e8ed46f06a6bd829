from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.study.friction.search import calibrate_case

with logging_to(snakemake.log[0]) as say:
    of, base = snakemake.params, snakemake.input.base
    found = calibrate_case(of.case, of.measured, base, of.given, of.store, say)
    write_json(snakemake.output[0], found)
