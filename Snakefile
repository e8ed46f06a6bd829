# The study, started from the root of a checkout: its rules are in workflow.
include: "workflow/Snakefile"


rule study:
    default_target: True
    input:
        rules.all.input,
