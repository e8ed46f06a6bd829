"""What the rules of a case share: its files, and the entries of its configuration that runs depend on."""


def campaign_files(case, every=False):
    """The test that a case is compared with, or every one that is not sealed, and what describes it."""
    measured = CASES[case]["measured"]
    campaign = load_campaign(measured["campaign"])
    tests = campaign.open.values() if every else [campaign.open[measured["test"]]]
    return files_of_tests(campaign, tests)


def files_of_tests(campaign, tests):
    """The file of a campaign, those of some of its tests, and others that describe them, as far as they are there."""
    files = [campaign.folder / "campaign.yaml", Path(campaign.structure)]
    for test in tests:
        path = campaign.folder / test.file
        accelerometers = path.with_name(f"{path.stem}-acc.csv")
        files += [path, accelerometers, campaign.folder / test.motion]
    return [str(path) for path in dict.fromkeys(files) if path.is_file()]


def structure_file(wildcards):
    """Structure of a case."""
    return definition("structures", CASES[wildcards.case]["structure"])


def case_files(wildcards):
    """Structure and motion of a case, by name."""
    motion = definition("motions", CASES[wildcards.case]["motion"])
    return {"structure": structure_file(wildcards), "motion": motion}


def case_keys(case, *more):
    """Entries of a case in the configuration that its runs depend on."""
    keys = ("structure", "motion", "baseline", "duration", *more)
    return {key: CASES[case][key] for key in keys}


def case_definition(wildcards):
    """The same of a case under one motion of its own."""
    return case_keys(wildcards.case, "scale", "input")
