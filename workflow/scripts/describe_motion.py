from blockshake.dynamics.describe_motion import describe_motions
from blockshake.files import write_dataset
from blockshake.log import logging_to

with logging_to(snakemake.log[0]):
    params = snakemake.params
    write_dataset(snakemake.output[0], describe_motions(params.motion, params.baseline, params.intensity))
