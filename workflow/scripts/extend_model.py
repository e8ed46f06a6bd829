import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.extended_runs import extended_runs
from blockshake.diagnosis.library_scores import load_tables, score_library
from blockshake.diagnosis.measured_readings import tamed_readings
from blockshake.diagnosis.plan import plan_diagnosis
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    plan = plan_diagnosis(snakemake.params.folder, snakemake.params.effort)
    library, scales = score_library(load_tables(snakemake.input.libraries), snakemake.params.effects)
    features = tamed_readings(scales, xr.load_dataset(snakemake.input.readings))
    runs = extended_runs(
        plan,
        snakemake.wildcards.solver,
        json.loads(Path(snakemake.input.decision).read_text()),
        library.score(features),
        library,
        features,
        snakemake.params.store,
        snakemake.params.source,
        say,
    )
    write_dataset(snakemake.output[0], runs)
