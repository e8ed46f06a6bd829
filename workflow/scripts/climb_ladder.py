from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.study.config import Ladder
from blockshake.study.ensembles.ladder import climb_ladders

with logging_to(snakemake.log[0]) as say:
    of = snakemake.params
    climbed = of.cases, of.motions, of.time_step, Ladder(**of.ladder)
    write_json(snakemake.output[0], climb_ladders(*climbed, of.store, of.source, say))
