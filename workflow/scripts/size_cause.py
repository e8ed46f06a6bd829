import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.frozen import check_frozen, freeze
from blockshake.diagnosis.library_scores import load_tables, score_library
from blockshake.diagnosis.measured_readings import tamed_readings
from blockshake.diagnosis.size_of_cause import library_of_cause, size_of_cause, without_second
from blockshake.files import write_json
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    check_frozen(snakemake.input.frozen, snakemake.input.decision)
    decision = json.loads(Path(snakemake.input.decision).read_text())
    measured = xr.load_dataset(snakemake.input.readings)
    tables = load_tables(snakemake.input.libraries)
    whole, scales = score_library(tables, snakemake.params.effects)
    features = without_second(whole, tamed_readings(scales, measured), decision)
    library, _ = library_of_cause(
        tables, load_tables(snakemake.input.further), decision["places"][decision["causes"][0]]
    )
    write_json(snakemake.output.posterior, size_of_cause(library, features))
    freeze(
        snakemake.output.frozen, snakemake.output.posterior, [str(name) for name in measured["test"].values]
    )
