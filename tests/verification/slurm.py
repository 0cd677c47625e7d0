"""A Slurm of one node on this machine, for tests: its own folder, ports, key and sockets."""
import os
import pathlib
import shutil
import socket
import subprocess
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol")


def missing():
    """Names of the programs of Slurm that are not installed."""
    path = os.environ.get("PATH", "") + os.pathsep + "/usr/sbin"
    return [name for name in PROGRAMS if not shutil.which(name, path=path)]


def free_ports(number):
    """TCP ports that nothing listens on."""
    sockets = [socket.socket() for _ in range(number)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Slurm:
    """Starts munged, slurmctld and slurmd in `folder`; a context manager that ends them.

    `environment` is that of clients (`sbatch`, `squeue`, ...). Needs root, as slurmd does.
    """

    def __init__(self, folder, cpus=2):
        self.folder = pathlib.Path(folder).resolve()
        self.cpus = cpus
        self.daemons = []
        self.environment = {**os.environ, "SLURM_CONF": str(self.folder / "slurm.conf"),
                            "PATH": os.environ.get("PATH", "") + os.pathsep + "/usr/sbin"}

    def __enter__(self):
        try:
            self.start_daemons()
        except BaseException:
            self.__exit__()
            raise
        return self

    def start_daemons(self):
        """Writes the configuration and starts the daemons, and waits until the node is idle."""
        self.folder.mkdir(mode=0o755, exist_ok=True)
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        host = socket.gethostname().split(".")[0]
        controller, node = free_ports(2)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        (self.folder / "slurm.conf").write_text("\n".join([
            "ClusterName=latcon-test", f"SlurmctldHost={host}(127.0.0.1)", f"SlurmctldPort={controller}",
            f"SlurmdPort={node}", "SlurmUser=root", "SlurmdUser=root", "AuthType=auth/munge", "CryptoType=crypto/munge",
            f"AuthInfo=socket={self.folder}/munge.socket", f"StateSaveLocation={self.folder}/state",
            f"SlurmdSpoolDir={self.folder}/spool", f"SlurmctldPidFile={self.folder}/slurmctld.pid",
            f"SlurmdPidFile={self.folder}/slurmd.pid", f"SlurmctldLogFile={self.folder}/slurmctld.log",
            f"SlurmdLogFile={self.folder}/slurmd.log", "ProctrackType=proctrack/pgid", "TaskPlugin=task/none",
            "SwitchType=switch/none", "MpiDefault=none", "ReturnToService=2", "SchedulerType=sched/backfill",
            "SchedulerParameters=sched_interval=2,bf_interval=2,requeue_setup_env_fail",
            "SelectType=select/cons_tres", "SelectTypeParameters=CR_CPU", "KillWait=10", "MinJobAge=300",
            "JobRequeue=1", "AccountingStorageType=accounting_storage/none", "JobAcctGatherType=jobacct_gather/none",
            f"NodeName={host} NodeAddr=127.0.0.1 CPUs={self.cpus} State=UNKNOWN",
            f"PartitionName=test Nodes={host} Default=YES MaxTime=INFINITE State=UP", ""]))
        (self.folder / "cgroup.conf").write_text("CgroupPlugin=cgroup/v1\n")
        munged = ["munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                  f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                  f"--seed-file={self.folder}/munged.seed"]
        self.start(munged)
        self.wait_for(lambda: (self.folder / "munge.socket").exists(), "munged")
        self.start(["slurmctld", "-D", "-f", str(self.folder / "slurm.conf")])
        self.start(["slurmd", "-D", "-f", str(self.folder / "slurm.conf"), "-N", host])
        self.wait_for(lambda: "idle" in self.run("sinfo", "--noheader", "--format=%T", check=False), "slurmd")

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.terminate()
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def start(self, command):
        """Starts a daemon whose output goes to a file named after it."""
        with open(self.folder / (command[0] + ".out"), "w", encoding="utf-8") as log:
            self.daemons.append(subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=log,
                                                 stderr=subprocess.STDOUT))

    def wait_for(self, condition, what, limit=60):
        """Waits until a daemon or a job is as wanted. Raises RuntimeError with the logs after `limit` [s]."""
        end = time.monotonic() + limit
        while not condition():
            if time.monotonic() > end:
                logs = "\n".join(f"{log.name}:\n{log.read_text(errors='replace')[-1500:]}"
                                 for log in sorted(self.folder.glob("*.log")) + sorted(self.folder.glob("*.out")))
                raise RuntimeError(f"waited {limit} s for {what}\n{logs}")
            time.sleep(0.2)

    def run(self, *command, check=True):
        """Output of a client. Raises CalledProcessError if it fails and `check` is set."""
        result = subprocess.run(command, env=self.environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                check=check, timeout=60)
        return result.stdout

    def jobs(self):
        """Numbers and states of the jobs that have not ended, one line each."""
        return self.run("squeue", "--noheader", "--array", "--format=%i %T").splitlines()
