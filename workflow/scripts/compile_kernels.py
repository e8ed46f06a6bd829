from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.simulation.simulate import compile_kernels

with logging_to(snakemake.log[0]):
    write_json(snakemake.output[0], compile_kernels(snakemake.wildcards.model))
