"""A Slurm cluster of one node on this machine's loopback, for tests: in a folder of its own, for a bounded time."""

import contextlib
import os
import pathlib
import secrets
import shutil
import socket
import subprocess
import sys
import time

# s, after which the daemons end even where nobody ends them.
LIFETIME = 600
DAEMONS = {"munged": "munge", "slurmctld": "slurmctld", "slurmd": "slurmd"}
CLIENTS = {"sbatch": "slurm-client", "squeue": "slurm-client", "scontrol": "slurm-client"}

CONFIGURATION = """\
ClusterName=loopback
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0,defer_batch
SchedulerType=sched/builtin
ReturnToService=2
KillWait=5
NodeName=loopback NodeHostname={host} NodeAddr=127.0.0.1 CPUs={processors} State=UNKNOWN
PartitionName=all Nodes=loopback Default=YES MaxTime=INFINITE State=UP
"""


def find(program):
    return shutil.which(program, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def missing():
    """Debian packages that are needed and not there."""
    return sorted({package for program, package in (DAEMONS | CLIENTS).items() if find(program) is None})


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    try:
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]
    finally:
        for one in sockets:
            one.close()


@contextlib.contextmanager
def cluster(folder):
    """Starts it and yields the environment in which sbatch and its kin talk to it."""
    folder = pathlib.Path(folder)
    user = subprocess.run(["id", "-un"], check=True, capture_output=True, text=True).stdout.strip()
    for name in ("munge", "state", "spool"):
        (folder / name).mkdir(mode=0o755)
    key = folder / "munge/key"
    key.write_bytes(secrets.token_bytes(128))
    key.chmod(0o600)
    ports = free_ports(2)
    configuration = folder / "slurm.conf"
    configuration.write_text(CONFIGURATION.format(
        host=socket.gethostname().split(".")[0], user=user, folder=folder, controller_port=ports[0],
        node_port=ports[1], processors=len(os.sched_getaffinity(0))))
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("SLURM", "SBATCH"))}
    environment["SLURM_CONF"] = str(configuration)
    commands = [
        [find("munged"), "--foreground", "--force", "--key-file", key, "--socket", folder / "munge/socket",
         "--pid-file", folder / "munge/pid", "--log-file", folder / "munge/log", "--seed-file", folder / "munge/seed",
         "--num-threads", "2"],
        [find("slurmctld"), "-D", "-c", "-f", configuration],
        [find("slurmd"), "-D", "-c", "-N", "loopback", "-f", configuration],
    ]
    daemons = []
    try:
        for command in commands:
            with open(folder / f"{pathlib.Path(command[0]).name}.out", "wb") as log:
                daemons.append(subprocess.Popen(
                    ["timeout", "--kill-after=10", str(LIFETIME), *map(str, command)], env=environment, stdout=log,
                    stderr=subprocess.STDOUT, start_new_session=True))
            if command is commands[0]:
                wait_until(lambda: (folder / "munge/socket").exists(), 20, "munged opens no socket")
        idle = ["sinfo", "--noheader", "--states=idle", "--format=%n"]
        wait_until(
            lambda: "loopback" in subprocess.run(idle, env=environment, capture_output=True, text=True, check=False,
                                                 timeout=30).stdout or socket.gethostname().split(".")[0] in
            subprocess.run(idle, env=environment, capture_output=True, text=True, check=False, timeout=30).stdout,
            60, "the node does not come up")
        yield environment
    except Exception:
        for log in sorted(folder.glob("*.log")) + sorted(folder.glob("*.out")) + [folder / "munge/log"]:
            if log.exists():
                print(f"--- {log.name}\n{log.read_text(errors='replace')[-2000:]}", file=sys.stderr)
        raise
    finally:
        if len(daemons) == len(commands):
            subprocess.run(["scancel", f"--user={user}"], env=environment, check=False, capture_output=True)
        for daemon in reversed(daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()


def wait_until(holds, seconds, complaint):
    deadline = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > deadline:
            raise TimeoutError(complaint)
        time.sleep(0.1)
