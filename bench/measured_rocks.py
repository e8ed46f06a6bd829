"""Rocks that fell or stood on a shake table through the whole loop, and their part of docs/results/measured.md.

``python bench/measured_rocks.py SHARED FOLDER`` makes a campaign of each rock in SHARED/measured/granite-rocks by
``examples/measured_rocks.py``, diagnoses it as a user would, has LS-DEM simulate every fourth batch by the structure
file's model, and writes its part of the page. Runs lie in FOLDER: a killed command goes on there.
"""

import datetime
import subprocess
import sys
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from measured import PAGE, causes_in_words, made_by, put_section

import blockshake
from blockshake.diagnosis.answer.decision import load_decision
from blockshake.diagnosis.outcomes.decide import CAUSES, fell_in
from blockshake.diagnosis.outcomes.figure import plot_fragility, plot_survival
from blockshake.diagnosis.outcomes.runs import BATCH, simulate_outcomes
from blockshake.diagnosis.outcomes.section import MODELS_IN_WORDS, balanced_accuracy
from blockshake.effects.registry import title_of
from blockshake.files import load_json
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.pages.drawing import save_picture
from blockshake.sources import script_sources, source_digest
from blockshake.store import Store

ROOT = Path(__file__).parents[1]
ROCKS = ("SP1", "SP2")
TITLES = {name: title_of(name) for name in CAUSES}
_ALIKE = 0.1  # by which the peaks of a record may differ that is run again
_EVERY = 4  # batch is simulated by LS-DEM


def main(shared, folder):
    """Write the part of the page."""
    parts = [made_by()]
    parts += [_part(rock, shared / "measured" / "granite-rocks", folder) for rock in ROCKS]
    put_section("rocks", "\n\n".join(parts))


def _part(rock, source, folder):
    campaign, output = folder / rock, folder / f"{rock}-output"
    if not campaign.is_dir():
        program = ROOT / "examples" / "measured_rocks.py"
        subprocess.run([sys.executable, str(program), rock, str(source), str(campaign)], check=True)
    blockshake.diagnose(campaign, output, effort="quick")
    return part(rock, campaign, output, folder / "ls-dem", _repeats(rock, source))


def _repeats(rock, source):
    """Sentence on pairs of tests of one record at nearly the same peaks: these show what chance does."""
    tests = pd.read_csv(source / "tests.csv")
    tests = tests[tests.has_motion == 1].rename(columns={f"overturned_{rock.lower()}": "fell"})
    pairs = [
        one.fell + other.fell
        for _, record in tests.groupby("ground_motion")
        for one, other in combinations(record.itertuples(), 2)
        if abs(np.log(one.scaled_pga_g / other.scaled_pga_g)) < _ALIKE
        and abs(np.log(one.pgv_over_pga_s / other.pgv_over_pga_s)) < _ALIKE
    ]
    alike = len(pairs) - pairs.count(1)
    return (
        f"{len(pairs)} pairs of tests are of the same record at peaks within {_ALIKE:.0%}. In {alike} of them both "
        f"tests ended alike, {pairs.count(2)} of these in a fall: the others show how far chance limits every model."
    )


def part(rock, folder, output, store, repeats):
    """Lines on one rock, from the results of its diagnosis in ``output``; LS-DEM's runs are kept in ``store``."""
    campaign, verdict = load_campaign(folder), load_json(output / "verdict.json")
    decision = load_decision(output / "decision.json")
    gain = xr.load_dataset(output / "gain.nc")
    save_picture(PAGE.parent / f"{rock.lower()}-survival.png", plot_survival, gain)
    save_picture(PAGE.parent / f"{rock.lower()}-fragility.png", plot_fragility, gain)
    fell = fell_in(campaign, list(campaign.open))
    lines = [
        f"### {rock}, {datetime.date.today().isoformat()}",
        f"{len(fell)} open tests, of which {fell.sum()} ended in a fall, and {gain.sizes['test']} sealed tests, of "
        f"which {int(gain['fell'].sum())} did. The verdict: **{verdict['decision']}** ({verdict['word']}).",
        "\n".join(f"- {line}" for line in causes_in_words(decision, TITLES)) or "- no cause is named",
        "\n".join(["Caveats of the diagnosis:", "", *(f"- {line}" for line in decision.cannot_see)]),
        repeats, _scores(gain), _gains(verdict),
        f"![tests that the rock survived, and the predicted chance of a fall]({rock.lower()}-survival.png)",
        f"![share of falls over the motion's peaks]({rock.lower()}-fragility.png)",
        _other_solver(campaign, store),
    ]  # fmt: skip
    return "\n\n".join(lines)


def _scores(scores):
    fell = scores["fell"].to_numpy() == 1
    rows = [(words, scores["chance"].sel(model=model).to_numpy()) for model, words in MODELS_IN_WORDS.items()]
    rows.insert(0, ("the structure file's model, nscd-rigid", scores["simulated"].to_numpy()[0]))
    return "\n".join([
        "| model, sealed tests | right falls | false falls | missed falls | balanced accuracy | Brier score |",
        "| --- | --- | --- | --- | --- | --- |", *(_row(words, chance, fell) for words, chance in rows),
    ])  # fmt: skip


def _row(words, chance, fell):
    called = chance > 0.5
    counts = (called & fell).sum(), (called & ~fell).sum(), (~called & fell).sum()
    accuracy, brier = balanced_accuracy(chance, fell), np.mean((chance - fell) ** 2)
    return f"| {words} | {' | '.join(map(str, counts))} | {accuracy:.3f} | {brier:.3f} |"


def _gains(verdict):
    rows = ["| rival | gain in Brier score on sealed tests | interval of 90 % |", "| --- | --- | --- |"]
    for rival, words in (
        ("nominal", "undamaged models, before any outcome was known"),
        ("recalibrated", "undamaged models, weighted by the open outcomes"),
        ("discrepancy", "logistic curve, fitted to the open outcomes"),
    ):
        one = verdict["gain"][rival]
        rows.append(f"| {words} | {one['estimate']:.1%} | {one['lower']:.1%} to {one['upper']:.1%} |")
    return "\n".join(rows)


def _other_solver(campaign, store):
    """Both solvers on the structure file's model, on the tests of every fourth batch."""
    batches = range(0, -(-len(campaign.tests) // BATCH), _EVERY)
    rows = []
    for solver in ("nscd-rigid", "ls-dem"):
        kept = Store(store, source_digest(*script_sources("simulate_outcomes", solver)))
        runs = xr.concat([simulate_outcomes(campaign, batch, solver, 1, kept) for batch in batches], "test")
        lean = runs["lean"].to_numpy()[:, 0]
        done = np.isfinite(lean) | np.isposinf(lean)
        fell = fell_in(campaign, runs["test"].to_numpy().tolist())
        usual = np.degrees(np.median(lean[np.isfinite(lean)]))
        early = int(runs["settled"].to_numpy()[:, 0].sum())
        words = (
            f"{solver}, {done.sum()} tests, in {early} of which the rock moves by more than 1 % of its size before the "
            f"table does; median tilt without a fall {usual:.2g} degrees"
        )
        rows.append(_row(words, np.isposinf(lean)[done].astype(float), fell[done]))
    return "\n".join([
        f"Both solvers by the structure file's model, on all tests of every {_EVERY}th batch of {BATCH}, sealed "
        "ones with them:", "",
        "| solver | right falls | false falls | missed falls | balanced accuracy | Brier score |",
        "| --- | --- | --- | --- | --- | --- |", *rows,
    ])  # fmt: skip


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
