from blockshake.log import logging_to
from blockshake.study.report.report import make_report

with logging_to(snakemake.log[0]):
    params, output = snakemake.params, snakemake.output
    make_report(params.study, params.results, output.html, output.pdf)
