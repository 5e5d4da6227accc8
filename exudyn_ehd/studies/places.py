"""Where the rows of a study are computed: in this process, in several, on MPI ranks, on hosts, by an executor.

Every place is an iterator over ``(index, row)`` as they are finished. What ends a worker ends its row alone, except
under MPI, which ends a run whose rank has died: there, the file of a study keeps what was finished.
"""

from __future__ import annotations

import importlib.util
import inspect
import json
import math
import multiprocessing
import pickle
import signal
import textwrap
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, as_completed
from multiprocessing.connection import Connection, wait
from typing import Any

from exudyn_ehd.status import EHDError, InputError
from exudyn_ehd.studies.rows import Function, Point, Row, as_numbers, evaluated

Rows = Iterator[tuple[int, Row]]
_WHERE = "parameter_study"
# s, until a host must have taken a row, between signs of life of a host, and between looks at them
_HOSTS_ANSWER, _PULSE, _LOOK = 60.0, 5.0, 0.05
# Parts that the rows of a study go to an executor in: one of them is what its slowest worker ends late by.
_MOST_PARTS = 512


def here(function: Function, points: Mapping[int, Point]) -> Rows:
    """One after the other in this process."""
    for index, point in points.items():
        yield index, evaluated(function, point)


def in_processes(function: Function, points: Mapping[int, Point], count: int) -> Rows:
    """In ``count`` processes; one that dies loses its row, and another takes its place.

    A row that ends its process (a crash, the system for lack of memory) says how.
    """
    require_picklable(function)
    left = list(points.items())[::-1]
    busy: dict[Connection, tuple[Any, int]] = {}
    idle: list[tuple[Connection, Any]] = []
    try:
        while left or busy:
            while left and len(busy) < count:
                pipe, process = idle.pop() if idle else _started(function, [*busy])
                index, point = left.pop()
                busy[pipe] = (process, index)
                pipe.send(point)
            ready = wait(list(busy))
            for pipe in [pipe for pipe in busy if pipe in ready]:
                process, index = busy.pop(pipe)
                try:
                    row: Row = pipe.recv()
                    idle.append((pipe, process))
                except (EOFError, ConnectionResetError):
                    process.join()
                    row = Row({}, f"the process of this row {_death(process.exitcode)}")
                yield index, row
    finally:
        for process in [p for p, _ in busy.values()] + [p for _, p in idle]:
            process.terminate()
            process.join()


def _started(function: Function, others: list[Connection]) -> tuple[Connection, Any]:
    own, theirs = multiprocessing.Pipe()
    process = multiprocessing.Process(target=_serve, args=(function, theirs, [own, *others]), daemon=True)
    process.start()
    theirs.close()
    return own, process


def _serve(function: Function, pipe: Connection, others: list[Connection]) -> None:
    # a copied end of the leader's would keep this process waiting when the leader has gone
    for other in others:
        other.close()
    try:
        while True:
            pipe.send(evaluated(function, pipe.recv()))
    except (EOFError, OSError, KeyboardInterrupt):
        return


def _death(code: int) -> str:
    if code >= 0:
        return f"ended with exit code {code} before it returned"
    name = signal.Signals(-code).name
    return f"was ended by {name}" + (", often for lack of memory" if name == "SIGKILL" else "")


def on_ranks(function: Function, points: Mapping[int, Point]) -> Rows:
    """On the ranks of an MPI run, under ``mpiexec -n N python -m mpi4py.futures``."""
    require_picklable(function)
    how = f"{_WHERE}: mpi needs a start by 'mpiexec -n 5 python -m mpi4py.futures study.py'"
    try:
        from mpi4py import MPI
        from mpi4py.futures import MPIPoolExecutor, _core
    except (ImportError, RuntimeError) as error:
        raise InputError(f"{how} and an MPI library; mpi4py says: {str(error).splitlines()[0]}") from None
    if MPI.COMM_WORLD.Get_size() < 2:
        raise InputError(f"{how}; this run has one rank, and nobody would compute.")
    # without it every rank would lead a study of its own and wait for others
    if getattr(_core, "SharedPool", True) is None:
        raise InputError(f"{how}; this one lacks '-m mpi4py.futures'.")
    with MPIPoolExecutor() as pool:
        yield from on_executor(function, points, pool)


def on_executor(function: Function, points: Mapping[int, Point], executor: Executor) -> Rows:
    """By an executor of the caller's, which stays open; what it has not begun is cancelled if the study ends.

    Many rows go in parts, so that sending them takes no share of the time.
    """
    if isinstance(executor, ProcessPoolExecutor):
        require_picklable(function)
    order, size = list(points), math.ceil(len(points) / _MOST_PARTS)
    parts: dict[Future[list[Row]], list[int]] = {}
    try:
        for k in range(0, len(order), size):
            part = order[k : k + size]
            try:
                future = executor.submit(_all_evaluated, function, [points[index] for index in part])
            except RuntimeError as error:
                # an executor that has broken, or was shut down, takes no more
                yield from ((index, Row({}, _lost(error))) for index in part)
                continue
            if not isinstance(future, Future):
                raise InputError(
                    f"{_WHERE}: executor must hand out futures of concurrent.futures, got those of {executor!r}; of a "
                    "dask Client give client.get_executor()."
                )
            parts[future] = part
        for future in as_completed(parts):
            lost: BaseException | None = CancelledError("by the executor") if future.cancelled() else future.exception()
            rows = future.result() if lost is None else [Row({}, _lost(lost))] * len(parts[future])
            yield from zip(parts[future], rows, strict=True)
    finally:
        for future in parts:
            future.cancel()


def _all_evaluated(function: Function, points: list[Point]) -> list[Row]:
    return [evaluated(function, point) for point in points]


def _lost(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def require_executor(executor: object) -> None:
    """Refuse what is no executor, and threads."""
    if not callable(getattr(executor, "submit", None)):
        raise InputError(
            f"{_WHERE}: executor must have a method submit like those of concurrent.futures, got {executor!r}."
        )
    if isinstance(executor, ThreadPoolExecutor):
        raise InputError(
            f"{_WHERE}: executor must compute in processes, got {type(executor).__name__}: threads of one process take "
            "turns in Python and share its log; use concurrent.futures.ProcessPoolExecutor(...)."
        )


def on_hosts(function: Function, points: Mapping[int, Point], hosts: Sequence[str]) -> Rows:
    """On hosts that run dispy's node server; every row in an interpreter of its own, so that a crash ends it alone."""
    import dispy

    code = _program(function)
    # dispy finds the address that hosts can reach, but for a host that is this machine
    own = all(host == "localhost" or host.startswith("127.") for host in hosts)
    cluster = dispy.JobCluster(
        _on_host, nodes=list(hosts), host="127.0.0.1" if own else None, pulse_interval=_PULSE, loglevel=30
    )
    start, taken = time.monotonic(), False
    jobs = {index: cluster.submit(code, json.dumps(point)) for index, point in points.items()}
    try:
        while jobs:
            for index in [index for index, job in jobs.items() if job.finish.is_set()]:
                taken = True
                yield index, _host_row(jobs.pop(index))
            taken = taken or any(job.status != dispy.DispyJob.Created for job in jobs.values())
            if not taken and time.monotonic() - start > _HOSTS_ANSWER:
                raise EHDError(
                    f"{_WHERE}: none of the hosts {', '.join(hosts)} has taken a row within {_HOSTS_ANSWER:g} s; start "
                    "dispynode.py there, of the same version of dispy, and check names and firewalls."
                )
            time.sleep(_LOOK)
    finally:
        cluster.close(timeout=1, terminate=True)


def _host_row(job: Any) -> Row:
    if job.result is not None:
        code, out, err, seconds = job.result
        if code == 0:
            try:
                return Row(as_numbers(json.loads(out.splitlines()[-1])), "", seconds)
            except (ValueError, IndexError) as error:
                return Row({}, " ".join(f"{type(error).__name__}: {error}".split()), seconds)
        last = (err or "").strip().splitlines()
        died = last[-1] if code == 1 and last else f"the process of this row {_death(code)}"
        return Row({}, died, seconds)
    return Row({}, f"the host gave no result: {(job.exception or 'it has gone').strip().splitlines()[-1]}")


def _on_host(code, point):
    """What dispy runs on a host; its source alone goes there, where annotations mean nothing."""
    import subprocess
    import sys
    import time

    start = time.perf_counter()
    done = subprocess.run([sys.executable, "-c", code, point], capture_output=True, text=True)
    return done.returncode, done.stdout, done.stderr, time.perf_counter() - start


def _program(function: Any) -> str:
    """A plain function as a program: it takes a point as JSON and prints results as JSON."""
    try:
        source = textwrap.dedent(inspect.getsource(function))
    except (OSError, TypeError):
        source = ""
    if not source.startswith("def "):
        raise InputError(
            f"{_WHERE}.function must be a plain function for hosts, defined with def in a file: they get its source "
            "alone; let it import what it needs."
        )
    call = f"{function.__name__}(json.loads(sys.argv[1]))"
    numbers = "{name: float(x) for name, x in value.items()} if hasattr(value, 'items') else float(value)"
    return f"{source}\nimport json, sys\nvalue = {call}\nprint()\nprint(json.dumps({numbers}))\n"


def require_picklable(function: Any) -> None:
    """Refuse what can't be sent to other processes."""
    try:
        pickle.dumps(function)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise InputError(
            f"{_WHERE}.function can't be sent to other processes ({error}); define it at the top of a module, not as a "
            "lambda or inside another function."
        ) from None


def require_package(place: str, package: str) -> None:
    """Refuse a place whose package is not installed."""
    if importlib.util.find_spec(package) is None:
        raise InputError(
            f"{_WHERE}: {place} needs the package {package}, which is not installed; pip install {package}."
        )
