import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.extended_runs import extended_runs
from blockshake.diagnosis.library_scores import load_tables
from blockshake.diagnosis.measured_readings import tamed_readings
from blockshake.diagnosis.plan import plan_diagnosis
from blockshake.diagnosis.size_of_cause import library_of_cause
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    plan = plan_diagnosis(snakemake.params.folder, snakemake.params.effort)
    decision, size = (
        json.loads(Path(snakemake.input[name]).read_text()) for name in ("decision", "posterior")
    )
    library, scales = library_of_cause(
        load_tables(snakemake.input.libraries), load_tables(snakemake.input.further), size["key"]
    )
    features = tamed_readings(scales, xr.load_dataset(snakemake.input.readings))
    runs = extended_runs(
        plan,
        snakemake.wildcards.solver,
        decision,
        size,
        library,
        features,
        snakemake.params.store,
        snakemake.params.source,
        say,
    )
    write_dataset(snakemake.output[0], runs)
