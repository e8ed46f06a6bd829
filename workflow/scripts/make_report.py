from blockshake.log import logging_to
from blockshake.report.report import make_report

with logging_to(snakemake.log[0]):
    make_report(
        snakemake.params.study,
        snakemake.params.results,
        snakemake.params.benchmarks,
        snakemake.output.html,
        snakemake.output.pdf,
    )
