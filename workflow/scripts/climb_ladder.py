from blockshake.files import write_json
from blockshake.log import logging_to
from blockshake.study.config import Ladder
from blockshake.study.ladder import climb_ladder

with logging_to(snakemake.log[0]) as say:
    ladder = Ladder(**snakemake.params.ladder)
    rungs = {}
    for case in snakemake.params.cases:
        for motion in ladder.motions:
            climbed = climb_ladder(
                case["structure"], motion, "ls-dem", snakemake.params.time_step, case["duration"], ladder
            )
            rungs.setdefault(case["structure"], {})[motion] = climbed
            say(
                f"{case['structure']} {motion}: passed {[rung['scale'] for rung in climbed if rung['passed']]}"
            )
    write_json(snakemake.output[0], rungs)
