"""The statements of Zhou et al. (2023) that a study decides, in the order of the paper, each with its judge.

Statements that no study decides, and the departures from the paper, are tables of docs/results/the-paper.md.
"""

from functools import partial

from blockshake.study.statements import inputs, models, responses, solvers
from blockshake.study.statements.responses import FIRST, FOURTH, SECOND, STACKS_AND_WALLS, THIRD
from blockshake.study.statements.statement import Statement

_FIGURES = "Results, Figs. 11 to 14"
_CALIBRATION = "Model Calibration"
_LS_DEM, _RIGID = ("ls-dem",), ("nscd-rigid",)
_NSCD = ("nscd-rigid", "nscd-elastic", "nscd-viscoelastic")

STATEMENTS = {
    "Solvers": (
        Statement(
            "LS-DEM, Eq. (6)",
            "Forces and moments drive explicit steps of one length that is stable.",
            solvers.stable_step, _LS_DEM,
        ),
        Statement(
            "LMGC90",
            "Unilateral contact, impacts and friction are solved by implicit steps, each iterated to convergence.",
            solvers.converged,
        ),
        Statement(
            "LMGC90 and Comparison",
            "Rigid contacts need no damping to be stable, and energy can be conserved in discrete time.",
            solvers.conserves, _RIGID,
        ),
        Statement(
            "Comparison", "A step of LMGC90 is long and takes much computing time.", solvers.dear_steps,
            _LS_DEM + _RIGID,
        ),
    ),
    "Measured tests": (
        Statement(
            "Case Study", "The table shakes along one axis.", inputs.along_one_axis, measured=True,
        ),
        Statement(
            _CALIBRATION, "The tests with the largest accelerations are simulated.", inputs.strongest_tests,
            measured=True,
        ),
    ),
    "Samples and friction": (
        Statement(
            f"{_CALIBRATION}, Table 2, Fig. 8",
            "Nine log-normal variables with the means and variations of the table are sampled.",
            inputs.table_2,
        ),
        Statement(
            _CALIBRATION, "A Latin hypercube with controlled correlation draws the samples.",
            inputs.correlation_control,
        ),
        Statement(_CALIBRATION, "Each set has 50 samples.", inputs.size),
        Statement(
            "Model Calibration and Conclusion", "Estimates from so few samples vary little.", inputs.low_variability,
        ),
        Statement(
            _CALIBRATION, "The mean friction of concrete on concrete is searched from 0.3 to 0.8.",
            inputs.friction_range,
        ),
        Statement(f"{_CALIBRATION}, Table 2", "A mean of 0.75 is the best.", inputs.optimum),
    ),
    "Contact stiffness and damping": (
        Statement(
            _CALIBRATION, "The distributions of k_n and k_s need not follow those of E and G.", inputs.follow_moduli,
        ),
        Statement(_CALIBRATION, "Heavier blocks need a larger stiffness.", inputs.heavier_blocks),
        Statement(
            _CALIBRATION, "A moderate damping with C_res 0.5 is needed because k_n is large.", inputs.restitution,
        ),
    ),
    "Results of LS-DEM": (
        Statement(
            f"LS-DEM {_FIGURES}", "Envelopes grow thicker from block to block upward.",
            partial(responses.upward, model="ls-dem"), _LS_DEM,
        ),
        Statement(
            f"LS-DEM {_FIGURES}", "At the top, configurations 2 to 4 have thicker envelopes than configuration 1.",
            partial(
                responses.thicker_tops, model="ls-dem", pairs=[(FIRST, other) for other in (SECOND, THIRD, FOURTH)]
            ),
            _LS_DEM,
        ),
        Statement(
            f"LS-DEM {_FIGURES}",
            "At the top, configuration 4 has a thicker envelope than configuration 3, perhaps by its beams.",
            partial(responses.thicker_tops, model="ls-dem", pairs=[(THIRD, FOURTH)]), _LS_DEM,
        ),
        Statement(
            "LS-DEM Results", "Configuration 1, the lowest, has the fewest occurrences of rocking and slide-rocking.",
            responses.occurrences, _LS_DEM,
        ),
        Statement(
            "LS-DEM Results",
            "Blocks that rock or slide can depend heavily on friction, density and stiffness.",
            responses.parameters_matter, _LS_DEM,
        ),
    ),
    "Results of LMGC90": (
        Statement(
            f"LMGC90 {_FIGURES}", "Viscoelastic blocks are nearest to the tests of all configurations.",
            models.best_model, _NSCD, measured=True,
        ),
        Statement(
            f"LMGC90 {_FIGURES}",
            "Elastic blocks are satisfactory for configurations 1 and 2 and deviate much for 3 and 4.",
            partial(models.satisfactory, model="nscd-elastic", fails=(THIRD, FOURTH)), ("nscd-elastic",),
            measured=True,
        ),
        Statement(
            f"LMGC90 {_FIGURES}", "Runs by elastic blocks deviate more from each other in configurations 3 and 4.",
            partial(responses.thicker_tops, model="nscd-elastic", pairs=STACKS_AND_WALLS), ("nscd-elastic",),
        ),
        Statement(
            f"LMGC90 {_FIGURES}", "Rigid blocks are satisfactory for all configurations.",
            partial(models.satisfactory, model="nscd-rigid"), _RIGID, measured=True,
        ),
        Statement(
            f"LMGC90 {_FIGURES}", "With each kind of block, more complicated structures have thicker envelopes.",
            partial(responses.with_structure, models=_NSCD), _NSCD,
        ),
    ),
    "Comparison and conclusion": (
        Statement(
            "Comparison and Discussion and Conclusion", "Both models resemble the tests closely.",
            models.resemblance, measured=True,
        ),
        Statement("Conclusion", "The two models behave alike.", models.alike, _LS_DEM + _RIGID),
        Statement(
            "LS-DEM Results and Conclusion", "There is more rocking or sliding in configurations 3 and 4.",
            responses.complicated,
        ),
        Statement("Conclusion", "Residual displacements scatter most in configuration 4.", responses.residuals),
        Statement(
            "Comparison and Discussion",
            "Rotations are small and cannot easily be read from the tests because of noise.",
            models.rotations,
        ),
    ),
}  # fmt: skip
"""By heading of the report."""
