from blockshake.diagnosis.calibration import cases_as_json, library_cases
from blockshake.diagnosis.library_scores import load_tables, score_library
from blockshake.files import write_json
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    library, _ = score_library(load_tables(snakemake.input), snakemake.params.effects)
    write_json(snakemake.output[0], cases_as_json(library_cases(library, say)))
