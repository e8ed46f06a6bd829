from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.comparison.twins import simulate_twins
from blockshake.study.ensembles.batch import DECIMALS, CaseRuns, batch_rows
from blockshake.study.ensembles.case_input import driving_motions

with logging_to(snakemake.log[0]) as say:
    of, runs = snakemake.params, CaseRuns(**snakemake.params.runs)
    motions = driving_motions(runs.case, snakemake.input.base, of.seed)
    row, store = batch_rows("000-000", snakemake.input), Store(of.store, of.source, say)
    write_dataset(snakemake.output[0], simulate_twins(runs, motions, row, store), DECIMALS)
