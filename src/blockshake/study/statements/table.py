"""The statements of Zhou et al. (2023) that a study decides, in the order of the paper, each with its judge.

Statements that no study decides, and the departures from the paper, are tables of docs/results/the-paper.md.
"""

from functools import partial

from blockshake.study.statements import (
    calibration,
    envelopes,
    measured_tests,
    models,
    rocking,
    solvers,
    stiffness,
)
from blockshake.study.statements.statement import Statement

_SAMPLES = "results/{study}/samples/ls-dem/{case}.nc"
_NSCD_SAMPLES = "results/{study}/samples/nscd-rigid/{case}.nc"
_ENVELOPE = "results/{study}/envelopes/ls-dem/{case}.nc"
_SENSITIVITY = "results/{study}/sensitivities/ls-dem/{case}.nc"
_NSCD_SENSITIVITY = "results/{study}/sensitivities/nscd-rigid/{case}.nc"
_COMPARISON = "results/{study}/comparisons/ls-dem/{case}.nc"
_OF_MODEL = "results/{{study}}/comparisons/{}/{{case}}.nc"
_STIFFNESS = "results/{study}/stiffness/{case}.csv"
_DESIGN = "results/{study}/design.json"
_OPEN_TESTS = "results/{study}/calibration.json"
_DISPLACEMENT_FIGURES = "LS-DEM Results, Figs. 11 to 14"
_LMGC90 = "LMGC90 Results, Figs. 11 to 14"
_CALIBRATION = "Model Calibration"
_NSCD = ("nscd-rigid", "nscd-elastic", "nscd-viscoelastic")

STATEMENTS = {
    "Solvers": (
        Statement(
            "LS-DEM, Eq. (6)",
            "Forces and moments drive explicit steps of one length that is stable.",
            solvers.stable_step, _SAMPLES,
        ),
        Statement(
            "LMGC90",
            "Unilateral contact, impacts and friction are solved by implicit steps, each iterated to convergence.",
            solvers.converged, _NSCD_SAMPLES,
        ),
        Statement(
            "LMGC90 and Comparison",
            "Rigid contacts need no damping to be stable, and energy can be conserved in discrete time.",
            solvers.conserves, _NSCD_SAMPLES,
        ),
        Statement(
            "Comparison", "A step of LMGC90 is long and takes much computing time.", solvers.dear_steps,
            _NSCD_SAMPLES,
        ),
    ),
    "Measured tests": (
        Statement(
            "Case Study", "The table shakes along one axis.", measured_tests.along_one_axis,
            "results/{study}/inputs/{case}.nc",
        ),
        Statement(
            _CALIBRATION, "The tests with the largest accelerations are simulated.", measured_tests.strongest_tests,
            "blockshake check CAMPAIGN",
        ),
    ),
    "Samples and friction": (
        Statement(
            f"{_CALIBRATION}, Table 2, Fig. 8",
            "Nine log-normal variables with the means and variations of the table are sampled.",
            calibration.table_2, _DESIGN,
        ),
        Statement(
            _CALIBRATION, "A Latin hypercube with controlled correlation draws the samples.",
            calibration.correlation_control, _DESIGN,
        ),
        Statement(_CALIBRATION, "Each set has 50 samples.", calibration.size, _DESIGN),
        Statement(
            "Model Calibration and Conclusion", "Estimates from so few samples vary little.",
            calibration.low_variability, _ENVELOPE,
        ),
        Statement(
            _CALIBRATION, "The mean friction of concrete on concrete is searched from 0.3 to 0.8.",
            calibration.friction_range, _OPEN_TESTS,
        ),
        Statement(
            f"{_CALIBRATION}, Table 2", "A mean of 0.75 is the best.", calibration.optimum, _OPEN_TESTS,
        ),
    ),
    "Contact stiffness and damping": (
        Statement(
            _CALIBRATION, "The distributions of k_n and k_s need not follow those of E and G.",
            stiffness.follow_moduli, _STIFFNESS,
        ),
        Statement(
            _CALIBRATION, "Heavier blocks need a larger stiffness.", stiffness.heavier_blocks, _STIFFNESS,
        ),
        Statement(
            _CALIBRATION, "A moderate damping with C_res 0.5 is needed because k_n is large.", stiffness.restitution,
            "results/{study}/calibration.json",
        ),
    ),
    "Results of LS-DEM": (
        Statement(
            _DISPLACEMENT_FIGURES, "Envelopes grow thicker from block to block upward.",
            partial(envelopes.upward, model="ls-dem"), _SENSITIVITY,
        ),
        Statement(
            _DISPLACEMENT_FIGURES, "At the top, configurations 2 to 4 have thicker envelopes than configuration 1.",
            partial(envelopes.than_first, model="ls-dem"), _SENSITIVITY,
        ),
        Statement(
            _DISPLACEMENT_FIGURES,
            "At the top, configuration 4 has a thicker envelope than configuration 3, perhaps by its beams.",
            partial(envelopes.fourth_than_third, model="ls-dem"), _SENSITIVITY,
        ),
        Statement(
            "LS-DEM Results", "Configuration 1, the lowest, has the fewest occurrences of rocking and slide-rocking.",
            rocking.occurrences, _SAMPLES,
        ),
        Statement(
            "LS-DEM Results",
            "Blocks that rock or slide can depend heavily on friction, density and stiffness.",
            envelopes.parameters_matter, _SENSITIVITY,
        ),
    ),
    "Results of LMGC90": (
        Statement(
            _LMGC90, "Viscoelastic blocks are nearest to the tests of all configurations.", models.best_model,
            _OF_MODEL.format("nscd-viscoelastic"),
        ),
        Statement(
            _LMGC90, "Elastic blocks are satisfactory for configurations 1 and 2 and deviate much for 3 and 4.",
            partial(models.satisfactory, model="nscd-elastic", fits=(1, 2), fails=(3, 4)),
            _OF_MODEL.format("nscd-elastic"),
        ),
        Statement(
            _LMGC90, "Runs by elastic blocks deviate more from each other in configurations 3 and 4.",
            partial(envelopes.walls_than_stacks, model="nscd-elastic"), _NSCD_SENSITIVITY,
        ),
        Statement(
            _LMGC90, "Rigid blocks are satisfactory for all configurations.",
            partial(models.satisfactory, model="nscd-rigid", fits=(1, 2, 3, 4)), _OF_MODEL.format("nscd-rigid"),
        ),
        Statement(
            _LMGC90, "With each kind of block, more complicated structures have thicker envelopes.",
            partial(envelopes.with_structure, models=_NSCD), _NSCD_SENSITIVITY,
        ),
    ),
    "Comparison and conclusion": (
        Statement(
            "Comparison and Discussion and Conclusion", "Both models resemble the tests closely.",
            models.resemblance, _COMPARISON,
        ),
        Statement(
            "Conclusion", "The two models behave alike.", models.alike, _ENVELOPE,
        ),
        Statement(
            "LS-DEM Results and Conclusion", "There is more rocking or sliding in configurations 3 and 4.",
            rocking.complicated, _SAMPLES,
        ),
        Statement(
            "Conclusion", "Residual displacements scatter most in configuration 4.", envelopes.residuals,
            _ENVELOPE,
        ),
        Statement(
            "Comparison and Discussion",
            "Rotations are small and cannot easily be read from the tests because of noise.",
            models.rotations, _SAMPLES,
        ),
    ),
}  # fmt: skip
"""By heading of the report."""
