rule describe_motion:
    """Histories, response spectrum and figures of a ground motion."""
    input:
        motion_file,
    output:
        "results/{study}/motions/{motion}.nc",
    log:
        "logs/{study}/describe_motion/{motion}.log",
    conda:
        "../envs/blockshake.yaml"
    params:
        motion=lambda wildcards: MOTIONS[wildcards.motion],
        baseline=lambda wildcards: BASELINES[MOTIONS[wildcards.motion]],
        intensity=intensity_of_records,
        yaml_contents=yaml_contents(motion_file),
        source=source_of("describe_motion"),
    script:
        "../scripts/describe_motion.py"
