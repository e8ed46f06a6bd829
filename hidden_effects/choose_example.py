"""Gain of the oracle on the shipped stack, effect by effect: by it the effect of the shipped campaigns was chosen.

``python hidden_effects/choose_example.py --output results/example --cores 2`` makes a campaign for every effect of the
registry that acts in a simulation, at its visible size and where the shipped seed puts it, and for every joint made
slippery. It writes the gains of the true effects on the responses of the sealed tests into the page of the shipped
campaigns. No test is diagnosed.
"""

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from case_files import ROOT
from oracle_gain import ORACLE, tests_of_models
from track_record_text import with_block

from blockshake.diagnosis.gain.response_gain import gain_over_nominal
from blockshake.effects.registry import EFFECTS, with_effect
from blockshake.files import content_digest
from blockshake.geometry.structure import load_structure
from blockshake.measurement.campaigns.campaign import load_campaign
from blockshake.sources import script_sources, source_digest
from blockshake.virtual.generate import generate_campaign
from blockshake.virtual.settings import Hidden, load_settings
from blockshake.virtual.truth import hidden_effect

SETTINGS, STRUCTURE = ROOT / "config" / "virtual-campaign.yaml", "configuration-2"
PAGE = ROOT / "data" / "virtual-campaign" / "SOURCE.md"
TIME_STEP = 1e-4  # s, of config/study.yaml: a tenth of the work
SLIPPERY = 0.12  # on the friction of a joint: the blocks above it slide before they rock
_JOINTS = ("slab", "block-1"), ("block-1", "block-2"), ("block-2", "block-3"), ("block-3", "block-4")


@dataclass(frozen=True)
class TrueEffect:
    """Change of an `Experiment` by the effect that a campaign hides, in its own form and size."""

    effect: dict

    @property
    def digest(self):
        """Digest of all that the change follows from."""
        return content_digest(ORACLE, self.effect)

    def __call__(self, experiment):
        """The experiment with the effect in it."""
        return with_effect(experiment, **self.effect)


def candidates():
    """`Hidden` of every effect that acts in a simulation at its visible size, and of every joint made slippery."""
    for name, effect in EFFECTS.items():
        if effect.acts != "observation":
            yield Hidden(effect=name, values={item.name: item.visible for item in effect.parameters})
    for joint in _JOINTS:
        yield Hidden(effect="weak-joint", values={"factor": SLIPPERY}, place={"joint": joint})


def oracle_of(hidden, output):
    """The effect and its `Contrast` on the sealed tests of its campaign; None where nothing is there to gain."""
    settings = load_settings(SETTINGS).model_copy(update={"hidden": hidden, "time_step": TIME_STEP})
    folder = output / f"{hidden.effect}-{content_digest(hidden.model_dump(mode='json'))[:6]}"
    source = source_digest(*script_sources("simulate_nominal", settings.model))
    generate_campaign(settings, STRUCTURE, folder / "campaign", folder / "truth", source, lambda line: None)
    effect = hidden_effect(hidden, load_structure(STRUCTURE), settings.seed)
    true = TrueEffect(effect)
    campaign = load_campaign(folder / "campaign")
    tests = tests_of_models(
        campaign, campaign.sealed, {ORACLE: lambda name, draw: true}, (), output / "store"
    )
    return effect, gain_over_nominal(tests, ORACLE)


def table(found):
    """Lines of a table of effects and their gains, the surest gain first."""
    found = sorted(found, key=lambda one: one[1].lower if one[1] else -1.0, reverse=True)
    header = "| effect | place | size | oracle's gain on responses |", "| --- | --- | --- | --- |"
    return "\n".join([*header, *(_row(*one) for one in found)])


def _row(effect, gain):
    size, *_ = EFFECTS[effect["name"]].parameters
    places = [names if isinstance(names, list) else [names] for names in effect["place"].values()]
    place = ", ".join("-".join(names) for names in places)
    unit = "" if size.unit == "1" else f" {size.unit}"
    words = f"{gain.estimate:.2f} [{gain.lower:.2f}, {gain.upper:.2f}]" if gain else "nothing to gain"
    return f"| `{effect['name']}` | {place} | {effect['values'][size.name]:g}{unit} | {words} |"


def main():
    """Measure, print the table and write it into the page."""
    parser = argparse.ArgumentParser(prog="choose_example", description=__doc__.partition("\n")[0])
    parser.add_argument("--output", type=Path, default=Path("results/example"))
    parser.add_argument("--cores", type=int, default=1)
    given = parser.parse_args()
    with ProcessPoolExecutor(given.cores, mp_context=get_context("spawn")) as pool:
        text = table(pool.map(partial(oracle_of, output=given.output), candidates()))
    PAGE.write_text(with_block(PAGE.read_text(encoding="utf-8"), "figures", text), encoding="utf-8")
    sys.stdout.write(f"{text}\n")


if __name__ == "__main__":
    main()
