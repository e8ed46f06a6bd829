"""Ablation of the decision: every case decided without the laws of the joints, and without features of whole tests.

``python hidden_effects/measure_ablation.py --results results/hidden-effects`` reads the libraries and readings of a
finished track record, decides every case again in each way, and writes the shares of right and wrong answers to the
page. Nothing is simulated.
"""

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import cache, partial
from pathlib import Path

import numpy as np
from case_files import PAGE, ROOT, campaign_of, load_plan, truth_of, verdict_of
from score_figures import Scored, figures
from track_record_text import with_block

from blockshake.diagnosis.features.measured_readings import tamed_readings
from blockshake.diagnosis.inference.calibration import library_cases, load_cases
from blockshake.diagnosis.inference.decide import decide
from blockshake.diagnosis.inference.lawful_decision import with_laws
from blockshake.diagnosis.inference.library_scores import load_tables, score_library
from blockshake.diagnosis.laws.judged_laws import judge_laws
from blockshake.diagnosis.laws.measured_forces import outside_of
from blockshake.diagnosis.libraries.candidates import NOMINAL, candidates
from blockshake.diagnosis.libraries.null_model import MODELS
from blockshake.diagnosis.libraries.plan import plan_diagnosis
from blockshake.diagnosis.verdict.conclusion import Judged, conclude
from blockshake.files import load_json, write_text
from blockshake.parity.parity import load_parity
from blockshake.sources import script_sources, source_digest
from blockshake.store import load_made

LIBRARIES = ROOT / "results" / "libraries"
FEW = 2  # draws with each candidate
WAYS = {
    "features and laws": "as in the record",
    "laws alone": "no feature of a whole test",
    "features alone": "no law of a joint",
    f"{FEW} draws": f"as in the record, but {FEW} draws with each candidate",
}
_SHARES = {
    "false_alarms": "false alarms",
    "confidently_wrong": "one wrong name",
    "truth_in_set": "truth named or in the set",
    "exact_large": "truth alone named, larger size",
    "outside_unknown": "outside the registry: unknown",
    "outside_named": "outside the registry: registered name",
}


@cache
def _few(files, effects):
    """Library of scores with few draws of each candidate, its scales and its judged cases."""
    tables = [
        {name: _first(table, FEW) for name, table in by_solver.items()} for by_solver in load_tables(files)
    ]
    library, scales = score_library(tables, effects)
    return library, scales, library_cases(library)


@cache
def _whole(files, effects, calibration):
    """Library of scores with all draws, its scales and its judged cases."""
    return *score_library(load_tables(files), effects), load_cases(calibration)


def _first(table, draws):
    """Library with the first draws of each candidate."""
    kept = (table["candidate"] == NOMINAL) | (table["draw"] < draws)
    return table.isel(run=np.flatnonzero(kept.to_numpy()))


def answers(case, results, effort):
    """`Scored` of one case, by way of deciding.

    Parameters
    ----------
    case : PlannedCase
    results : Path
    effort : str

    Returns
    -------
    dict of str to Scored
    """
    plan = plan_diagnosis(campaign_of(results, case.name), effort)
    source = source_digest(*script_sources("simulate_library"))
    folders = [LIBRARIES / plan.library(test, source) for test in plan.tests]
    files = tuple(str(folder / f"{model}.nc") for folder in folders for model in MODELS)
    made = verdict_of(results, case.name).parent
    measured, parity = load_made(made / "measured.nc"), load_parity(made / "parity.json")
    structure = next(iter(plan.tests.values())).structure
    places = {one.key: one.place for one in candidates(structure)}
    findings = None
    if measured.sizes["law"]:
        draws = {
            name: np.concatenate(
                [load_made(folder / f"{model}-histories.nc")["law_value"].to_numpy() for model in MODELS]
            )
            for name, folder in zip(plan.tests, folders, strict=True)
        }
        own = {name: measured.sel(test=name) for name in plan.tests}
        findings = judge_laws(
            own, draws, outside_of(load_made(made / "forces.nc")), structure.weight_shares()
        )

    def by_features(library, scales, cases):
        return decide(library, tamed_readings(scales, measured), cases, places)

    def lawful(decision):
        return with_laws(decision, findings, places) if findings else decision

    effects = tuple(plan.effects)
    calibration = plan.calibration(source_digest(*script_sources("calibrate_decision")))
    features = by_features(*_whole(files, effects, LIBRARIES / "calibrations" / f"{calibration}.json"))
    nothing = features.model_copy(
        update={
            "decision": "none",
            "causes": (),
            "sizes": {},
            "parameters": {},
            "struck_out": {},
            "p_none": 1.0,
        }
    )
    decisions = lawful(features), lawful(nothing), features, lawful(by_features(*_few(files, effects)))
    truth = load_json(truth_of(results, case.name) / "truth.json")
    judged = Judged("", len(plan.tests))
    return {
        way: Scored(
            case.name,
            truth,
            conclude(decision, parity.findings, parity.recorder_sensors, judged, 0, [], effort),
        )
        for way, decision in zip(WAYS, decisions, strict=True)
    }


def table(scored):
    """Markdown of the shares by way; ``scored``: lists of `Scored` by way."""
    shares = {way: figures(cases)["shares"] for way, cases in scored.items()}
    rows = ["| answer | " + " | ".join(WAYS) + " |", "| --- |" + " ---: |" * len(WAYS)]
    for key, said in _SHARES.items():
        cells = (f"{shares[way][key].hits} of {shares[way][key].n}" for way in WAYS)
        rows.append(f"| {said} | " + " | ".join(cells) + " |")
    return "\n".join(rows)


def main(arguments):
    """Decide every case in each way, and write the table, as the command line says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--results", type=Path, required=True, help="folder of the cases and their verdicts")
    parser.add_argument("--page", type=Path, default=PAGE)
    parser.add_argument("--cores", type=int, default=1)
    asked = parser.parse_args(arguments)
    plan = load_plan()
    scored = {way: [] for way in WAYS}
    with ProcessPoolExecutor(asked.cores) as pool:
        judge = partial(_answers, asked.results, plan.efforts)
        for number, found in enumerate(pool.map(judge, plan.cases), start=1):
            for way, one in found.items():
                scored[way].append(one)
            sys.stdout.write(f"{number} of {len(plan.cases)} cases decided\n")
            sys.stdout.flush()
    text = table(scored)
    page = asked.page.read_text(encoding="utf-8")
    write_text(asked.page, with_block(page, "ablation", text))
    sys.stdout.write(text + "\n")


def _answers(results, efforts, case):
    return answers(case, results, efforts[case.structure])


if __name__ == "__main__":
    main(sys.argv[1:])
