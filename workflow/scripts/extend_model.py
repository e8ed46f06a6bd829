import json
from pathlib import Path

import xarray as xr

from blockshake.diagnosis.extended_runs import extended_runs
from blockshake.diagnosis.frozen import check_frozen
from blockshake.diagnosis.library_scores import load_tables, score_library
from blockshake.diagnosis.measured_readings import tamed_readings
from blockshake.diagnosis.plan import plan_diagnosis
from blockshake.diagnosis.size_of_cause import library_of_cause, without_second
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]) as say:
    check_frozen(snakemake.input.frozen, snakemake.input.decision)
    check_frozen(snakemake.input.frozen_size, snakemake.input.posterior)
    plan = plan_diagnosis(snakemake.params.folder, snakemake.params.effort)
    decision, size = (
        json.loads(Path(snakemake.input[name]).read_text()) for name in ("decision", "posterior")
    )
    tables = load_tables(snakemake.input.libraries)
    whole, scales = score_library(tables, snakemake.params.effects)
    features = tamed_readings(scales, xr.load_dataset(snakemake.input.readings))
    library, _ = library_of_cause(tables, load_tables(snakemake.input.further), size["key"])
    runs = extended_runs(
        plan,
        snakemake.wildcards.solver,
        decision,
        size,
        library,
        features,
        without_second(whole, features, decision),
        snakemake.params.store,
        snakemake.params.source,
        say,
    )
    write_dataset(snakemake.output[0], runs)
