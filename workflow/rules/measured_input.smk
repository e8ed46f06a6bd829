rule measure_input:
    """Motion of the slab in the test that a case is compared with: the input of its models, and the test's clock."""
    input:
        unpack(case_files),
        campaign=measured_files,
    output:
        "results/{study}/inputs/{case}.nc",
    log:
        "logs/{study}/measure_input/{case}.log",
    priority: for_first_picture
    conda:
        "../envs/blockshake.yaml"
    params:
        case=case_definition,
        measured=lambda wildcards: CASES[wildcards.case]["measured"],
        yaml_contents=yaml_contents(case_files, measured_files),
        source=source_of("measure_input"),
    script:
        "../scripts/measure_input.py"
