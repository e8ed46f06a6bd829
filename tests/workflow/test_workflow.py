"""The workflow as a user meets it: small studies in a copy of the checkout, run by Snakemake itself."""

import html
import json
import os
import re
import shutil
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest
import yaml
from checkout import LIMIT, SNAKEMAKE, Checkout
from made_up_decision import made_up_cause

import blockshake
from blockshake.cli import main
from blockshake.diagnosis.verdict.verdict import Misfit, Verdict, write_verdict
from blockshake.files import PACKAGE, load_yaml
from blockshake.study.config import load_config
from blockshake.study.sampling.latin_hypercube import draw_design
from blockshake.study.sampling.sample_table import load_design
from blockshake.working_folder import hold

ROOT = PACKAGE.parents[1]


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    checkout = Checkout(tmp_path_factory.mktemp("checkout"))
    answer = checkout.snakemake()
    assert answer.returncode == 0, answer.stdout + answer.stderr
    checkout.said = answer.stdout
    return checkout


def test_the_page_is_there_after_the_first_case_by_the_first_model(finished):
    (line,) = [line for line in finished.said.splitlines() if line.startswith("report so far: ")]
    assert line == "report so far: reports/small.html, with configuration-1 by LS-DEM; 1 left"


def test_study_ends_with_its_reports(finished):
    assert (finished.folder / "reports" / "small.html").stat().st_size > 0
    assert (finished.folder / "reports" / "small.pdf").read_bytes().startswith(b"%PDF")


def test_the_command_finds_all_made_and_reports_one_case(finished):
    """`blockshake study` is the same workflow."""
    environment = {**os.environ, "PYTHONPATH": str(finished.folder / "src")}
    command = [sys.executable, "-m", "blockshake", "study", "config/small.yaml", "--cores", "2"]
    for more, made in (([], "small.html"), (["--case", "configuration-1"], "small-configuration-1.html")):
        answer = subprocess.run(
            [*command, *more], cwd=finished.folder, env=environment, capture_output=True, text=True, timeout=LIMIT,
            check=False,
        )  # fmt: skip
        assert answer.returncode == 0, answer.stdout + answer.stderr
        assert f"; reports/{made}, " in answer.stdout.splitlines()[-1]
        assert "samples of" not in answer.stdout  # nothing is simulated
    assert (finished.folder / "reports" / "small-configuration-1.pdf").read_bytes().startswith(b"%PDF")


def test_printed_configuration_plans_the_same_study(finished):
    page = (finished.folder / "reports" / "small.html").read_text()
    listings = [html.unescape(text) for text in re.findall("<pre>(.*?)</pre>", page, flags=re.DOTALL)]
    (printed,) = [text for text in listings if text.startswith("name: small")]
    before = finished.config
    try:
        finished.write_config(yaml.safe_load(printed))
        assert finished.jobs() == {}
    finally:
        finished.write_config(before)


def test_a_finished_study_is_exported_as_a_research_object(finished, monkeypatch):
    monkeypatch.chdir(finished.folder)
    assert main(["export", "config/small.yaml", "--ro-crate", "--output", "crate"]) == 0
    graph = {
        one["@id"]: one for one in json.loads(Path("crate/ro-crate-metadata.json").read_text())["@graph"]
    }
    action = graph[graph["./"]["mentions"]["@id"]]
    assert graph["workflow/Snakefile"]["version"] == blockshake.__version__
    results = {one["@id"] for one in action["result"]}
    assert {"reports/small.html", "results/small/responses.csv", "results/small/design.csv"} <= results
    assert {"@id": "config/small.yaml"} in action["object"]


def test_a_changed_distribution_reruns_what_has_a_use_for_it(finished):
    """Configuration 1 has no steel, and rigid blocks have no modulus."""
    before, made = finished.config, finished.folder / "results" / "small" / "design.csv"
    settings = load_config(finished.folder / "config" / "small.yaml").ensemble.model_dump(mode="json")
    distributions = settings["distributions"]

    def due(name):
        changed = distributions | {name: distributions[name] | {"mean": 1.1 * distributions[name]["mean"]}}
        finished.write_config(before | {"ensemble": before["ensemble"] | {"distributions": changed}})
        return {(job.rule, job.wildcards.get("model")) for job in finished.due()}

    try:
        found = due("friction.concrete.steel")
        assert {"draw_samples", "measure_sensitivity", "write_responses"} <= {rule for rule, _ in found}
        assert not {"simulate_batch", "climb_samples", "make_envelope"} & {rule for rule, _ in found}
        found = due("materials.concrete.youngs_modulus")
        assert ("simulate_batch", "ls-dem") in found
        assert ("simulate_batch", "nscd-rigid") not in found
        assert "calibrate_stiffness" in {rule for rule, _ in found}
        assert "climb_samples" not in {rule for rule, _ in found}  # by rigid blocks
        assert {model for rule, model in due("friction.concrete.concrete") if rule == "simulate_batch"} == {
            "ls-dem", "nscd-rigid",
        }  # fmt: skip
    finally:
        finished.write_config(before)
    # the parsed design is that of the file, to the digit
    assert draw_design(settings).values.equals(load_design(made))


def test_second_run_does_nothing(finished):
    assert finished.jobs() == {}


def test_every_simulating_rule_leaves_a_log_with_its_cost(finished):
    for model in ("ls-dem", "nscd-rigid"):
        batch = f"small/simulate_batch/{model}/configuration-1/000-004"
        log = finished.folder / "logs" / f"{batch}.log"
        assert "numba" in log.read_text()
        assert log.read_text().endswith(" CPU s.\n")
        header, row = log.with_suffix(".tsv").read_text().splitlines()
        assert float(dict(zip(header.split("\t"), row.split("\t"), strict=True))["cpu_time"]) > 0.0


def test_report_of_one_case_needs_its_results_alone(finished):
    planned = finished.jobs("--forceall", "reports/small-configuration-1.html")
    assert planned["make_case_report"] == 1
    assert "make_report" not in planned


def test_single_sample_is_a_batch_of_one(finished):
    target = "results/small/runs/nscd-rigid/configuration-1/003-003.nc"
    answer = finished.snakemake(target)
    assert answer.returncode == 0, answer.stderr
    assert "sample 3, kept" in answer.stdout
    assert (finished.folder / target).exists()


def test_provenance_report_needs_no_network(finished):
    answer = finished.snakemake("--report", "provenance.zip")
    assert answer.returncode == 0, answer.stderr
    with zipfile.ZipFile(finished.folder / "provenance.zip") as archive:
        text = "\n".join(archive.read(name).decode(errors="ignore") for name in archive.namelist())
    assert "Samples of the uncertain parameters are simulated" in text  # the description of the workflow
    assert "Report of the study small: whether the blocks stand" in text  # the caption of a result


def test_a_second_command_is_refused_and_touches_nothing(tmp_path):
    checkout = Checkout(tmp_path)
    held = hold(tmp_path)
    answer = checkout.snakemake("configuration-1")
    os.close(held)
    assert answer.returncode == 2
    said = [text for text in answer.stderr.splitlines() if text.startswith("blockshake:")]
    assert len(said) == 1
    assert "expected a folder in which no other study or diagnosis runs" in said[0]
    assert not (tmp_path / "results").exists()
    assert not (tmp_path / "logs").exists()


def test_bad_configuration_ends_in_one_line_and_exit_2(tmp_path):
    answer = Checkout(tmp_path, frequency=1.0).snakemake()
    assert answer.returncode == 2
    said = [text for text in answer.stderr.splitlines() if text.startswith("blockshake:")]
    assert len(said) == 1
    assert "config/small.yaml: frequency: unknown key" in said[0]
    assert "Traceback" not in answer.stderr
    assert not (tmp_path / "results").exists()


def test_an_input_of_the_future_is_named_before_the_first_job(tmp_path):
    """Snakemake takes away what is older than its inputs, and never states it to `blockshake study`."""
    checkout, name = Checkout(tmp_path), "motions/basso-tirreno.yaml"
    ahead = time.time() + 3600.0
    os.utime(tmp_path / "config" / name, (ahead, ahead))
    answer = checkout.snakemake("configuration-1")
    assert answer.returncode == 2
    (line,) = [text for text in answer.stderr.splitlines() if text.startswith("blockshake:")]
    assert f"{name}: expected a file from before now, found the time " in line
    assert "`touch` sets it to now" in line
    assert not (tmp_path / "results" / "small").exists()


@pytest.mark.parametrize(
    ("typed", "names"), [("campaign='2024_11'", ["2024_11"]), ("campaigns=[007, 1e3]", ["007", "1e3"])]
)
def test_campaigns_may_have_names_of_digits(typed, names, tmp_path):
    checkout = Checkout(tmp_path)
    for name in names:
        shutil.copytree(ROOT / "data" / "virtual-campaign" / "configuration-1", tmp_path / name)
    answer = checkout.snakemake("-n", "diagnose", "--config", typed, "effort=quick")
    assert answer.returncode == 0, answer.stderr  # another name would be no folder


def test_a_study_is_read_as_every_other_file(tmp_path):
    """Snakemake's own YAML reads 010 as 8."""
    checkout, path = Checkout(tmp_path), tmp_path / "config" / "small.yaml"
    path.write_text(path.read_text().replace("samples_per_job: 5", "samples_per_job: 010"))
    answer = checkout.snakemake("-n")
    assert answer.returncode == 2
    assert "samples_per_job: input should be a valid integer, not '010'" in answer.stderr


def test_a_text_of_digits_stays_a_text_and_options_give_numbers(tmp_path):
    checkout = Checkout(tmp_path, name="2024")
    answer = checkout.snakemake("-n", "--config", "ladder={first: 1, increment: 0.5}")
    assert answer.returncode == 0, answer.stdout + answer.stderr
    assert "results/2024/" in checkout.snakemake("-n", "results/2024/design.csv").stdout


def test_study_without_measured_tests_compares_with_none(tmp_path):
    checkout = Checkout(tmp_path)
    config = {key: checkout.config[key] for key in ("name", "description", "models", "cases", "ensemble")}
    del config["cases"][0]["measured"]
    checkout.write_config(config)
    planned = checkout.jobs()
    assert "make_envelope" in planned
    assert not {"compare_with_measurement", "compare_open_tests"} & set(planned)


@pytest.mark.parametrize("study", ["study", "paper"])
def test_shipped_studies_plan_without_error(study):
    answer = subprocess.run(
        [SNAKEMAKE, "-n", "--cores", "1", "--forceall", "--configfile", f"config/{study}.yaml"],
        cwd=ROOT, capture_output=True, text=True, timeout=LIMIT, check=False,
    )  # fmt: skip
    assert answer.returncode == 0, answer.stderr
    assert "simulate_batch" in answer.stdout
    # both models of deformable blocks run the same kernels
    assert re.search(r"^compile_kernels +3$", answer.stdout, flags=re.MULTILINE)


@pytest.mark.slow
def test_an_extended_study_is_run_with_nothing_special(tmp_path, monkeypatch, capsys):
    """A made verdict, a tiny study, the command, and the ordinary workflow."""
    checkout = Checkout(tmp_path)
    shutil.copy(ROOT / "config" / "structures" / "configuration-1.yaml", tmp_path / "wall.yaml")
    config = {key: checkout.config[key] for key in ("name", "description", "ensemble")}
    config["models"] = {"nscd-rigid": checkout.config["models"]["nscd-rigid"]}
    config["cases"] = [{"structure": "wall.yaml", "motion": "basso-tirreno", "scale": 2.0, "duration": 0.05}]
    checkout.write_config(config)
    inset = {"estimate": 0.04, "lower": 0.03, "upper": 0.05, "unit": "m"}
    sizes = tuple({"inset": 0.03 + 0.0005 * number} for number in range(40))
    cause = made_up_cause("reduced-bearing", {}, parameters={"inset": inset}, members=sizes)
    verdict = Verdict(
        decision="named", causes=["reduced-bearing"], probabilities={}, misfit=Misfit(p=0.01, where="block-1"), runs=0,
        word="established", extension=(cause,),
    )  # fmt: skip
    write_verdict(tmp_path / "verdict.json", verdict)
    monkeypatch.chdir(tmp_path)
    command = ["extend-study", "verdict.json", "config/small.yaml", "--output", "made/extended.yaml"]
    assert main(command) == 0
    assert "extension.shapes.block.chamfer [m]" in capsys.readouterr().out
    checkout.write_config(load_yaml("made/extended.yaml"))
    answer = checkout.snakemake()
    assert answer.returncode == 0, answer.stdout + answer.stderr
    page = (tmp_path / "reports" / "small-extended.html").read_text()
    assert "Effect of the cause" in page
    assert "wall-extended, NSCD rigid, 10 pairs of samples: reduced bearing width changes" in page
    assert checkout.jobs() == {}
