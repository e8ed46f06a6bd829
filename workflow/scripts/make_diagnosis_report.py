from blockshake.diagnosis.report.report import make_diagnosis_report
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    params, output = snakemake.params, snakemake.output
    make_diagnosis_report(
        params.folder, params.results, params.effort, params.track_record, output.html, output.pdf
    )
