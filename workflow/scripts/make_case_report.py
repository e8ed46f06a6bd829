from blockshake.log import logging_to
from blockshake.study.report.report import make_report

with logging_to(snakemake.log[0]):
    of, made = snakemake.params, snakemake.output
    make_report(of.study, of.results, made.html, made.pdf, of.case)
