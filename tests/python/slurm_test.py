"""sinew.study on a real Slurm of one node, which the test starts for itself."""

import getpass
import os
import shutil
import signal
import socket
import subprocess
import time
import unittest

import sinew
from python_support import PythonTest, beam
from sinew.study import Slurm, Study

DAEMONS = ("slurmctld", "slurmd")
PROGRAMS = (*DAEMONS, "sbatch", "squeue", "scancel", "sinfo")
PATH = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])
VARY = {"beam.young": [50e3, 100e3, 150e3, 200e3, 250e3, 300e3]}

CONFIGURATION = """ClusterName=sinew
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/none
CredType=cred/none
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={first}
SlurmdPort={second}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
KillWait=1
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


@unittest.skipIf(any(shutil.which(p, path=PATH) is None for p in PROGRAMS), "Slurm is not installed")
class SlurmTest(PythonTest):
    def setUp(self):
        super().setUp()
        self.folder = self.dir / "slurm"
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        conf = self.folder / "slurm.conf"
        conf.write_text(CONFIGURATION.format(host=socket.gethostname().split(".")[0],
                                             user=getpass.getuser(), folder=self.folder,
                                             first=free_port(), second=free_port()))
        for key, value in (("SLURM_CONF", str(conf)), ("PATH", PATH)):
            self.addCleanup(os.environ.__setitem__, key, os.environ.get(key, ""))
            os.environ[key] = value
        for name in DAEMONS:
            with open(self.folder / f"{name}.out", "w", encoding="utf-8") as out:
                daemon = subprocess.Popen([name, "-D"], stdout=out, stderr=out,
                                          start_new_session=True)
            self.addCleanup(daemon.wait)
            self.addCleanup(lambda d=daemon: os.killpg(d.pid, signal.SIGKILL))
            time.sleep(1)
        end = time.monotonic() + 60
        while "idle" not in self.sinfo():
            if time.monotonic() > end:
                logs = "".join((self.folder / f"{n}.out").read_text()[-500:] for n in DAEMONS)
                self.skipTest(f"this machine starts no Slurm: {logs}")
            time.sleep(0.5)

    def sinfo(self):
        return subprocess.run(["sinfo", "--noheader"], text=True, capture_output=True,
                              check=False).stdout

    def check(self, table):
        self.assertEqual([row["status"] for row in table], ["finished"] * 6, table.rows)
        for row in table:
            alone = sinew.run(beam(duration=0.05), set={"beam.young": row["beam.young"]})
            self.assertEqual(row["state_hash"], alone.state_hash)

    def test_a_job_array(self):
        self.check(Study(beam(duration=0.05), VARY).run(self.dir / "s",
                                                        on=Slurm(tasks=3, poll=0.5)))

    def test_a_cancelled_array_is_done_by_the_next_run(self):
        study = Study(beam(duration=0.05), VARY)
        def cancel(done, count, left):
            if done == 1:
                subprocess.run(["scancel", "--name=sinew-study"], check=False)
        table = study.run(self.dir / "s", on=Slurm(tasks=6, poll=0.2), progress=cancel)
        self.assertGreaterEqual(len(table), 1)
        self.check(study.run(self.dir / "s", on=Slurm(tasks=2, poll=0.5)))


if __name__ == "__main__":
    unittest.main()
