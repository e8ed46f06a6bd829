"""A wheel holds what stands beside the package in a checkout: structures, motions, the workflow, recorded data."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

SHIPPED = (
    "Snakefile",
    "config/structures",
    "config/motions",
    "config/templates",
    "config/diagnosis.yaml",
    "config/study.yaml",
    "config/virtual-campaign.yaml",
    "workflow",
    "profiles/default",
    "data/track-record",
)


class BuildWithShipped(build_py):
    """Build of the package with a copy of these in it; an editable install reads the checkout's own."""

    def run(self):
        """Copy them after the modules."""
        super().run()
        if self.editable_mode:
            return
        home = Path(self.build_lib, "blockshake", "shipped")
        shutil.rmtree(home, ignore_errors=True)
        for name in SHIPPED:
            source, target = Path(name), home / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copyfile(source, target)


setup(cmdclass={"build_py": BuildWithShipped})
