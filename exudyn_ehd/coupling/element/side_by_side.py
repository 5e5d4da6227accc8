"""The films of one system on several threads, with the bits of one thread.

Exudyn asks one film after the other for its force, and then for its Jacobian. The first one that is asked at a new
state has the films of all joints evaluated there, each on the thread that is free next; the others find theirs done. A
film is a function of its own motion and memory, and its model belongs to it alone: it makes no difference on which
thread it is evaluated, nor when. Only the evaluations run on threads. What Exudyn is asked and told, and what accepted
steps record, stays where it was.

A film that another call has evaluated is taken only where its own call comes with the same coordinates, bit by bit;
else it is evaluated there. What would be evaluated without being asked for would start the next evaluation elsewhere,
to rounding: so films go side by side only behind `ENOUGH` states in a row at which all were asked at the coordinates
that the system had at the first call, which is not so where a model changes states between its joints. By then their
kernels are compiled, too. An error of an evaluation is dropped, and met again in the film's own call; one of an
accepted step ends the run at once.

Python runs on one thread at a time: what goes side by side is the film's solution, a compiled call that does without
Python's lock. It is 0.7 of an evaluation with its tangent on 48 x 6, 0.85 on 96 x 10, 0.9 on 192 x 16, and 0.3, 0.5 and
0.7 of a step of a rotor on its film: on two cores no run can be more than 1.2, 1.3 and 1.6 times as fast. Runs of
twelve rotors were 1.0, 1.1 and 1.5 times as fast; a thread waits for the lock some 20 us.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress

import exudyn as exu

from exudyn_ehd.coupling.contract import CURRENT, Trial
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.kernels.ahead import cores
from exudyn_ehd.status import Status, require_integer

# States in a row at which all films were asked as expected, before they go side by side.
ENOUGH = 4


class SideBySide:
    """The films of one system during a run.

    Parameters
    ----------
    films : sequence of FilmElement
        Films of all joints, each in its own model.
    threads : int
        More than one.

    Attributes
    ----------
    shared : int
        Rounds that the threads have shared.
    """

    def __init__(self, films: Sequence[FilmElement], threads: int) -> None:
        self.films, self.helpers, self.shared = films, threads - 1, 0
        self._pool = ThreadPoolExecutor(self.helpers, thread_name_prefix="exudyn_ehd film")
        self._agreed = 0
        self._expected: dict[FilmElement, tuple[list[float], list[float]]] = {}
        # those that are asked for Jacobians
        self._derived: set[FilmElement] = set()

    def close(self) -> None:
        """End the threads."""
        self._pool.shutdown()

    def evaluate(self, mbs: exu.MainSystem, t: float, asked: FilmElement, trial: Trial) -> None:
        """``asked`` is asked for its force at ``trial``: evaluate it with all others if it is the first to be there."""
        expected = self._expected.pop(asked, None)
        here = trial.q, trial.q_t
        if expected == here or (expected is None and trial is asked.last):
            return
        # another state than expected, or films that were not asked at the last one
        self._agreed = 0 if expected is not None or self._expected else self._agreed + 1
        others = [film for film in self.films if film is not asked]
        self._expected = {film: film.read(mbs, CURRENT) for film in others}
        if self._agreed < ENOUGH:
            return
        trials = [(asked, trial), *((film, film.arrive(mbs, t, *self._expected[film])) for film in others)]
        self._share([(film.evaluate, (new,)) for film, new in trials if new is not film.last])

    def derive(self, asked: FilmElement, f_q: float, f_qt: float) -> None:
        """``asked`` is asked for its Jacobian: derive it with all that were asked before and have none yet."""
        self._derived.add(asked)
        if self._agreed >= ENOUGH:
            known = [(film, film.last) for film in self._derived]
            found = [(film, last) for film, last in known if last and last.status is Status.CONVERGED]
            self._share([(film.derive, (last, f_q, f_qt)) for film, last in found if last.lacks(f_q, f_qt)])

    def _share(self, calls: Sequence[tuple[Callable[..., object], tuple[object, ...]]]) -> None:
        """Make all calls, the next one on whichever thread is free."""
        if len(calls) < 2:
            return
        self.shared += 1
        left = iter(calls)
        helpers = [self._pool.submit(_work, left) for _ in range(min(self.helpers, len(calls) - 1))]
        try:
            _work(left)
        finally:
            # also where an interrupt ends the run: nobody may go on with a film that is evaluated still
            for helper in helpers:
                helper.result()


def _work(left: Iterator[tuple[Callable[..., object], tuple[object, ...]]]) -> None:
    for call, arguments in left:
        # it comes again in the film's own call
        with suppress(Exception):
            call(*arguments)


@contextmanager
def side_by_side(where: str, films: Sequence[FilmElement], threads: int | None) -> Iterator[None]:
    """Films on ``threads`` within, None: one for each core; nothing where there is one of either."""
    if threads is not None:
        require_integer(f"{where}.threads", threads, at_least=1)
    threads = min(cores() if threads is None else threads, len(films))
    # films that share a model would meet in its buffers
    if threads < 2 or len({id(film.model) for film in films}) < len(films):
        yield
        return
    crew = SideBySide(films, threads)
    for film in films:
        film.crew = crew
    try:
        yield
    finally:
        for film in films:
            film.crew = None
        crew.close()
