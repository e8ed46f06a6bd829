"""Figures in the pages of docs/, written anew by the program: `make figures-of-docs`, or some of them by name.

A page holds the figures between `<!-- figures: NAME -->` and `<!-- end of figures -->`. All else is left
alone. The findings on the paper are those of the default study, and stay where `make study` has not been run.
"""

import re
import sys
import textwrap
from pathlib import Path

import numpy as np
import pandas as pd
from arrival_definitions import arrival_words, stiffness_by_definition, top_peaks
from convergence import HEADER as CONVERGENCE_HEADER
from convergence import convergence_rows
from face_impacts import THEORY_HEADER, face_impacts, replayed, theory_rows
from hollow_faces import HEADER as HOLLOW_HEADER
from hollow_faces import hollow_rows
from measured import wrapped
from recorded_lmgc90 import SPEED_HEADER, speed_rows
from schedule import measured, shares
from shear_damping import shear_damping_rows, shear_damping_words
from the_paper import HEADER, count_words, judge_statements

from blockshake.dynamics.load_motion import load_motion
from blockshake.files import load_json, write_text
from blockshake.geometry.structure import load_structure
from blockshake.pages.wording import given, number
from blockshake.simulation.simulate import simulate
from blockshake.study.calibration.section import answers_table
from blockshake.study.comparison.tables import other_settings_table
from blockshake.study.config import load_config
from blockshake.study.report.content import load_content
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
FAULTS = Path("results/faults.json")  # of `make test-faults`
_STEPS = {"nscd-rigid": 1e-3, "ls-dem": 5e-5}  # s
DEFAULT = DOCS.parent / "config" / "study.yaml"
DONE = Path("reports/study.html")
_PRICES = (0, 1, 3, 4, 7, 8)  # case, model, peak and width of the table of other settings, with their changes
_MOST_OF_A_FINDING = 110  # characters on the page
_SHOWN = 8  # rules that take most of the time


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
        return run["time"].to_numpy(), top_drift(run)

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


def content_of(study):
    """`Content` of one of the studies in config/ by its name; None where it has not been run to its end."""
    if not Path("reports", f"{study}.html").is_file():
        return None
    config = load_config(DEFAULT.with_name(f"{study}.yaml")).model_dump(mode="json")
    return load_content(config, Path("results", study))


def statements(study):
    """Findings of a study on the statements of the paper; None where it has not been run."""
    content = content_of(study)
    if content is None:
        return None
    found = judge_statements(content)
    short = [(*row[:-1], _shortened(row[-1])) for row in found]
    return "\n".join([*_study_words(content, count_words(found)), "", markdown(HEADER, short)])


def _shortened(words):
    """A finding, cut after its last sentence or item within 110 characters."""
    if len(words) <= _MOST_OF_A_FINDING:
        return words
    kept = words[:_MOST_OF_A_FINDING]
    ends = [found.end() for found in re.finditer(r"(?<=[a-z0-9%\])])\. (?=[A-Z])|; ", kept)]
    return f"{kept[: ends[-1] if ends else kept.rindex(' ')].rstrip()} ..."


def _study_words(content, *more):
    """The study that findings come from, and more sentences, in lines."""
    study, shaken = content.study, {}
    for case in content.cases.values():
        motion = f"{case.motion} at {given(case.settings['scale'])}, {given(case.settings['duration'])} s"
        shaken.setdefault(motion, []).append(case.name)
    cases = "; ".join(f"{', '.join(names)}: {motion}" for motion, names in shaken.items())
    words = (
        f"Study `{study['name']}` (blockshake {content.versions['blockshake']}): "
        f"{' '.join(study['description'].split())}. {len(content.design)} samples; {cases}."
    )
    return textwrap.wrap(" ".join([words, *more]), 100, break_on_hyphens=False)


def printed_settings():
    """Effects of the printed settings beyond their limits; None where their study has not been run."""
    content = content_of("literal")
    if content is None:
        return None
    prices = other_settings_table(content)
    header, *rows = ([row[column] for column in _PRICES] for row in (prices.header, *prices.rows))
    rows = [row for row in rows if any(_changes(cell) for cell in row)]
    count = f"{len(rows)} of {len(prices.rows)}"
    words = f"The table has {count} comparisons: in the others no change is beyond its limits."
    return "\n".join([*_study_words(content, words), "", markdown(header, rows)])


def _changes(cell):
    """Whether a cell is a change whose limits do not hold zero."""
    limits = re.search(r"\[(-?[\d.]+), (-?[\d.]+)\]", cell)
    return bool(limits) and (float(limits[1]) > 0.0 or float(limits[2]) < 0.0)


def arrival_definitions():
    """Sentences on the stiffness by the definition of a wave's arrival and by damping, and on the peaks of a stack."""
    found = stiffness_by_definition(load_structure("configuration-1"))
    return arrival_words(found, top_peaks(found))


def cost_of_samples():
    """Core hours of 1,000 samples of the default study, by model and configuration; None where it has not been run."""
    if not DONE.is_file():
        return None
    config, times = load_config(DEFAULT), measured(".", "study")
    cases = [case.name for case in config.cases]
    rows = [
        (
            model,
            f"{settings.time_step:g}",
            *(number(times["simulate_batch", (model, case)] / 3.6, 2) for case in cases),
        )
        for model, settings in config.models.items()
    ]
    return markdown(("model", "step [s]", *cases), rows)


def joint_calibration():
    """Answers of the default study's open tests; None where the study has not been run."""
    path = Path("results", "study", "calibration.json")
    if not path.is_file():
        return None
    table = answers_table(load_json(path))
    return markdown(table.header, table.rows)


def study_shares():
    """CPU time of the default study by rule; None where it has not been run."""
    if not DONE.is_file():
        return None
    found = shares(".", "study")
    total = sum(seconds for *_, seconds in found)
    rest = [sum(row[column] for row in found[_SHOWN:]) for column in (1, 2)]
    rows = [
        (rule, jobs, f"{seconds / 60.0:.1f}", f"{100.0 * seconds / total:.1f}")
        for rule, jobs, seconds in [
            *((f"`{row[0]}`", *row[1:]) for row in found[:_SHOWN]),
            ("all others", *rest),
        ]
    ]
    return markdown(("rule", "jobs", "CPU min", "share [%]"), rows)


def faults():
    """Ledger of the fault tests; None where they have not been run."""
    if not FAULTS.is_file():
        return None
    found = load_json(FAULTS)
    outcomes = ", ".join(f"{count} {name}" for name, count in found["outcomes"].items())
    words = f"Tests: {outcomes}, in {found['minutes']:.0f} min, {found['cpu_minutes']:.0f} CPU min."
    lost = {name: times for name, times in found["lost"].items() if times}
    kinds = sorted({name.partition(": ")[2] for name in found["lost"]})
    after = markdown(("lost", "times"), lost.items()) if lost else f"0 in all tests: {', '.join(kinds)}."
    return "\n\n".join([words, markdown(("done", "times"), _done_to(found["done"]).items()), wrapped(after)])


def _done_to(counts):
    """Times that a thing was done, to each work or model in one cell; ``counts`` are by "WORK: THING" or a thing."""
    cells = {}
    for name, times in counts.items():
        work, colon, done = name.partition(": ")
        cells.setdefault(done or name, []).append(f"{work} {times}" if colon else str(times))
    return {done: ", ".join(times) for done, times in sorted(cells.items())}


def _items(sentences):
    return wrapped("\n".join(f"- {one}" for one in sentences))


def faces_of_films():
    """Sentences on the faces of the filmed drops that come down; None where the films are not there."""
    found = replayed()
    return _items(found[1]) if found else None


def top_drift(run):
    """Displacement of the top block of configuration 1 relative to the slab along x [m]."""
    along = run["marker_displacement"].sel(axis="x")
    return (along.sel(marker="block-3-face") - along.sel(marker="slab-face")).to_numpy()


MAKERS = {
    "convergence": lambda: markdown(CONVERGENCE_HEADER, convergence_rows()),
    "slenderness": slenderness,
    "single-changes": single_changes,
    "statements": lambda: statements("study"),
    "printed-settings": printed_settings,
    "shear-damping": lambda: shear_damping_words(shear_damping_rows()),
    "joint-calibration": joint_calibration,
    "hollow-faces": lambda: markdown(HOLLOW_HEADER, hollow_rows()),
    "face-impact-theory": lambda: markdown(THEORY_HEADER, theory_rows()),
    "face-impacts": lambda: _items(face_impacts()[1]),
    "face-impacts-of-films": faces_of_films,
    "study-shares": study_shares,
    "arrival-definitions": arrival_definitions,
    "cost-of-samples": cost_of_samples,
    "lmgc90-speed": lambda: markdown(SPEED_HEADER, speed_rows()),
    "faults": faults,
}


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
            if name not in (names or MAKERS):
                continue
            made = MAKERS[name]()
            if made is None:
                sys.stdout.write(f"{page.name}: {name} stays, its results are not there\n")
                continue
            text = page.read_text(encoding="utf-8")
            write_text(page, text.replace(BLOCK.format(name, old), BLOCK.format(name, made)))
            sys.stdout.write(f"{page.name}: {name}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
