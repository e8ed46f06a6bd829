# The study: its targets and the order of its rules. `blockshake keys study` lists the keys of the configuration.
from snakemake.utils import min_version

min_version("9.27")


# A configuration given on the command line takes the place of the default one; merged into it, a variable that
# it leaves out would come back.
if "cases" not in config:

    configfile: "config/study.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/case.smk"
include: "workflow/rules/motion.smk"
include: "workflow/rules/sampling.smk"
include: "workflow/rules/stiffness.smk"
include: "workflow/rules/measured_input.smk"
include: "workflow/rules/simulation.smk"
include: "workflow/rules/envelope.smk"
include: "workflow/rules/calibration.smk"
include: "workflow/rules/fragility.smk"
include: "workflow/rules/limit_states.smk"
include: "workflow/rules/extension.smk"
include: "workflow/rules/diagnosed.smk"
include: "workflow/rules/diagnosis.smk"
include: "workflow/rules/report.smk"


rule all:
    default_target: True
    input:
        f"reports/{STUDY}.html",
        f"reports/{STUDY}.pdf",
        f"results/{STUDY}/responses.csv",
        expand(
            "reports/diagnosis-{campaign}.{kind}",
            campaign=CAMPAIGNS,
            kind=["html", "pdf"],
        ),


for case in CASES:

    rule:
        name:
            case
        input:
            expand(
                "results/{study}/{kind}/{model}/{case}.nc",
                study=STUDY,
                kind=["envelopes", "sensitivities"]
                + (["comparisons"] if case in MEASURED else []),
                model=MODELS,
                case=case,
            ),
