# SPDX-License-Identifier: GPL-2.0-or-later
"""A Slurm of one node for tests: real munged, slurmctld and slurmd, started by hand in a private folder on ports of
their own, whoever runs the test. Nothing of a Slurm that the machine may have is touched."""
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path

DAEMONS = ("munged", "slurmctld", "slurmd")
CONFIGURATION = """\
ClusterName=amontons
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={place}/munge.socket
CredType=cred/munge
SlurmctldPort={control_port}
SlurmdPort={node_port}
SlurmctldPidFile={place}/slurmctld.pid
SlurmdPidFile={place}/slurmd.pid
SlurmctldLogFile={place}/slurmctld.log
SlurmdLogFile={place}/slurmd.log
StateSaveLocation={place}/state
SlurmdSpoolDir={place}/spool
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
SchedulerParameters=sched_interval=1,batch_sched_delay=0
KillWait=2
MaxArraySize={array_size}
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES MaxTime=10 State=UP
"""


def find_daemon(name):
    return shutil.which(name) or shutil.which(name, path="/usr/sbin:/sbin")


def free_port():
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Slurm:
    """`environment` makes sbatch, squeue and scancel speak to it."""

    def __init__(self, array_size=1001):
        self.place = Path(tempfile.mkdtemp(prefix="amontons-slurm-", dir="/tmp"))   # sockets want short paths
        self.processes = []
        self.environment = {**os.environ, "SLURM_CONF": str(self.place / "slurm.conf")}
        import pwd
        self.configuration = CONFIGURATION.format(
            host=socket.gethostname().split(".")[0], user=pwd.getpwuid(os.geteuid()).pw_name, place=self.place,
            control_port=free_port(), node_port=free_port(), array_size=array_size)

    @staticmethod
    def missing():
        """Why no Slurm can be started here; None: it can."""
        missing = [name for name in DAEMONS if not find_daemon(name)]
        return f"not installed: {', '.join(missing)} (packages slurm-wlm, munge)" if missing else None

    def daemon(self, name, *words):
        log = open(self.place / f"{name}.out", "wb")
        self.processes.append(subprocess.Popen([find_daemon(name), *map(str, words)], stdout=log, stderr=log,
                                               stdin=subprocess.DEVNULL, env=self.environment))
        log.close()

    def start(self):
        """Returns None when jobs can be submitted, else why not."""
        for folder in ("state", "spool"):
            (self.place / folder).mkdir()
        (self.place / "slurm.conf").write_text(self.configuration)
        key = self.place / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.place.chmod(0o755)
        self.daemon("munged", "--foreground", "--force", f"--socket={self.place}/munge.socket", f"--key-file={key}",
                    f"--pid-file={self.place}/munged.pid", f"--log-file={self.place}/munged.log",
                    f"--seed-file={self.place}/munge.seed")
        self.wait(lambda: (self.place / "munge.socket").exists(), 10)
        self.daemon("slurmctld", "-D", "-f", self.place / "slurm.conf")
        self.daemon("slurmd", "-D", "-f", self.place / "slurm.conf")
        if self.wait(lambda: "idle" in self.call("sinfo", "-h", "-o", "%T").stdout, 30):
            return None
        logs = [path.read_text(errors="replace")[-600:] for path in sorted(self.place.glob("*.out"))]
        return "Slurm's daemons do not come up:\n" + "\n".join(logs)

    def wait(self, condition, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end and all(process.poll() is None for process in self.processes):
            if condition():
                return True
            time.sleep(0.05)
        return condition()

    def call(self, *words):
        return subprocess.run(words, capture_output=True, text=True, env=self.environment, check=False, timeout=60)

    def stop(self):
        self.call("scancel", "--user", str(os.geteuid()))
        for process in reversed(self.processes):
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        shutil.rmtree(self.place, ignore_errors=True)
