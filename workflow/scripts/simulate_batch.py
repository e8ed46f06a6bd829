from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.ensembles.batch import DECIMALS, CaseRuns, batch_rows, simulate_samples
from blockshake.study.ensembles.case_input import driving_motions
from blockshake.study.ensembles.ensemble import join_batches

with logging_to(snakemake.log[0]) as say:
    of, runs = snakemake.params, CaseRuns(**snakemake.params.runs)
    base = snakemake.input.base
    motions = driving_motions(runs.case, base, of.seed)
    rows, store = batch_rows(snakemake.wildcards.batch, snakemake.input), Store(of.store, of.source, say)
    write_dataset(
        snakemake.output[0], join_batches(simulate_samples(runs, motions, rows, store, base)), DECIMALS
    )
