from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.ensembles.batch import CaseRuns, batch_rows, part_of, samples_of, simulate_samples
from blockshake.study.ensembles.case_input import driving_motions
from blockshake.study.ensembles.ensemble import DECIMALS, join_batches

with logging_to(snakemake.log[0]) as say:
    params, input, runs = snakemake.params, snakemake.input, CaseRuns(**snakemake.params.runs)
    motions, batch = driving_motions(runs.case, input.base, params.seed), snakemake.wildcards.batch
    rows, store = batch_rows(params.batch, input.stiffness), Store(params.store, params.source, say)
    files = simulate_samples(runs, motions, rows, store, input.base, part_of(batch))
    write_dataset(snakemake.output[0], join_batches(samples_of(files, rows)), DECIMALS)
