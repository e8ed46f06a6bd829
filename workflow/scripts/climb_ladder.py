from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.config import Ladder
from blockshake.study.ensembles.ladder import climb_ladders

with logging_to(snakemake.log[0]) as say:
    of = snakemake.params
    store = Store(of.store, of.source, say)
    climbed = climb_ladders(of.cases, of.motions, of.time_step, Ladder(**of.ladder), store)
    write_json(snakemake.output[0], climbed)
