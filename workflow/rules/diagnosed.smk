"""What the rules of a diagnosis share: campaigns by name, their plans, and which files follow from a decision."""

import re


def by_name(folders, without):
    """Folders of campaigns by the names of their results; refuses to leave an effect out that does not exist."""
    from blockshake.diagnosis.nominal.plan import considered, result_name

    named = {result_name(folder, without): str(folder) for folder in folders}
    with refusing():
        considered(without)
        if len(named) < len(folders):
            given = ", ".join(map(str, folders))
            raise InputError("campaigns", given, "expected folders of different names")
    return named


def given_campaigns():
    """Folders of campaigns: those of the command line as typed, else those of the configuration.

    Snakemake makes a number of a folder named by digits, and 202411 of 2024_11.
    """
    settings = workflow.config_settings
    typed = dict(entry.split("=", 1) for entry in settings.config_args or ())
    if "campaign" in config:
        folder = settings.config.get("campaign", config["campaign"])
        return [folder if isinstance(folder, str) else typed["campaign"].strip("'\"")]
    folders = settings.config.get("campaigns", config["diagnosis"]["campaigns"])
    return folders if isinstance(folders, (list, tuple)) else [folders]


EFFORT = config.get("effort", config["diagnosis"]["effort"])
WITHOUT = config.get("without", [])
CAMPAIGNS = by_name(given_campaigns(), WITHOUT)
# models that the null hypothesis of a diagnosis holds
NULL_MODELS = [name for name, model in SOLVERS.items() if model.perturbation]
# how often the procedure was right
TRACK_RECORD = beside(HOME / "data" / "track-record" / "hidden-effects.json")


def solver_source(wildcards):
    """Digest of all that a solver's simulated tests follow from: an edit of one solver reruns no other's.

    Every rule that simulates tests has it, for the store. What else it runs is in a digest of its own.
    """
    return source_of("simulate_nominal", wildcards.solver)


@cache
def plan(campaign):
    """Plan of a campaign by its name; made when a rule first asks, since it reads the open tests."""
    from blockshake.diagnosis.nominal.plan import plan_diagnosis

    with refusing():
        return plan_diagnosis(CAMPAIGNS[campaign], EFFORT)


def ensemble_files(campaign, solvers=NULL_MODELS):
    """Nominal ensembles of a campaign's open tests, test by test; none at an effort that simulates nothing."""
    return expand(
        "results/diagnosis/{campaign}/ensembles/{number}-{solver}.nc",
        campaign=campaign,
        number=range(len(plan(campaign).simulated)),
        solver=solvers,
    )


def clean_files(campaign):
    """Evidence by chance of a campaign's open tests, by solver; none where no motion is known."""
    return expand(
        "results/diagnosis/{campaign}/clean/{solver}.json",
        campaign=campaign,
        solver=NULL_MODELS if plan(campaign).clean else [],
    )


def misfit_files(wildcards):
    """The misfit, at an effort that simulates anything."""
    simulated = plan(wildcards.campaign).simulated
    return [f"results/diagnosis/{wildcards.campaign}/misfit.nc"] if simulated else []


def effort():
    """Amounts of simulation. The plan is no source of a rule: its numbers are in parameters."""
    from blockshake.diagnosis.nominal.plan import EFFORTS

    return EFFORTS[EFFORT]


def test_files(campaign, role):
    """What describes a campaign, and the files of its tests that are sealed or that are judged by."""
    with refusing():
        loaded = load_campaign(CAMPAIGNS[campaign])
    names = loaded.sealed if role == "sealed" else plan(campaign).open
    return files_of_tests(loaded, [loaded.tests[name] for name in names])


def outcome_files(campaign):
    """Simulated outcomes of all tests, batch by batch, of a campaign of outcomes; else none."""
    from blockshake.diagnosis.outcomes.runs import BATCH, solvers_of

    with refusing():
        loaded = load_campaign(CAMPAIGNS[campaign])
    batches = -(-len(loaded.tests) // BATCH) if loaded.kind.batches else 0
    return expand(
        f"results/diagnosis/{campaign}/outcomes/{{number}}-{{solver}}.nc",
        number=range(batches),
        solver=solvers_of(effort().outcomes),
    )


def sealed_motions(campaign):
    """Files of the motions that were commanded in the sealed tests, which are no readings."""
    return motion_files(campaign, "sealed")


def motion_files(campaign, role=None):
    """Files of the motions that were commanded in tests of a role, or in all."""
    loaded = load_campaign(CAMPAIGNS[campaign])
    motions = [
        test.motion for test in loaded.tests.values() if role in (None, test.role)
    ]
    paths = [loaded.folder / motion for motion in motions]
    paths += [Path(definition("motions", motion)) for motion in motions]
    return sorted({str(path) for path in paths if path.is_file()})


def decided(wildcards):
    """Decision on a campaign; asks for it first."""
    from blockshake.diagnosis.answer.decision import load_decision

    path = checkpoints.decide.get(campaign=wildcards.campaign).output.decision
    with refusing():
        return load_decision(path)


def extended_files(wildcards):
    """Ensembles of sealed tests by both solvers, where a cause extends the model and anything is simulated."""
    from blockshake.diagnosis.gain.extended_model import acting_causes

    simulated = plan(wildcards.campaign).simulated
    extended = simulated and acting_causes(decided(wildcards))
    return expand(
        f"results/diagnosis/{wildcards.campaign}/extended/{{solver}}.nc",
        solver=NULL_MODELS if extended else [],
    )


def gain_files(wildcards):
    """The gain and its scores, where there are sealed tests, and causes, faults of sensors, or outcomes alone."""
    from blockshake.parity.parity import load_parity

    parity = f"results/diagnosis/{wildcards.campaign}/parity.json"
    acting = decided(wildcards).extending
    with refusing():
        acting = acting or load_parity(parity).findings
    campaign = plan(wildcards.campaign).campaign
    if (acting or campaign.kind.batches) and campaign.sealed:
        return expand(
            f"results/diagnosis/{wildcards.campaign}/{{name}}",
            name=["gain.json", "gain.nc"],
        )
    return []
