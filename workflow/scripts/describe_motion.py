from blockshake.dynamics.describe_motion import describe_motion
from blockshake.dynamics.load_motion import load_motion
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    write_dataset(snakemake.output[0], describe_motion(load_motion(snakemake.input[0]), snakemake.input[0]))
