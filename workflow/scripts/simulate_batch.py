from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.ensembles.batch import DECIMALS, batch_rows, simulate_samples
from blockshake.study.ensembles.case_input import driving_motions
from blockshake.study.ensembles.ensemble import join_batches

with logging_to(snakemake.log[0]) as say:
    of, given, model = snakemake.params, snakemake.input, snakemake.wildcards.model
    rows = batch_rows(snakemake.wildcards.batch, given.design, given.stiffness)
    run = of.settings, of.output_rate, rows, of.linked, of.store, of.source, say
    finished = simulate_samples(of.case, driving_motions(of.case, given.base, of.seed), model, *run)
    write_dataset(snakemake.output[0], join_batches(finished), DECIMALS)
