from blockshake.files import write_dataset
from blockshake.geometry.structure import load_structure
from blockshake.log import logging_to
from blockshake.measurement.markers import driven_marker
from blockshake.study.batch import batch_rows, simulate_samples
from blockshake.study.ensemble import gather_ensemble

with logging_to(snakemake.log[0]) as say:
    case = snakemake.params.case
    rows = batch_rows(snakemake.wildcards.batch, snakemake.input.design, snakemake.input.stiffness)
    runs = simulate_samples(
        case,
        snakemake.wildcards.model,
        snakemake.params.time_step,
        snakemake.params.output_rate,
        rows,
        snakemake.params.linked,
        snakemake.params.store,
        snakemake.params.source,
        say,
    )
    batch = gather_ensemble(runs, rows.index, rows, driven_marker(load_structure(case["structure"])))
    write_dataset(snakemake.output[0], batch, decimals=7)
