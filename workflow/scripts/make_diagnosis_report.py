from blockshake.log import logging_to
from blockshake.report.diagnosis_report import make_diagnosis_report

with logging_to(snakemake.log[0]):
    make_diagnosis_report(
        snakemake.params.folder,
        snakemake.params.results,
        snakemake.params.effort,
        snakemake.params.licence,
        snakemake.output.html,
        snakemake.output.pdf,
        snakemake.input.horizons,
    )
