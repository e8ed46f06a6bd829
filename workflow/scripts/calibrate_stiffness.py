from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.ensembles.batch import batch_rows
from blockshake.study.sampling.sample_table import write_design
from blockshake.study.stiffness.wave_speed import calibrate_design, wave_tests

with logging_to(snakemake.log[0]) as say:
    params = snakemake.params
    rows, store = batch_rows(params.samples, None), Store(params.store, params.source, say)
    stiffness = calibrate_design(params.structure, rows, params.linked, store)
    write_design(snakemake.output.stiffness, stiffness)
    write_dataset(snakemake.output.waves, wave_tests(params.structure))
