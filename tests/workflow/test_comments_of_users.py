"""The content of a user's YAML reruns a rule, and a comment in it does not."""

import re

from checkout import ROOT, Checkout

from blockshake.files import shipped

DESCRIBED = "results/small/motions/own.nc"
# by which the input of a rule names files of users
NAMED = r"\b(?:structure_file|case_files|run_files|files_of_report|motion_file|"
NAMED += r"measured_files|open_files)\b"


def due(checkout):
    answer = checkout.snakemake("-n", DESCRIBED)
    assert answer.returncode == 0, answer.stderr
    return "describe_motion" in answer.stdout


def test_a_comment_in_a_file_of_the_user_reruns_nothing(tmp_path):
    checkout = Checkout(tmp_path)
    path = tmp_path / "own.yaml"
    text = shipped("motions", "alkion").read_text()
    path.write_text(text)
    case = {
        key: value for key, value in checkout.config["cases"][0].items() if key not in ("measured", "input")
    }
    checkout.write_config(checkout.config | {"cases": [case | {"motion": "own.yaml"}]})
    made = checkout.snakemake(DESCRIBED)
    assert made.returncode == 0, made.stderr
    assert not due(checkout)
    path.write_text(f"# a comment\n{text}")
    assert not due(checkout)
    assert "seed: 212" in text
    path.write_text(text.replace("seed: 212", "seed: 213"))
    assert due(checkout)


def test_every_rule_that_reads_a_file_of_the_user_watches_its_content():
    """The file's time counts nothing: without `yaml_contents` an edit would rerun nothing."""
    texts = [path.read_text() for path in sorted((ROOT / "workflow" / "rules").glob("*.smk"))]
    rules = [rule for text in texts for rule in re.split(r"\n(?=rule |checkpoint )", text)]
    readers = [rule for rule in rules if "    params:" in rule and re.search(NAMED, rule.split("output:")[0])]
    assert len(readers) == 15
    assert all("yaml_contents=yaml_contents(" in rule for rule in readers)
