#!/usr/bin/env python3
"""Flies a batch in shards on the engines of others, with the job files that docs/batch.md shows.

usage: run.py BIN WORK

BIN holds the programs, WORK is a folder for files. Slurm runs on this computer only, with a configuration, key and ports of its
own. Of the Kubernetes job, the manifest is read and its command is run for each index; it is not given to a cluster.
"""
import json
import os
import pathlib
import pwd
import re
import shutil
import signal
import socket
import subprocess
import sys
import time

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "docs" / "site"))
from manual_text import fences  # noqa: E402

PAGE = ROOT / "docs" / "batch.md"
DEADLINE_S = 60
SHOWN_RUNS, RUNS = "--runs 200", "--runs 40"  # in the manual, and here


def require(holds, what):
    if not holds:
        sys.exit(f"shards: {what}")


def shown_files():
    """The job files of the manual by name, with fewer runs."""
    named = ((re.fullmatch(r"file: (\S+)", fence.words), fence.text) for fence in fences(PAGE.read_text(), PAGE))
    files = {name[1]: text for name, text in named if name}
    for name, text in files.items():
        require(SHOWN_RUNS in text, f"{name}: has no {SHOWN_RUNS}")
    return {name: text.replace(SHOWN_RUNS, RUNS) for name, text in files.items()}


class Slurm:
    """munged, slurmctld and slurmd of this computer alone, as the present user."""

    def __init__(self, folder):
        folder.mkdir()
        for state in ("state", "spool"):
            (folder / state).mkdir(mode=0o755)
        self.folder, self.daemons = folder, []
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
        (folder / "slurm.conf").write_text(self.configuration())
        version = re.search(r"(\d+)\.", subprocess.run(["slurmd", "-V"], capture_output=True, text=True, check=True).stdout)
        if int(version[1]) >= 23:  # earlier ones know no plugin of this name, and do without cgroups unless told
            (folder / "cgroup.conf").write_text("CgroupPlugin=disabled\n")
        key = folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o400)

    def configuration(self):
        host, user = socket.gethostname().partition(".")[0], pwd.getpwuid(os.getuid()).pw_name
        with socket.socket() as first, socket.socket() as second:
            for one in (first, second):
                one.bind(("127.0.0.1", 0))
            ports = [one.getsockname()[1] for one in (first, second)]
        cores = os.cpu_count()
        return f"""ClusterName=swiftlet
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={self.folder}/munge.socket
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES State=UP
"""

    def start(self, *command):
        log = (self.folder / f"{pathlib.Path(command[0]).name}.log").open("w")
        self.daemons.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=subprocess.STDOUT))

    def __enter__(self):
        at = self.folder
        self.start("munged", "--foreground", f"--socket={at}/munge.socket", f"--key-file={at}/munge.key",
                   f"--pid-file={at}/munged.pid", f"--log-file={at}/munged.log", f"--seed-file={at}/munge.seed")
        self.wait_for(lambda: (at / "munge.socket").exists(), "munged does not listen")
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        self.wait_for(lambda: "idle" in self.run("sinfo", "--noheader", "--format=%t").stdout, "no node is idle")
        return self

    def __exit__(self, *_):
        for daemon in reversed(self.daemons):
            daemon.send_signal(signal.SIGTERM)
        for daemon in self.daemons:
            daemon.wait(DEADLINE_S)

    def wait_for(self, holds, what):
        until = time.monotonic() + DEADLINE_S
        while not holds():
            require(time.monotonic() < until and all(daemon.poll() is None for daemon in self.daemons),
                    f"{what}; the logs are in {self.folder}")
            time.sleep(0.05)

    def run(self, *command, **options):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=DEADLINE_S, check=False,
                              **options)


class Shards:
    def __init__(self, programs, work):
        self.programs, self.work, self.files = programs, work, shown_files()
        os.environ["PATH"] = f"{programs}:{os.environ['PATH']}"
        os.environ["SWIFTLET_CONFIG_DIR"] = str(ROOT / "config")
        self.whole = self.swiftlet("batch", "square", *RUNS.split(), "--seed", "1", "--dispersion", "kaylion", "--out", "whole")

    def swiftlet(self, *words):
        done = subprocess.run([self.programs / "swiftlet", "sim", *words, "--json"], cwd=self.work, capture_output=True, text=True,
                              check=False)
        require(done.returncode == 0, f"swiftlet sim {' '.join(words)}: exit code {done.returncode}: {done.stderr}")
        return json.loads(done.stdout)

    def folder(self, name):
        """An empty folder with the job file of the manual."""
        made = self.work / name
        made.mkdir()
        return made

    def check(self, engine, folder, count):
        """The merged shards are the batch that was flown without."""
        parts = sorted(folder.glob("shards/*"))
        require(len(parts) == count, f"{engine}: {len(parts)} shards were flown, must be {count}")
        merged = self.swiftlet("merge", *map(str, parts), "--out", str(folder / "merged"))
        for file in ("batch.csv", "batch.png"):
            require((folder / "merged" / file).read_bytes() == (self.work / "whole" / file).read_bytes(),
                    f"{engine}: {file} differs from that of the whole batch")
        for own in ("wall_s", "out_dir"):
            merged[own] = self.whole[own]
        require(merged == self.whole, f"{engine}: the report differs from that of the whole batch")
        print(f"shards: {engine}: {count} shards, merged byte for byte as the batch of {merged['runs']} runs in one process")

    def run_parallel(self):
        folder = self.folder("parallel")
        (folder / "shards.sh").write_text(self.files["shards.sh"])
        done = subprocess.run(["bash", "-e", "shards.sh"], cwd=folder, capture_output=True, text=True, check=False)
        require(done.returncode == 0, f"GNU parallel: exit code {done.returncode}: {done.stderr}")
        self.check("GNU parallel", folder, 8)

    def run_slurm(self):
        folder = self.folder("slurm")
        (folder / "shards.sbatch").write_text(self.files["shards.sbatch"])
        with Slurm(self.work / "engine") as slurm:
            done = slurm.run("sbatch", "--wait", "shards.sbatch", cwd=folder)
            logs = "".join(file.read_text() for file in folder.glob("*.out"))
            require(done.returncode == 0, f"Slurm: exit code {done.returncode}: {done.stderr}{logs}")
        self.check("Slurm", folder, 8)

    def run_kubernetes_command(self):
        folder = self.folder("kubernetes")
        job = yaml.safe_load(self.files["shards.yaml"])
        spec, template = job["spec"], job["spec"]["template"]["spec"]
        require((job["apiVersion"], job["kind"], spec["completionMode"]) == ("batch/v1", "Job", "Indexed"), "shards.yaml: no indexed job")
        require(template["restartPolicy"] in ("Never", "OnFailure"), "shards.yaml: a job must not restart always")
        (container,) = template["containers"]
        (mount,) = container["volumeMounts"]
        require([mount["name"]] == [volume["name"] for volume in template["volumes"]], "shards.yaml: the volume has another name")
        command = [word.replace(mount["mountPath"], str(folder)) for word in container["command"]]
        for index in range(spec["completions"]):
            done = subprocess.run(command, env={**os.environ, "JOB_COMPLETION_INDEX": str(index)}, cwd="/", capture_output=True,
                                  text=True, check=False)
            require(done.returncode == 0, f"shards.yaml: index {index}: exit code {done.returncode}: {done.stderr}")
        self.check("the command of the Kubernetes job", folder, spec["completions"])


def main(programs, work):
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    shards = Shards(programs, work)
    shards.run_parallel()
    shards.run_slurm()
    shards.run_kubernetes_command()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
