from blockshake.dynamics.describe_motion import describe_motion
from blockshake.dynamics.load_motion import load_motion
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    definition = snakemake.input[0]
    motion = load_motion(definition, baseline=snakemake.params.baseline)
    write_dataset(snakemake.output[0], describe_motion(motion, definition))
