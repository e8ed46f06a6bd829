from blockshake.log import logging_to
from blockshake.study.report.so_far import write_so_far

with logging_to(snakemake.log[0]) as say:
    if line := write_so_far(snakemake.params.study, snakemake.params.results, snakemake.params.html):
        say(line)
