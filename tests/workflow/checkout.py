"""A copy of the checkout with a small study, as a user has one."""

import copy
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import yaml

from blockshake.files import PACKAGE, load_yaml

ROOT = PACKAGE.parents[1]
COPIED = ("Snakefile", "config", "data", "profiles", "src", "workflow")
SNAKEMAKE = Path(sys.executable).with_name("snakemake")
LIMIT = 1200  # s; against a study that hangs, not a measure of speed: other jobs may share the machine


def heed_interrupts():
    """Have a process that starts here heed interrupts, which a shell's background jobs and their own ignore."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


class Job(NamedTuple):
    """A job of a dry run."""

    rule: str
    wildcards: dict
    reason: str


class Checkout:
    """A copy of the project with a small study of configuration 1 by the two models of rigid blocks."""

    def __init__(self, folder, **changes):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        for name in COPIED:
            source = ROOT / name
            if source.is_dir():
                shutil.copytree(
                    source, folder / name, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info")
                )
            else:
                shutil.copy(source, folder / name)
        config = load_yaml(ROOT / "config" / "quick.yaml")
        config["cases"] = config["cases"][:1]
        config["cases"][0]["duration"] = 0.05
        del config["models"]["nscd-viscoelastic"], config["cases"][0]["samples"], config["calibration"]
        config["fragility"]["size"], config["ladder"]["highest"] = 3, 1.0
        config["name"] = "small"
        self.write_config(config | changes)

    def copied(self, folder):
        """The same in another folder, with all that was made in this one."""
        shutil.copytree(self.folder, folder)
        other = copy.copy(self)
        other.folder = folder
        return other

    def write_config(self, config):
        self.config = config
        (self.folder / "config" / "small.yaml").write_text(yaml.safe_dump(config, sort_keys=False))

    def command(self, *arguments, engine=("--cores", "2")):
        return [SNAKEMAKE, *engine, *arguments, "--configfile", "config/small.yaml"]

    def snakemake(self, *arguments):
        return subprocess.run(
            self.command(*arguments),
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=LIMIT,
            check=False,
            preexec_fn=heed_interrupts,
        )

    def jobs(self, *arguments):
        """Rules that a dry run would run, with their number."""
        answer = self.snakemake("-n", *arguments)
        assert answer.returncode == 0, answer.stderr
        return {
            name: int(count)
            for name, count in re.findall(r"^(\w[\w-]*) +(\d+)$", answer.stdout, flags=re.MULTILINE)
        }

    def due(self, *arguments):
        """Jobs that a dry run would run: rule, wildcards by name, and why."""
        answer = self.snakemake("-n", *arguments, "--quiet", "progress")
        assert answer.returncode == 0, answer.stdout + answer.stderr
        jobs = []
        for block in re.split(r"^(?:rule|checkpoint|localrule) ", answer.stdout, flags=re.MULTILINE)[1:]:
            of = dict(re.findall(r"^    (\w+): (.*)$", block, flags=re.MULTILINE))
            wildcards = dict(pair.split("=", 1) for pair in of.get("wildcards", "").split(", ") if pair)
            jobs.append(Job(block.partition(":")[0], wildcards, of.get("reason", "")))
        return jobs

    def append(self, source, text):
        path = self.source(source)
        path.write_text(path.read_text() + text)

    def source(self, name):
        """Path of a file of the package."""
        return self.folder / "src" / "blockshake" / name
