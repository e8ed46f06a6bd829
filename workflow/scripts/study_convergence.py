from blockshake.log import logging_to
from blockshake.store import Store
from blockshake.study.convergence.convergence import study_convergence
from blockshake.study.convergence.settings import Convergence
from blockshake.study.convergence.table import write_convergence

with logging_to(snakemake.log[0]) as say:
    of = snakemake.params
    table = study_convergence(Convergence(**of.convergence), Store(of.store, of.source, say))
    write_convergence(snakemake.output[0], table)
