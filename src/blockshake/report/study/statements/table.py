"""The statements of Zhou et al. (2023), in the order of the paper, each with its judge: their one home."""

from functools import partial

from blockshake.report.study.statements import (
    calibration,
    envelopes,
    ls_dem,
    models,
    nscd,
    rocking,
    specimens,
    stiffness,
)
from blockshake.report.study.statements.statement import Statement, not_judged

_SAMPLES = "results/{study}/samples/ls-dem/{case}.nc"
_NSCD_SAMPLES = "results/{study}/samples/nscd-rigid/{case}.nc"
_ENVELOPE = "results/{study}/envelopes/ls-dem/{case}.nc"
_SENSITIVITY = "results/{study}/sensitivities/ls-dem/{case}.nc"
_NSCD_SENSITIVITY = "results/{study}/sensitivities/nscd-rigid/{case}.nc"
_COMPARISON = "results/{study}/comparisons/ls-dem/{case}.nc"
_OF_MODEL = "results/{{study}}/comparisons/{}/{{case}}.nc"
_STIFFNESS = "results/{study}/stiffness/{case}.csv"
_WAVES = "results/{study}/waves/{case}.nc"
_DESIGN = "results/{study}/design.json"
_OPEN_TESTS = "results/{study}/calibration.json"
_INPUT = "results/{study}/inputs/{case}.nc"
_PARAMETERS = "blockshake parameters"
_CHECK = "blockshake check configuration-4"
_DISPLACEMENT_FIGURES = "LS-DEM Results, Figs. 11 to 14"
_LMGC90 = "LMGC90 Results, Figs. 11 to 14"
_LS_DEM, _CALIBRATION = "LS-DEM", "Model Calibration"
_CASE_STUDY = "Case Study"


def _not_judged(reason):
    return partial(not_judged, reason=reason)


STATEMENTS = {
    "Level-set discrete element method": (
        Statement(
            f"{_LS_DEM}, Eq. (1), Fig. 1(a)",
            "A block is the region where a signed distance is negative; the distance is sampled every 0.02 m.",
            ls_dem.level_set, _PARAMETERS,
        ),
        Statement(
            _LS_DEM, "All blocks have one size and chamfers of 2 cm.", specimens.alike_blocks, _CHECK,
        ),
        Statement(
            f"{_LS_DEM}, Fig. 1(b)",
            "Nodes on the surface find the contacts; their spacing is about 0.2 m.",
            ls_dem.node_spacing, _PARAMETERS,
        ),
        Statement(
            f"{_LS_DEM}, Eq. (2)",
            "A spring and a dashpot act along the normal while a node is inside the other block.",
            ls_dem.normal_law, _PARAMETERS,
        ),
        Statement(
            f"{_LS_DEM}, Eq. (3)",
            "The dashpot follows from the restitution, the mass of the block and the stiffness at the node.",
            ls_dem.damping, _PARAMETERS,
        ),
        Statement(
            f"{_LS_DEM}, Eqs. (4) and (5)",
            "The shear force grows with the tangential motion, up to Coulomb's limit.",
            ls_dem.shear_law, _PARAMETERS,
        ),
        Statement(
            f"{_LS_DEM}, Eq. (6)",
            "Forces and moments drive explicit steps of one length that is stable.",
            ls_dem.stable_step, _SAMPLES,
        ),
        Statement(
            _LS_DEM, "The step is 1e-5 s.", partial(ls_dem.time_step, model="ls-dem", printed=1e-5), _SAMPLES,
        ),
    ),
    "Nonsmooth contact dynamics": (
        Statement(
            "LMGC90",
            "Unilateral contact, impacts and friction are solved by implicit steps, each iterated to convergence.",
            nscd.converged, _NSCD_SAMPLES,
        ),
        Statement(
            "LMGC90 and Comparison",
            "Rigid contacts need no damping to be stable, and energy can be conserved in discrete time.",
            nscd.conserves, _NSCD_SAMPLES,
        ),
        Statement(
            "LMGC90",
            "Implicit steps find a state of rest, which explicit ones may miss.",
            _not_judged(
                "LS-DEM and deformable blocks look for the state of rest before a run, and rigid blocks where a joint "
                "is soft: docs/method.md, docs/nscd.md."
            ),
            _PARAMETERS,
        ),
        Statement(
            "LMGC90, Fig. 2",
            "A pair of rigid blocks has at most four contact points, whatever the mesh of their surfaces.",
            nscd.four_points, _PARAMETERS,
        ),
        Statement(
            "LMGC90", "Contact areas are shrunk for safety.", nscd.shrunk, _PARAMETERS,
        ),
        Statement(
            "LMGC90", "Deformable blocks have a mesh of 0.2 m.", nscd.mesh_size, _PARAMETERS,
        ),
        Statement(
            "LMGC90", "Contacts have no restitution.", nscd.no_restitution, _PARAMETERS,
        ),
        Statement(
            "LMGC90", "The step is 1e-3 s.",
            partial(ls_dem.time_step, model="nscd-rigid", printed=1e-3), _NSCD_SAMPLES,
        ),
        Statement(
            "Comparison, Fig. 3",
            "Contact and friction laws are of finite steepness in LS-DEM and of infinite steepness in rigid LMGC90.",
            nscd.steepness, _NSCD_SAMPLES,
        ),
        Statement(
            "Comparison", "Rigid LMGC90 needs no elastic modulus, LS-DEM does.", nscd.no_modulus,
            _PARAMETERS,
        ),
        Statement(
            "Comparison", "A step of LMGC90 is long and takes much computing time.", nscd.dear_steps,
            _NSCD_SAMPLES,
        ),
    ),
    "Specimens, motions and tests": (
        Statement(
            "Fig. 4", "The four configurations are 4.8, 6.4, 7.2 and 7.4 m high and have at most nine blocks.",
            specimens.heights, _CHECK,
        ),
        Statement(
            _CASE_STUDY,
            "One wall of three and of four blocks, then two walls of four with a block on top, with beams in the last.",
            specimens.make_up, _CHECK,
        ),
        Statement(_CASE_STUDY, "The tallest specimen has about 7.6 m.", specimens.tallest, _CHECK),
        Statement(
            _CASE_STUDY, "The table shakes along one axis.", specimens.along_one_axis, _INPUT,
        ),
        Statement(
            _CASE_STUDY, "The base slab is held to the table.",
            _not_judged("No finding of a study holds the slab's markers against the table's own displacement."), _INPUT,
        ),
        Statement(
            _CASE_STUDY, "Stoppers and retaining systems are designed not to touch the results.",
            specimens.stoppers, _CHECK,
        ),
        Statement(
            "Table 1", "The two records have peaks of 1.176 and 1.585 m/s2.", specimens.peaks,
            "results/{study}/motions/basso-tirreno.nc",
        ),
        Statement(
            "Table 1", "The records are of 1981 and 1978, magnitudes 6.3 and 6, 25 and 18 km away.",
            _not_judged("Facts of earthquakes, which no result of a study bears on."),
            "results/{study}/motions/basso-tirreno.nc",
        ),
        Statement(
            _CASE_STUDY, "The two motions bound those of the standard for Geneva.",
            _not_judged("The standard is that of another work, and no result of a study bears on it."),
            "results/{study}/motions/basso-tirreno.nc",
        ),
        Statement(
            "Fig. 5", "Histories of the two records.", specimens.records,
            "results/{study}/motions/basso-tirreno.nc",
        ),
        Statement(
            _CASE_STUDY, "Tests start at 50 % and rise by about 25 % until a structure may collapse.",
            specimens.ladder, _ENVELOPE,
        ),
        Statement(
            _CASE_STUDY, "A specimen that is out of place is restored before the next level.",
            _not_judged("Each simulated run starts from the stack as built; the real places are not published."),
            "results/{study}/ladder.json",
        ),
        Statement(
            _CASE_STUDY, "Sinusoidal tests of low intensity tell the dynamic properties and the damage.",
            specimens.low_tests, "blockshake modes CAMPAIGN --output modes.json",
        ),
        Statement(
            f"{_CASE_STUDY}, Figs. 6 and 7",
            "Up to 21 accelerometers, 4 displacement transducers and 101 markers read the specimens.",
            specimens.instruments, _CHECK,
        ),
        Statement(
            _CASE_STUDY, "The table's control system gives further readings.",
            _not_judged("A campaign may hold the table's displacement; no result of a study rests on it."), _CHECK,
        ),
        Statement(
            _CASE_STUDY, "Accelerations are read at 512 Hz and filtered at 50 Hz, displacements at 200 Hz.",
            specimens.rates, _PARAMETERS,
        ),
    ),
    "Samples and friction": (
        Statement(
            f"{_CALIBRATION}, Table 2, Fig. 8",
            "Nine log-normal variables with the means and variations of the table are sampled.",
            calibration.table_2, _DESIGN,
        ),
        Statement(
            f"{_CALIBRATION}, Table 2",
            "Most parameters are those of the literature, in which the friction of concrete varies too much.",
            _not_judged("The literature is that of other works, and no result of a study bears on it."), _DESIGN,
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
            _CALIBRATION, "Hertz's theory does not give the stiffness between blocks.",
            _not_judged("No result of a study bears on Hertz's theory: faces meet here, and it is not used."),
            _WAVES,
        ),
        Statement(
            f"{_CALIBRATION}, Eqs. (7) and (8)",
            "The speed of waves in the tower is matched to the root of a modulus over the density.",
            stiffness.wave_speeds, _WAVES,
        ),
        Statement(
            f"{_CALIBRATION}, Fig. 9", "Blocks have no waves in them, and contacts delay the motion of higher ones.",
            stiffness.delayed, _WAVES,
        ),
        Statement(
            f"{_CALIBRATION}, Fig. 9",
            "The speed is read once all blocks of a tower of four have a similar velocity.",
            stiffness.similar_velocity, _WAVES,
        ),
        Statement(
            f"{_CALIBRATION}, Fig. 9", "The matched wave speed approximates the stiffness.", stiffness.definitions,
            "results/{study}/stiffness-definitions.nc",
        ),
        Statement(
            f"{_CALIBRATION}, Fig. 10", "Histograms of the stiffness of the samples.", stiffness.histograms,
            _STIFFNESS,
        ),
        Statement(
            _CALIBRATION, "The distributions of k_n and k_s need not follow those of E and G.",
            stiffness.follow_moduli, _STIFFNESS,
        ),
        Statement(
            _CALIBRATION, "Heavier blocks need a larger stiffness.", stiffness.heavier_blocks, _STIFFNESS,
        ),
        Statement(
            _CALIBRATION, "A moderate damping with C_res 0.5 is needed because k_n is large.", stiffness.restitution,
            "results/{study}/stiffness-definitions.nc",
        ),
        Statement(
            _CALIBRATION, "That C_res lies in the range of Harmon et al. (2022).",
            _not_judged("The range is that of another paper, and no result of a study bears on it."), _PARAMETERS,
        ),
        Statement(
            _CALIBRATION, "The tests with the largest accelerations are simulated.", specimens.strongest_tests,
            "blockshake check CAMPAIGN",
        ),
        Statement(
            _CALIBRATION, "The measured displacement of the base slab drives the models.", specimens.measured_input,
            _INPUT,
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
            "LS-DEM Results", "The onset of rocking goes with the ratio of height to width (Shenton 1996).",
            _not_judged(
                "No study varies the ratio alone. The example of one block holds its onset against theory: "
                "examples/rocking_block.py."
            ),
            "results/{study}/ladder.json",
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
            partial(envelopes.with_structure, models=("nscd-rigid", *nscd.DEFORMABLE)), _NSCD_SENSITIVITY,
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
            "LMGC90 Results and Comparison",
            "More complicated structures oscillate more, and residuals of some simulations vary.",
            _not_judged("The paper counts no oscillations and names no measure of them or of the variation."),
            _ENVELOPE,
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
        Statement(
            "Comparison and Discussion and Conclusion",
            "One test is one realization of a stochastic system.",
            _not_judged("No test of a campaign here is a repetition of another, so that no result tells its scatter."),
            _COMPARISON,
        ),
        Statement(
            "Conclusion",
            "The calibrated models can stand for other, larger structures, and help to design resistant ones.",
            _not_judged("The study holds no test of another structure that the models were not calibrated with."),
            _COMPARISON,
        ),
        Statement(
            "Conclusion", "Virtual experiments give forces, damage and kinematic fields.",
            _not_judged(
                "Runs hold the forces, openings and slips of the joints and the motion of the bodies; none of the "
                "models knows damage."
            ),
            _SAMPLES,
        ),
        Statement(
            "Conclusion", "The procedure serves any discrete system and any numerical model.",
            _not_judged("The study is of the paper's own structures; other ones are in examples/."),
            "blockshake check STRUCTURE",
        ),
        Statement(
            "Data Availability Statement", "The measured data are those of CERN and not public.",
            _not_judged("A campaign of your own takes the place of the synthetic one: docs/campaigns.md."),
            "blockshake check CAMPAIGN",
        ),
    ),
}  # fmt: skip
"""By heading of the report."""
