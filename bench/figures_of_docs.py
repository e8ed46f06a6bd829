"""Figures in the pages of docs/, written anew by the program: `make figures-of-docs`, or some of them by name.

A page holds the figures between `<!-- figures: NAME -->` and `<!-- end of figures -->`. All else is left
alone.
"""

import re
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

from blockshake.dynamics.load_motion import load_motion
from blockshake.files import write_text
from blockshake.geometry.structure import load_structure
from blockshake.report.document.wording import number
from blockshake.report.study.convergence_section import numbers_table
from blockshake.simulation.simulate import simulate
from blockshake.study.convergence.convergence import study_convergence
from blockshake.study.convergence.settings import Convergence
from blockshake.study.sampling.distributions import LINKED, TABLE_2
from blockshake.study.sampling.sample_parameters import sample_parameters
from blockshake.study.stiffness.wave_speed import calibrate_stiffness, stiffness_parameters

DOCS = Path(__file__).parents[1] / "docs"
BLOCK = "<!-- figures: {} -->\n{}\n<!-- end of figures -->"
_CONCRETE = ("friction.concrete.concrete", "friction.concrete.foundation")
_CHANGES = {
    "friction 0.60": dict.fromkeys(_CONCRETE, 0.60),
    "friction 0.90": dict.fromkeys(_CONCRETE, 0.90),
    "density + 8 %": {"materials.concrete.density": 1.08 * 2400.0},
    "Young's modulus + 15 %": {"materials.concrete.youngs_modulus": 1.15 * 3.45e10},
    "viscous modulus + 15 %": {"materials.concrete.viscous_modulus": 1.15 * 1.5e8},
    "friction 0.25": dict.fromkeys(_CONCRETE, 0.25),
    "friction 0.12": dict.fromkeys(_CONCRETE, 0.12),
}
_STEPS = {"nscd-rigid": 1e-3, "ls-dem": 5e-5}  # s


def convergence():
    """Table of LS-DEM's numerical parameters."""
    with tempfile.TemporaryDirectory() as store:
        found = study_convergence(Convergence(structure="configuration-1"), store, "", lambda line: None)
    table = numbers_table(found)
    return markdown(table.header, table.rows)


def slenderness():
    """Width over height of all that stands on each joint of the single stacks."""
    rows = []
    for name in ("configuration-1", "configuration-2"):
        structure = load_structure(name)
        (block,) = {body.shape for body in structure.file.bodies if not body.driven}
        width, _, height = structure.file.shapes[block].box
        count = int((~structure.driven).sum())
        rows.append((name, ", ".join(f"{width / (height * above):.2f}" for above in range(count, 0, -1))))
    return markdown(("structure", "b/h of the blocks above each joint, from the lowest joint up"), rows)


def single_changes():
    """Largest difference of the top block from the nominal run, by the change of one variable."""
    structure, motion = load_structure("configuration-1"), load_motion("basso-tirreno", 2.25)
    tower = load_structure("configuration-2")
    nominal = {name: one.mean for name, one in TABLE_2.items()}

    def drift(changed, model):
        row = pd.Series({**nominal, **changed})
        parameters = sample_parameters(row, structure, LINKED)
        if model == "ls-dem":
            of_tower = sample_parameters(row, tower, LINKED)
            parameters |= stiffness_parameters(calibrate_stiffness(tower, of_tower))
        run = simulate(
            structure, motion, model, parameters, time_step=_STEPS[model], duration=12.0, accelerometers=False
        )
        along = run["marker_displacement"].sel(axis="x")
        return along["time"].to_numpy(), (
            along.sel(marker="block-3-face") - along.sel(marker="slab-face")
        ).to_numpy()

    usual = {model: drift({}, model) for model in _STEPS}
    rows = []
    for words, changed in _CHANGES.items():
        cells = []
        for model in _STEPS:
            time, moved = drift(changed, model)
            away = 1e3 * np.abs(moved - usual[model][1])
            cells += [number(away[time <= end].max(), 2) for end in (3.0, 12.0)]
        rows.append((words, *cells))
    heads = [f"{name}, {span} [mm]" for name in ("NSCD", "LS-DEM") for span in ("first 3 s", "12 s")]
    return markdown(("change", *heads), rows)


MAKERS = {"convergence": convergence, "slenderness": slenderness, "single-changes": single_changes}


def markdown(header, rows):
    """A table of a page."""
    cells = [header, ["---"] * len(header), *rows]
    return "\n".join(f"| {' | '.join(map(str, row))} |" for row in cells)


def blocks(page):
    """Figures of a page by their names, as they stand there."""
    pattern = re.escape(BLOCK).replace(r"\{\}", "(.*?)")
    return dict(re.findall(pattern, page.read_text(encoding="utf-8"), flags=re.DOTALL))


def main(names):
    """Make the figures of these names, all where none is given, and write them to their pages."""
    for page in sorted(DOCS.rglob("*.md")):
        for name, old in blocks(page).items():
            if name in (names or MAKERS):
                text = page.read_text(encoding="utf-8")
                write_text(page, text.replace(BLOCK.format(name, old), BLOCK.format(name, MAKERS[name]())))
                sys.stdout.write(f"{page.name}: {name}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
