from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.comparison.twins import simulate_twins
from blockshake.study.ensembles.batch import DECIMALS, batch_rows
from blockshake.study.ensembles.case_input import driving_motions

with logging_to(snakemake.log[0]) as say:
    of, given, model = snakemake.params, snakemake.input, snakemake.wildcards.model
    row = batch_rows("000-000", given.design, given.stiffness)
    run = of.settings, of.output_rate, row, of.linked, of.store, of.source, say
    twins = simulate_twins(of.case, driving_motions(of.case, given.base, of.seed), model, *run)
    write_dataset(snakemake.output[0], twins, DECIMALS)
