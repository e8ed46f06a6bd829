"""Whether the sizes of a plan hold: effects as large as their limit, and half as large, hidden in made campaigns.

``python hidden_effects/measure_limits.py --plan DIR/plan.json --structure two-blocks --output results/limits`` makes
campaigns of the tests of `case_plan.PLAN` with every effect of the plan, at the place of its limit and with its usual
other parameters, diagnoses each and counts in how many the effect is named or in the set. The plan has to be one of the
same structure and motions.
"""

import argparse
import json
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from make_case import make_case, structure_file
from measure_track_record import ENVIRONMENT, Log

from blockshake.diagnosis import steps
from blockshake.diagnosis.answer.places import EVERYWHERE, place_name
from blockshake.effects.registry import EFFECTS
from blockshake.files import load_json
from blockshake.geometry.structure import load_structure
from blockshake.statistics.intervals import share_interval

SHARES = {1.0: "0.8 to 0.95", 0.5: "below 0.3"}  # of the limit, and the share that should be found
_FIRST_SEED = 440_000


def planned_causes(plan, structure, share):
    """A cause of every effect that the plan sees, with the size of a share of its limit, as of `true_causes`."""
    causes = []
    for name, one in plan["effects"].items():
        limit, effect = one["limits"].get(one["place"]), EFFECTS[name]
        if limit is None:
            continue
        first, *others = effect.parameters
        body = one["place"].partition("@")[0]
        place = next(
            place for place in effect.places(structure)
            if one["place"] == EVERYWHERE or one["place"] == place_name(place) or body == place.get("body")
        )  # fmt: skip
        values = {first.name: first.null + share * (limit - first.null)} | {
            other.name: other.null for other in others
        }
        causes.append({"name": name, "values": values, "place": place, "size": share})
    return causes


def _found(folder, structure, job):
    """The job's effect and share, and whether it is named or in the set."""
    cause, seed = job
    case = folder / f"{cause['name']}-{cause['size']:g}-{seed}"
    make_case(
        seed, [cause["name"]], "large", case / "campaign", case / "truth", False, structure, causes=[cause]
    )
    decision = steps.decide(str(case / "campaign"), ()).decision
    return {
        "effect": cause["name"], "share": cause["size"], "seed": seed, "decision": decision.decision,
        "found": cause["name"] in {one.name for one in decision.causes},
    }  # fmt: skip


def main(arguments):
    """Make, diagnose and count, as the command line states."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plan", type=Path, required=True, help="of `blockshake plan-campaign`")
    parser.add_argument("--structure", default="two-blocks", help="file of `structures`, without its suffix")
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--seeds", type=int, default=4, help="campaigns of each effect and size")
    parser.add_argument("--cores", type=int, default=os.cpu_count())
    asked = parser.parse_args(arguments)
    plan, log = load_json(asked.plan), Log(asked.output / "log.jsonl")
    structure = load_structure(structure_file(asked.structure))
    jobs = [
        (cause, _FIRST_SEED + number)
        for number in range(asked.seeds)
        for share in SHARES
        for cause in planned_causes(plan, structure, share)
    ]
    with ProcessPoolExecutor(asked.cores, get_context("spawn")) as pool:
        results = []
        for result in pool.map(partial(_found, asked.output, asked.structure), jobs):
            results.append(result)
            log("case", **result)
    for share, goal in SHARES.items():
        for name in (*plan["effects"], None):
            hits = [
                one["found"] for one in results if one["share"] == share and name in (None, one["effect"])
            ]
            if hits:
                lower, upper = share_interval(sum(hits), len(hits))
                words = f"{share:g} of the limit, {name or 'all'}: {sum(hits)} of {len(hits)} found"
                sys.stdout.write(
                    f"{words} ({lower:.2f} to {upper:.2f}), goal {goal if name is None else ''}\n"
                )
    (asked.output / "limits.json").write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    os.environ.update(ENVIRONMENT)
    main(sys.argv[1:])
