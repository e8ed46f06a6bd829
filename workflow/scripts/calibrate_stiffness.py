from blockshake.files import write_dataset
from blockshake.log import logging_to
from blockshake.study.sampling.latin_hypercube import load_design, write_design
from blockshake.study.stiffness.wave_speed import calibrate_design, wave_tests

with logging_to(snakemake.log[0]):
    design = load_design(snakemake.input.design)
    of = snakemake.params
    found = calibrate_design(of.structure, design, of.linked, of.store, of.source)
    write_design(snakemake.output.stiffness, found)
    write_dataset(snakemake.output.waves, wave_tests(of.structure))
