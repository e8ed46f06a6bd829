"""What the rules of a diagnosis share: campaigns by name, their plans, and which files follow from a decision."""

import re
from functools import cache


def by_name(folders, without):
    """Folders of campaigns by the names of their results."""
    from blockshake.diagnosis.libraries.plan import result_name

    named = {result_name(folder, without): str(folder) for folder in folders}
    if len(named) < len(folders):
        refuse(
            InputError(
                "campaigns",
                ", ".join(map(str, folders)),
                "expected folders of different names",
            )
        )
    return named


EFFORT = config.get("effort", config["diagnosis"]["effort"])
WITHOUT = config.get("without", [])
if "campaign" in config:
    CAMPAIGNS = by_name([config["campaign"]], WITHOUT)
else:
    CAMPAIGNS = by_name(
        config.get("campaigns", config["diagnosis"]["campaigns"]), WITHOUT
    )
# how often the procedure was right
TRACK_RECORD = beside(HOME / "data" / "track-record" / "hidden-effects.json")
LIBRARY_SOURCE = source_of("simulate_library")  # of what both solvers share
CALIBRATION_SOURCE = source_of("calibrate_decision")


config["diagnosed"], config["diagnosis_effort"] = list(CAMPAIGNS.values()), EFFORT


def solver_source(wildcards):
    """Digest of all that a solver's simulated tests follow from: an edit of one solver reruns no other's.

    Every rule that simulates tests has it, for the store. What else it runs is in a digest of its own.
    """
    return source_of("simulate_library", wildcards.solver)


@cache
def plan(campaign):
    """Plan of a campaign by its name; made when a rule first asks, since it reads the open tests."""
    from blockshake.diagnosis.libraries.plan import plan_diagnosis

    try:
        return plan_diagnosis(CAMPAIGNS[campaign], EFFORT, WITHOUT)
    except InputError as error:
        refuse(error)


def library_names(campaign):
    """Libraries of a campaign's open tests, test by test."""
    return [
        plan(campaign).library(test, LIBRARY_SOURCE) for test in plan(campaign).tests
    ]


def library_files(campaign, kind="{solver}.nc"):
    """Files of these libraries by both solvers, test by test."""
    return expand(
        f"results/libraries/{{library}}/{kind}",
        library=library_names(campaign),
        solver=NULL_MODELS,
    )


def calibration_file(wildcards):
    """Calibration of a campaign's libraries together."""
    name = plan(wildcards.campaign).calibration(CALIBRATION_SOURCE)
    return f"results/libraries/calibrations/{name}.json"


def calibration_libraries(wildcards):
    """Libraries that a calibration is made of: those of the first campaign that has it."""
    for campaign in CAMPAIGNS:
        if plan(campaign).calibration(CALIBRATION_SOURCE) == wildcards.calibration:
            return library_files(campaign)
    refuse(
        InputError(
            "calibration",
            wildcards.calibration,
            f"expected that of one of {', '.join(CAMPAIGNS.values())}",
        )
    )


def considered_effects():
    """Names of the effects that are considered."""
    from blockshake.diagnosis.libraries.plan import considered

    return considered(WITHOUT)


def effort():
    """Amounts of simulation. The plan is no source of a rule: its numbers are in names of files and in parameters."""
    from blockshake.diagnosis.libraries.efforts import EFFORTS

    return EFFORTS[EFFORT]


def test_files(campaign, role):
    """What describes a campaign, and the files of its tests that are sealed or that are judged by."""
    given = load_campaign(CAMPAIGNS[campaign])
    if role == "sealed":
        tests = [test for test in given.tests.values() if test.role == "sealed"]
    else:
        tests = [given.tests[name] for name in plan(campaign).tests]
    files = [given.folder / "campaign.yaml", Path(given.structure)]
    for test in tests:
        path = given.folder / test.file
        files += [
            path,
            path.with_name(f"{path.stem}-acc.csv"),
            given.folder / test.motion,
        ]
    return [str(path) for path in files if path.is_file()]


def sealed_motions(campaign):
    """Files of the motions that were commanded in the sealed tests, which are no readings."""
    given = load_campaign(CAMPAIGNS[campaign])
    motions = [test.motion for test in given.tests.values() if test.role == "sealed"]
    paths = [given.folder / motion for motion in motions]
    paths += [Path(definition("motions", motion)) for motion in motions]
    return sorted({str(path) for path in paths if path.is_file()})


def decided(wildcards):
    """Decision on the physical causes of a campaign; asks for it first."""
    from blockshake.diagnosis.inference.decision import Decision, load_result

    path = checkpoints.decide.get(campaign=wildcards.campaign).output.decision
    try:
        return load_result(Decision, path)
    except InputError as error:
        refuse(error)


def further_files(wildcards):
    """More draws with the first cause by both solvers, test by test."""
    decision = decided(wildcards)
    if not decision.causes:
        path = f"results/diagnosis/{wildcards.campaign}/decision.json"
        refuse(InputError(path, "causes", "expected a cause to simulate"))
    key = decision.first_key
    return library_files(wildcards.campaign, f"{{solver}}/{key}.nc")


def cause_files(wildcards):
    """These draws, or none where a described force extends the model."""
    return further_files(wildcards) if decided(wildcards).causes else []


def size_files(wildcards):
    """The size of the first cause and its hash, where there is one and the effort has further draws for it."""
    causes = decided(wildcards).causes
    further = causes and plan(wildcards.campaign).effort.further_draws
    names = ["size.json", "frozen-size.json"] if further else []
    return expand(f"results/diagnosis/{wildcards.campaign}/{{name}}", name=names)


def extended_files(wildcards):
    """Extended ensembles by both solvers, where a physical cause was found or described."""
    decision = decided(wildcards)
    return expand(
        f"results/diagnosis/{wildcards.campaign}/extended/{{solver}}.nc",
        solver=NULL_MODELS if decision.causes or decision.described else [],
    )


def gain_files(wildcards):
    """The gain and its scores, where there are sealed tests, and a cause that only sensors have or members to simulate one with."""
    from blockshake.diagnosis.libraries.plan import sealed_tests
    from blockshake.parity.parity import load_parity

    decision, asked = decided(wildcards), plan(wildcards.campaign)
    parity = f"results/diagnosis/{wildcards.campaign}/parity.json"
    try:
        faulty = bool(load_parity(parity).findings)
    except InputError as error:
        refuse(error)
    physical = decision.causes or decision.described
    measurable = asked.effort.members if physical else faulty
    if measurable and sealed_tests(asked.campaign):
        return expand(
            f"results/diagnosis/{wildcards.campaign}/{{name}}",
            name=["gain.json", "gain.nc"],
        )
    return []
