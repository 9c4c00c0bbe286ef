"""Studies on Slurm: a controller, a node and munge of our own on this machine, on ports and in a folder of our own. Needs
root (slurmd does) and the packages slurm-wlm and munge, else it exits with 77: skipped."""
import getpass
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

from calx import CALX, CalxTest, cup
from test_calibrate import STUDY

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "sinfo")


def find(name):
    return shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Cluster:
    """munged, slurmctld and slurmd as children of this process."""

    def __init__(self):
        self.dir = pathlib.Path(tempfile.mkdtemp(prefix="calx_slurm_"))
        self.dir.chmod(0o755)
        self.children = []
        host = socket.gethostname().split(".")[0]
        key = self.dir / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)
        for name in ("state", "spool"):
            (self.dir / name).mkdir()
        self.conf = self.dir / "slurm.conf"
        self.conf.write_text("\n".join((
            "ClusterName=calx", f"SlurmctldHost={host}(127.0.0.1)", "SlurmUser=root",
            f"SlurmctldPort={free_port()}", f"SlurmdPort={free_port()}", "AuthType=auth/munge",
            f"AuthInfo=socket={self.dir}/munge.socket", f"StateSaveLocation={self.dir}/state", f"SlurmdSpoolDir={self.dir}/spool",
            f"SlurmctldPidFile={self.dir}/ctld.pid", f"SlurmdPidFile={self.dir}/slurmd.pid", "ProctrackType=proctrack/linuxproc",
            "TaskPlugin=task/none", "SelectType=select/cons_tres", "SelectTypeParameters=CR_Core", "MpiDefault=none",
            "ReturnToService=2", "AccountingStorageType=accounting_storage/none", "JobAcctGatherType=jobacct_gather/none",
            "SchedulerParameters=sched_min_interval=100000,batch_sched_delay=0", "CredType=cred/munge",
            f"NodeName={host} NodeAddr=127.0.0.1 CPUs={min(2, os.cpu_count())} State=UNKNOWN",
            f"PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP")) + "\n")
        self.env = dict(os.environ, SLURM_CONF=str(self.conf))
        self.start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.dir}/munge.socket",
                   f"--pid-file={self.dir}/munged.pid", f"--seed-file={self.dir}/munged.seed", f"--log-file={self.dir}/munged.log")
        self.wait("munge", lambda: (self.dir / "munge.socket").exists())
        self.start("slurmctld", "-D", "-f", str(self.conf))
        self.start("slurmd", "-D", "-f", str(self.conf), "-N", host)
        self.wait("a node that is idle", lambda: "idle" in self.ask("sinfo", "--noheader", "--format=%t"))

    def start(self, name, *words):
        with open(self.dir / f"{name}.out", "w", encoding="utf-8") as out:
            self.children.append(subprocess.Popen([find(name), *words], env=self.env, stdin=subprocess.DEVNULL, stdout=out,
                                                  stderr=subprocess.STDOUT))

    def ask(self, *words):
        return subprocess.run(words, env=self.env, text=True, capture_output=True, check=False).stdout

    def wait(self, what, there):
        limit = time.monotonic() + 40
        while not there():
            if time.monotonic() > limit:
                logs = "\n".join(f"{p.name}: {p.read_text()[-1500:]}" for p in self.dir.glob("*.out"))
                raise RuntimeError(f"no {what} within 40 s\n{logs}")
            time.sleep(0.1)

    def stop(self):
        for child in reversed(self.children):
            child.terminate()
            try:
                child.wait(20)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()
        shutil.rmtree(self.dir, ignore_errors=True)


class Slurm(CalxTest):
    @classmethod
    def setUpClass(cls):
        cls.cluster = Cluster()

    @classmethod
    def tearDownClass(cls):
        cls.cluster.stop()

    def setUp(self):
        super().setUp()
        self.env = {"SLURM_CONF": str(self.cluster.conf)}
        self.write(cup({"/time/end": 0.04}))
        study = json.loads(json.dumps(STUDY))
        study["executor"] = {"kind": "slurm", "jobs": 4, "options": ["--time=5"]}
        self.write(study, "study.json")

    def test_the_same_result_as_local_runs(self):
        result = self.calx("calibrate", "study.json", "-o", "slurm", env=self.env)
        self.assertEqual(result.code, 0, result.err)
        self.assertEqual(self.calx("calibrate", "study.json", "-o", "local", "--executor", "local").code, 0)
        for name in ("calibration.json", "samples.csv"):
            self.assertEqual((self.dir / "slurm" / name).read_bytes(), (self.dir / "local" / name).read_bytes())
        cost = json.loads((self.dir / "slurm" / "cost.json").read_text())
        self.assertEqual((cost["executor"], cost["cached"]), ("slurm", 0))
        jobs = list((self.dir / "slurm" / "runs").glob("*/job.txt"))
        self.assertEqual(len(jobs), cost["runs"])

    def test_jobs_of_a_killed_study_are_waited_for(self):
        self.write(cup({"/time/end": 0.4}))
        process = subprocess.Popen([CALX, "calibrate", "study.json", "-o", "out"], cwd=self.dir, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=dict(os.environ, **self.env))
        parts = lambda: {p.parent.stem: p.read_text() for p in (self.dir / "out" / "runs").glob("*.part/job.txt")}
        limit = time.monotonic() + 40
        while len(parts()) < 4 and time.monotonic() < limit:
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
        process.wait(60)
        left = parts()
        self.assertGreater(len(left), 0)
        result = self.calx("calibrate", "study.json", "-o", "out", env=self.env)
        self.assertEqual(result.code, 0, result.err)
        for key, job in left.items():
            self.assertEqual((self.dir / "out" / "runs" / key / "job.txt").read_text(), job, "the run was handed in twice")

    def test_a_job_that_is_cancelled(self):
        self.write(cup({"/time/end": 3}))
        process = subprocess.Popen([CALX, "calibrate", "study.json", "-o", "out"], cwd=self.dir, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=dict(os.environ, **self.env))
        self.addCleanup(process.stderr.close)
        limit = time.monotonic() + 40
        queued = lambda: self.cluster.ask("squeue", "--noheader", "--format=%i").split()
        while len(queued()) < 4 and time.monotonic() < limit:
            time.sleep(0.1)
        # Ctrl-C takes the study's jobs out of the queue.
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(60), 130)
        while queued() and time.monotonic() < limit:
            time.sleep(0.1)
        self.assertEqual(queued(), [])

    def test_options_that_slurm_refuses(self):
        study = json.loads((self.dir / "study.json").read_text())
        study["executor"]["options"] = ["--partition=none"]
        self.write(study, "study.json")
        self.fails(6, "sbatch refused a run: .*partition", result=self.calx("calibrate", "study.json", env=self.env))


if __name__ == "__main__":
    missing = [p for p in PROGRAMS if not find(p)]
    if missing or os.geteuid() != 0:
        print("skipped:", "no " + ", ".join(missing) if missing else f"needs root, this is {getpass.getuser()}")
        sys.exit(77)
    unittest.main(verbosity=2)
