"""Where the runs of a study are done: processes here, a Dask cluster, Slurm."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Protocol

from ..errors import IoError, UsageError
from .point import Task, row_file

Row = dict[str, Any]
Job = tuple[int, dict[str, Any]]  # the number of a run, and its point

# A run whose process dies so many times is a failed one: it brings its process down.
MOST_DEATHS = 3


class Engine(Protocol):
    """Does runs and gives their rows as they end. Runs that it gives no row for are done later."""

    def rows(self, task: Task, jobs: Sequence[Job], folder: pathlib.Path) -> Iterator[Row]:
        """The rows of the jobs, in the order in which they end."""
        ...


def died(number: int, point: dict[str, Any]) -> Row:
    return {"run": number, "status": "failed", "error": "its process died", **point}


class Local:
    """Processes on this machine.

    Args:
        workers: how many at a time; 0: one for each processor that this process may use.
    """

    def __init__(self, workers: int = 0) -> None:
        self.workers = workers or len(os.sched_getaffinity(0))

    def rows(self, task: Task, jobs: Sequence[Job], folder: pathlib.Path) -> Iterator[Row]:
        left = dict(jobs)
        deaths = dict.fromkeys(left, 0)
        alone = False  # after a death one at a time, to find whose run it is
        while left:
            count = 1 if alone else min(self.workers, len(left))
            some = list(left.items())[:1] if alone else list(left.items())
            pool = concurrent.futures.ProcessPoolExecutor(
                count, mp_context=multiprocessing.get_context("spawn"))
            try:
                waiting = {pool.submit(task.run, *job): job[0] for job in some}
                for future in concurrent.futures.as_completed(waiting):
                    number = waiting[future]
                    row = future.result()
                    left.pop(number)
                    yield row
                alone = False
            except concurrent.futures.process.BrokenProcessPool:
                if alone:
                    number, point = some[0]
                    deaths[number] += 1
                    if deaths[number] == MOST_DEATHS:
                        left.pop(number)
                        yield died(number, point)
                alone = True
            finally:
                pool.shutdown(wait=False, cancel_futures=True)
                for process in list((getattr(pool, "_processes", None) or {}).values()):
                    process.terminate()


class Dask:
    """The workers of a Dask cluster (`distributed`), which need the package sinew and the meshes.

    A worker that dies loses nothing: Dask does its runs on another one.

    Args:
        address: of the scheduler, "tcp://host:8786", or a distributed.Client.
    """

    def __init__(self, address: Any) -> None:
        self.address = address

    def rows(self, task: Task, jobs: Sequence[Job], folder: pathlib.Path) -> Iterator[Row]:
        try:
            import distributed as module
        except ImportError:
            raise UsageError("a Dask cluster needs the package distributed",
                             "install python3-distributed") from None
        distributed: Any = module  # it has no types
        own = not isinstance(self.address, distributed.Client)
        client = distributed.Client(self.address, timeout=30) if own else self.address
        try:
            def submit(job: Job) -> Any:
                return client.submit(Task.run, task, *job, pure=False, retries=2)

            jobs_of = {submit(job): job for job in jobs}
            lost = {job[0]: 0 for job in jobs}
            ended = distributed.as_completed(list(jobs_of))
            for future in ended:
                job = jobs_of.pop(future)
                try:
                    row: Row = future.result()
                except (concurrent.futures.CancelledError, distributed.KilledWorker):
                    # A result that died with its worker, or a run that brought workers down.
                    lost[job[0]] += 1
                    if lost[job[0]] < MOST_DEATHS:
                        again = submit(job)
                        jobs_of[again] = job
                        ended.add(again)
                        continue
                    row = died(*job)
                yield row
                future.release()
        finally:
            if own:
                client.close()


class Slurm:
    """A job array of Slurm. The study's folder is one that the nodes see too.

    Args:
        tasks: the number of array tasks, each of which does its share of the runs.
        options: for sbatch: ["--partition=long", "--mem=2G"].
        poll: seconds between looks.
        setup: shell lines before Python starts: "module load python".
    """

    def __init__(self, tasks: int = 8, options: Sequence[str] = (), poll: float = 2.0,
                 setup: str = "") -> None:
        self.tasks, self.options, self.poll, self.setup = tasks, list(options), poll, setup

    def script(self, folder: pathlib.Path, shares: Sequence[Sequence[int]]) -> str:
        """The batch script; task i of the array does the runs of share i."""
        cases = "\n".join(f"  {i}) numbers={','.join(map(str, share))!r} ;;"
                          for i, share in enumerate(shares))
        return (f"#!/bin/bash\n{self.setup}\ncase $SLURM_ARRAY_TASK_ID in\n{cases}\nesac\n"
                f"export PYTHONPATH={shlex.quote(os.pathsep.join(sys.path))}\n"
                f"exec {shlex.quote(sys.executable)} -m sinew.study --runs {shlex.quote(str(folder))} "
                "\"$numbers\"\n")

    def rows(self, task: Task, jobs: Sequence[Job], folder: pathlib.Path) -> Iterator[Row]:
        if shutil.which("sbatch") is None:
            raise UsageError("there is no sbatch here", "run the study on a node of the cluster")
        left = dict(jobs)
        numbers = list(left)
        shares = [numbers[i::self.tasks] for i in range(min(self.tasks, len(numbers)))]
        script = folder / "study.sbatch"
        script.write_text(self.script(folder, shares), encoding="utf-8")
        done = subprocess.run(
            ["sbatch", "--parsable", f"--array=0-{len(shares) - 1}", "--job-name=sinew-study",
             f"--output={folder / 'slurm-%a.log'}", *self.options, str(script)],
            text=True, capture_output=True, check=False)
        if done.returncode != 0:
            raise IoError(f"sbatch: {done.stderr.strip()}", "see the options of sinew.study.Slurm")
        job = done.stdout.strip().split(";")[0]
        try:
            yield from self._collect(job, left, folder)
        finally:
            if left:
                subprocess.run(["scancel", job], check=False, capture_output=True)

    def _collect(self, job: str, left: dict[int, dict[str, Any]], folder: pathlib.Path
                 ) -> Iterator[Row]:
        import json
        while left:
            alive = subprocess.run(["squeue", "--noheader", "--jobs", job], text=True,
                                   capture_output=True, check=False).stdout.strip()
            for number in list(left):
                file = row_file(folder, number)
                if file.exists():
                    left.pop(number)
                    yield json.loads(file.read_text(encoding="utf-8"))
            if not alive:
                return  # the rest was killed: it is done at the next run of the study
            if left:
                time.sleep(self.poll)


def engine_of(on: str | Engine, workers: int) -> Engine:
    """An engine by a word: "local", the address of a Dask scheduler, "slurm"."""
    if not isinstance(on, str):
        return on
    if on == "local":
        return Local(workers)
    if on == "slurm":
        return Slurm(workers or 8)
    if "://" in on:
        return Dask(on)
    raise UsageError(f"there is no engine '{on}'",
                     "\"local\", the address of a Dask scheduler (tcp://host:8786), \"slurm\"")


Progress = Callable[[int, int, float], None]
