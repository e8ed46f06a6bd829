from blockshake.files import content_digest, write_json
from blockshake.log import logging_to
from blockshake.study.sampling.latin_hypercube import draw_design
from blockshake.study.sampling.sample_table import write_design

with logging_to(snakemake.log[0]):
    design = draw_design(snakemake.params.ensemble)
    write_design(snakemake.output.design, design.values)
    drawn_from = content_digest(snakemake.params.ensemble, snakemake.params.source)
    write_json(snakemake.output.summary, design.summary() | {"drawn_from": drawn_from})
