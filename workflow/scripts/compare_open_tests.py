from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.calibration.comparison import compare_open_tests

with logging_to(snakemake.log[0]) as say:
    of = snakemake.params
    asked = of.case, of.campaign, snakemake.wildcards.model, of.given, of.store, say
    write_dataset(snakemake.output[0], compare_open_tests(*asked))
