"""A SLURM of one node on this machine: munge, slurmctld and slurmd on loopback, all in one folder, on free ports."""

import contextlib
import getpass
import os
import shutil
import socket
import subprocess
import time

import psutil

NEEDED = ("setpriv", "munged", "slurmctld", "slurmd", "sbatch", "srun", "squeue", "scontrol", "scancel")
PATH = os.pathsep.join([os.environ["PATH"], "/usr/sbin", "/sbin"])
LIMIT = 60.0  # s; in which a daemon starts or ends
NODE = "node"
CONFIGURATION = """
ClusterName=one-node
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={user}
SlurmdUser={user}
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
MinJobAge=3600
SlurmdParameters=config_overrides
NodeName={node} NodeHostname={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=8000
PartitionName=all Nodes={node} Default=YES MaxTime=INFINITE
"""


def missing():
    """Programs of SLURM and munge that are not installed."""
    return [name for name in NEEDED if shutil.which(name, path=PATH) is None]


class OneNode:
    """Commands to the controller of a SLURM that runs."""

    def __init__(self, folder):
        self.environment = {
            **os.environ,
            "PATH": os.pathsep.join([str(folder / "bin"), PATH]),
            "SLURM_CONF": str(folder / "slurm.conf"),
        }

    def ask(self, *command):
        """Answer of a command of SLURM."""
        answer = subprocess.run(
            command, env=self.environment, capture_output=True, text=True, timeout=LIMIT, check=False
        )
        return answer.stdout.strip() if answer.returncode == 0 else ""

    def jobs(self, states):
        """Jobs in some states, by number: rule and wildcards, as the executor comments them."""
        lines = self.ask("squeue", "--noheader", f"--states={states}", "--format=%i %k").splitlines()
        return dict(line.split(" ", 1) for line in lines)

    def set_node(self, state):
        """Drain or resume the node."""
        self.ask("scontrol", "update", f"nodename={NODE}", f"state={state}", "reason=test")


@contextlib.contextmanager
def running(folder):
    """Start a SLURM in a folder; its daemons and all that they started end with the block, or with this process."""
    node, daemons = OneNode(folder), []
    for name in ("state", "spool", "bin"):
        (folder / name).mkdir()
    # Snakemake's jobs forget where SLURM's configuration is, where that is not the system's
    srun = folder / "bin" / "srun"
    srun.write_text(
        f'#!/bin/sh\nSLURM_CONF={folder}/slurm.conf exec {shutil.which("srun", path=PATH)} "$@"\n'
    )
    srun.chmod(0o755)
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o400)
    given = {"host": socket.gethostname().split(".")[0], "user": getpass.getuser(), "node": NODE}
    (folder / "slurm.conf").write_text(
        CONFIGURATION.format(folder=folder, ports=_free_ports(2), **given).lstrip()
    )

    def start(*command, ready):
        with open(folder / f"{command[0]}.out", "wb") as said:
            daemon = subprocess.Popen(
                ["setpriv", "--pdeathsig", "KILL", *command],
                env=node.environment, cwd=folder, stdout=said, stderr=said, start_new_session=True,
            )  # fmt: skip
        daemons.append(daemon)
        deadline = time.monotonic() + LIMIT
        while not ready():
            if daemon.poll() is not None or time.monotonic() > deadline:
                raise RuntimeError(f"{command[0]} did not start: {(folder / said.name).read_text()}")
            time.sleep(0.1)

    try:
        start(
            "munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder / 'munge.socket'}",
            f"--pid-file={folder / 'munged.pid'}", f"--log-file={folder / 'munged.log'}",
            f"--seed-file={folder / 'munge.seed'}", ready=(folder / "munge.socket").exists,
        )  # fmt: skip
        start("slurmctld", "-D", "-c", ready=lambda: "UP" in node.ask("scontrol", "ping"))
        start("slurmd", "-D", "-c", ready=lambda: node.ask("sinfo", "--noheader", "--format=%T") == "idle")
        yield node
    finally:
        _end(daemons, folder)


def _free_ports(count):
    """Ports of loopback that nothing listens at."""
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


def _end(daemons, folder):
    """End the daemons, last first, then the jobs that are left: those who mind them work in the folder."""
    for daemon in reversed(daemons):
        daemon.terminate()
        try:
            daemon.wait(LIMIT)
        except subprocess.TimeoutExpired:
            daemon.kill()
            daemon.wait()
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error):
            if process.cwd() == str(folder) or process.environ().get("SLURM_CONF") == str(
                folder / "slurm.conf"
            ):
                process.kill()
