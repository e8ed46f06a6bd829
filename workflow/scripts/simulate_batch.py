from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.ensembles.batch import (
    DECIMALS,
    HALF_STEP,
    SAMPLES,
    TWIN,
    CaseRuns,
    batch_rows,
    samples_of,
    simulate_samples,
)
from blockshake.study.ensembles.case_input import driving_motions
from blockshake.study.ensembles.ensemble import join_batches

with logging_to(snakemake.log[0]) as say:
    params, input, runs = snakemake.params, snakemake.input, CaseRuns(**snakemake.params.runs)
    motions = driving_motions(runs.case, input.base, params.seed)
    batch, store = snakemake.wildcards.batch, Store(params.store, params.source, say)
    rows = batch_rows(batch, input)
    files = simulate_samples(runs, motions, rows, store, input.base, TWIN if batch == HALF_STEP else SAMPLES)
    write_dataset(snakemake.output[0], join_batches(samples_of(files, rows)), DECIMALS)
