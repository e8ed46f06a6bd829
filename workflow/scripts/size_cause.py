import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.frozen import check_frozen, freeze
from blockshake.diagnosis.library_scores import load_tables
from blockshake.diagnosis.measured_readings import tamed_readings
from blockshake.diagnosis.size_of_cause import library_of_cause, size_of_cause
from blockshake.files import write_json
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    check_frozen(snakemake.input.frozen, snakemake.input.decision)
    decision = json.loads(Path(snakemake.input.decision).read_text())
    measured = xr.load_dataset(snakemake.input.readings)
    library, scales = library_of_cause(
        load_tables(snakemake.input.libraries),
        load_tables(snakemake.input.further),
        decision["places"][decision["causes"][0]],
    )
    write_json(snakemake.output.posterior, size_of_cause(library, tamed_readings(scales, measured)))
    freeze(
        snakemake.output.frozen, snakemake.output.posterior, [str(name) for name in measured["test"].values]
    )
