from blockshake.diagnosis.report.report import make_diagnosis_report
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    of, made = snakemake.params, snakemake.output
    make_diagnosis_report(of.folder, of.results, of.effort, of.track_record, made.html, made.pdf)
