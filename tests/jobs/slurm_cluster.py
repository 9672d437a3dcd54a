"""A Slurm cluster of its own on this machine: slurmctld and some slurmd on loopback, gone at the end."""

import ctypes
import getpass
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time

TOOLS = ("slurmctld", "slurmd", "slurmstepd", "sbatch", "squeue", "scontrol")

PR_SET_CHILD_SUBREAPER = 36  # linux/prctl.h

CONFIGURATION = """
ClusterName=levelray
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SlurmdTimeout=300
KillWait=2
MinJobAge=3600
SchedulerParameters=batch_sched_delay=0,sched_interval=1,defer_batch
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.%n.log
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class Unavailable(Exception):
    """Slurm cannot be used here; says why."""


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for s in sockets:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in sockets]
    for s in sockets:
        s.close()
    return ports


class Cluster:
    """with Cluster({"n1": 8, "n2": 2}) as cluster: ...  CPUs of each node (as Slurm counts them); the last is filled first."""

    def __init__(self, nodes):
        os.environ["PATH"] += ":/usr/sbin:/sbin"
        missing = [tool for tool in TOOLS if not shutil.which(tool)]
        if missing:
            raise Unavailable(f"{', '.join(missing)} not installed (scripts/setup test)")
        self.folder = tempfile.mkdtemp(prefix="levelray_slurm_")
        self.configuration = os.path.join(self.folder, "slurm.conf")
        self.environment = dict(os.environ, SLURM_CONF=self.configuration, LC_ALL="C")
        self.daemons = {}
        # What the daemons leave behind becomes this process's children, to be waited for.
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
        ports = free_ports(1 + len(nodes))
        for name in ["state"] + [f"spool.{node}" for node in nodes]:
            os.mkdir(os.path.join(self.folder, name))
        with open(self.configuration, "w") as file:
            file.write(CONFIGURATION.format(folder=self.folder, host=socket.gethostname(), user=getpass.getuser(),
                                            controller_port=ports[0]))
            for weight, (node, port) in enumerate(zip(nodes, ports[1:])):
                file.write(f"NodeName={node} NodeHostname={socket.gethostname()} NodeAddr=127.0.0.1 Port={port} "
                           f"CPUs={nodes[node]} Weight={len(nodes) - weight} State=UNKNOWN\n")
        try:
            self.start("slurmctld", ["slurmctld", "-D", "-c", "-f", self.configuration])
            for node in nodes:
                self.start(node, ["slurmd", "-D", "-c", "-N", node, "-f", self.configuration])
            self.wait(lambda: all(state == "IDLE" for state in self.node_states(nodes)), 30, "nodes to be idle")
        except Exception as error:
            reason = f"Slurm does not start here: {error}\n{self.logs()}"
            self.close()
            raise Unavailable(reason) from error

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def start(self, name, command):
        # In a session of its own: what the shell does to this test's group does not reach it.
        self.daemons[name] = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL,
                                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                              start_new_session=True)

    def run(self, *command, check=True):
        result = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=30)
        if check and result.returncode != 0:
            raise RuntimeError(f"{' '.join(command)}: {result.stderr.strip()}")
        return result.stdout

    def wait(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while True:
            try:
                if condition():
                    return
            except RuntimeError:  # the controller is not up yet
                pass
            dead = [name for name, daemon in self.daemons.items() if daemon.poll() is not None]
            if dead:
                raise RuntimeError(f"{', '.join(dead)} ended")
            if time.monotonic() > end:
                raise RuntimeError(f"waited {seconds} s for {what}")
            time.sleep(0.2)

    def node_states(self, nodes):
        return [self.node(node)["State"].split("+")[0].rstrip("*") for node in nodes]

    def node(self, name):
        return fields(self.run("scontrol", "show", "node", name, "-o"))

    def jobs(self, job):
        """The tasks of an array as dictionaries, done ones too."""
        return [fields(line) for line in self.run("scontrol", "show", "job", str(job), "-o").splitlines() if line]

    def processes(self):
        """Ids of all processes that Slurm of this cluster started: they know its configuration."""
        mark = f"SLURM_CONF={self.configuration}".encode()
        found = []
        for name in os.listdir("/proc"):
            if name.isdigit() and int(name) != os.getpid():
                try:
                    with open(f"/proc/{name}/environ", "rb") as file:
                        if mark in file.read().split(b"\0"):
                            found.append(int(name))
                except OSError:  # gone, or not ours
                    pass
        return found

    def kill_daemon(self, name):
        daemon = self.daemons.pop(name)
        daemon.send_signal(signal.SIGKILL)
        daemon.wait()

    def logs(self):
        text = ""
        for name in sorted(os.listdir(self.folder)):
            if name.endswith(".log"):
                with open(os.path.join(self.folder, name), errors="replace") as file:
                    text += f"--- {name}\n" + "".join(file.readlines()[-15:])
        return text

    def close(self):
        for daemon in self.daemons.values():
            daemon.kill()
        for daemon in self.daemons.values():
            daemon.wait()
        self.daemons.clear()
        for _ in range(20):  # what a step starts while it dies
            left = self.processes()
            if not left:
                break
            for process in left:
                try:
                    os.kill(process, signal.SIGKILL)
                except ProcessLookupError:
                    pass
            time.sleep(0.1)
        try:
            while os.waitpid(-1, os.WNOHANG) != (0, 0):
                pass
        except ChildProcessError:
            pass
        shutil.rmtree(self.folder, ignore_errors=True)


def fields(line):
    """ "A=1 B=2" as scontrol prints it."""
    return dict(word.split("=", 1) for word in line.split() if "=" in word)
