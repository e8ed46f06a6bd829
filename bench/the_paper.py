"""Statements of Zhou et al. (2023) that a finished study decides, for docs/results/the-paper.md.

A judge takes the `Content` of a study to a verdict and the numbers that it rests on: true where the study finds or does
the same, false where it does not, None where it cannot tell. Statements that no study decides are a table of the page.
"""

from dataclasses import replace

from paper_computation import (
    conserves,
    converged,
    correlation_control,
    dear_steps,
    follow_moduli,
    heavier_blocks,
    low_variability,
    size,
    stable_step,
    table_2,
)
from paper_results import (
    FIRST,
    FOURTH,
    SECOND,
    STACKS_AND_WALLS,
    THIRD,
    alike,
    complicated,
    occurrences,
    parameters_matter,
    thicker,
    upward,
    with_structure,
)

from blockshake.pages.wording import model_label
from blockshake.simulation.models import MODELS

HEADER = ("Place", "Statement of the paper", "Verdict", "Finding")
VERDICTS = {True: "met", False: "not met", None: "cannot be judged"}
_SOFT, _RIGID, _ELASTIC, _VISCOELASTIC = "ls-dem", "nscd-rigid", "nscd-elastic", "nscd-viscoelastic"
_FIGURES = "Results, Figs. 11 to 14"
_CALIBRATION = "Model Calibration"
# place, claim in the words of this program, judge, and the models without which no study decides it
STATEMENTS = (
    ("LS-DEM, Eq. (6)", "Forces and moments drive explicit steps of one length that is stable.",
     stable_step, _SOFT),
    ("LMGC90",
     "Unilateral contact, impacts and friction are solved by implicit steps, each iterated to convergence.",
     converged, _RIGID),
    ("LMGC90 and Comparison",
     "Rigid contacts need no damping to be stable, and energy can be conserved in discrete time.",
     conserves, _RIGID),
    ("Comparison", "A step of LMGC90 is long and takes much computing time.", dear_steps, _SOFT, _RIGID),
    (f"{_CALIBRATION}, Table 2, Fig. 8",
     "Nine log-normal variables with the means and variations of the table are sampled.", table_2),
    (_CALIBRATION, "A Latin hypercube with controlled correlation draws the samples.", correlation_control),
    (_CALIBRATION, "Each set has 50 samples.", size),
    ("Model Calibration and Conclusion", "Estimates from so few samples vary little.", low_variability),
    (_CALIBRATION, "The distributions of k_n and k_s need not follow those of E and G.", follow_moduli, _SOFT),
    (_CALIBRATION, "Heavier blocks need a larger stiffness.", heavier_blocks, _SOFT),
    (f"LS-DEM {_FIGURES}", "Envelopes grow thicker from block to block upward.", upward, _SOFT),
    (f"LS-DEM {_FIGURES}", "At the top, configurations 2 to 4 have thicker envelopes than configuration 1.",
     thicker(_SOFT, [(FIRST, other) for other in (SECOND, THIRD, FOURTH)]), _SOFT),
    (f"LS-DEM {_FIGURES}",
     "At the top, configuration 4 has a thicker envelope than configuration 3, perhaps by its beams.",
     thicker(_SOFT, [(THIRD, FOURTH)]), _SOFT),
    ("LS-DEM Results", "Configuration 1, the lowest, has the fewest occurrences of rocking and slide-rocking.",
     occurrences, _SOFT),
    ("LS-DEM Results", "Blocks that rock or slide can depend heavily on friction, density and stiffness.",
     parameters_matter, _SOFT),
    (f"LMGC90 {_FIGURES}", "Runs by elastic blocks deviate more from each other in configurations 3 and 4.",
     thicker(_ELASTIC, STACKS_AND_WALLS), _ELASTIC),
    (f"LMGC90 {_FIGURES}", "With each kind of block, more complicated structures have thicker envelopes.",
     with_structure, _RIGID, _ELASTIC, _VISCOELASTIC),
    ("Conclusion", "The two models behave alike.", alike, _SOFT, _RIGID),
    ("LS-DEM Results and Conclusion", "There is more rocking or sliding in configurations 3 and 4.", complicated),
)  # fmt: skip


def judge_statements(content):
    """Rows of text under `HEADER`, of a study of the paper's structures by its models of plain names."""
    models = {name: settings for name, settings in content.study["models"].items() if name in MODELS}
    content = replace(content, study={**content.study, "models": models})
    rows = []
    for place, claim, judge, *needed in STATEMENTS:
        lacking = [model_label(model) for model in needed if model not in models]
        holds, words = (None, f"This study has no {' and no '.join(lacking)}.") if lacking else judge(content)
        rows.append((place, claim, VERDICTS[None if holds is None else bool(holds)], words))
    return rows


def count_words(rows):
    """How many statements have which verdict, in a sentence."""
    verdicts = [row[2] for row in rows]
    counts = ", ".join(f"{verdicts.count(one)} {one}" for one in VERDICTS.values())
    return f"Of {len(verdicts)} statements: {counts}."
