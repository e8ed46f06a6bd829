from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.sampling.sample_table import load_design, write_design
from blockshake.study.stiffness.wave_speed import calibrate_design, wave_tests

with logging_to(snakemake.log[0]) as say:
    params, design = snakemake.params, load_design(snakemake.input.design)
    stiffness = calibrate_design(
        params.structure, design, params.linked, Store(params.store, params.source, say)
    )
    write_design(snakemake.output.stiffness, stiffness)
    write_dataset(snakemake.output.waves, wave_tests(params.structure))
