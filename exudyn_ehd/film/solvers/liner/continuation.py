"""Start of a film on a liner without a usable last film; see `exudyn_ehd.film.solvers.liner.film`.

Newton's method starts from a dry guess. If it fails, pseudo-transient continuation follows: an additional storage at
every vertex slows the film down and is reduced step by step.
"""

from __future__ import annotations

import numpy as np

from exudyn_ehd.film.cavitation.pseudo_time import pseudo_time
from exudyn_ehd.film.cavitation.states import OIL, RUPTURE
from exudyn_ehd.film.cavitation.steady_oil import has_unfed_row
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureTransform
from exudyn_ehd.film.solvers.liner.film import LinerFilm
from exudyn_ehd.status import Status

# Limits of a dry guess: gap over the clearance that it may always open, and share of an oil's largest pressure that it
# may always have.
OPEN, MODERATE = 0.01, 0.1
# Gap over the clearance below which a dry guess opens the liner.
THIN = 0.1
# Share of an oil's largest pressure above which a film that is not found gets NO_PRESSURE.
NEARLY_SOLID = 0.9


def cold_start(film: LinerFilm) -> tuple[bool, int]:
    """Solve by Newton's method from a dry guess; returns (found, steps). A mass-conserving film is first solved without
    mass conservation."""
    film.film.work.warm, first = False, 0
    _dry_guess(film)
    if film.kind == OIL:
        film.take_kind(RUPTURE)
        ok, first = film.solve()
        film.take_kind(OIL)
        if not ok:
            return False, first
    ok, steps = film.solve()
    return ok, first + steps


def _dry_guess(film: LinerFilm) -> None:
    """Set a full film as the initial guess. Without a contact, its pressure opens gaps below `THIN` to `THIN`, within
    the limits of `_transformed`; in a film at rest it is at most the largest prescribed pressure. Curves open the liner
    by `THIN` at most."""
    H0 = film.rigid[0]
    # curves of a nearly shut gap have pressures that would open it by many clearances
    guess, most = np.zeros(H0.shape), np.full(H0.shape, THIN / max(film.beta, 1e-300))
    if film.contact is None and H0.min() < THIN and film.beta > 0.0:
        guess = np.maximum((THIN - H0) / film.beta, 0.0)
    if film.oil is not None and film.beta > 0.0:
        guess, most = _transformed(film, film.oil, guess), _transformed(film, film.oil, most)
    fixed = film.film.grid.fixed
    if _at_rest(film):
        guess = np.minimum(guess, film.P[fixed].max(initial=0.0))
    lowest = film.film.system.cavity_pressure if film.film.ruptures else 0.0
    film.P[~fixed] = np.maximum(guess, lowest)[~fixed]
    film.fill_up(most)


def _at_rest(film: LinerFilm) -> bool:
    """Return whether nothing moves: the pressure then lies between the prescribed ones."""
    still = film.film.vx == film.film.vz == film.rates.liner == film.rates.mass == 0.0
    return still and not film.rigid[2].any()


def _transformed(film: LinerFilm, oil: PressureTransform, guess: np.ndarray) -> np.ndarray:
    """Unknowns of guessed pressures (n, m), limited to the larger of what opens the gap to `OPEN` and the share
    `MODERATE` of the oil's largest pressure."""
    touching = np.maximum((OPEN - film.rigid[0]) / film.beta, 0.0)
    p = np.minimum(guess, np.maximum(touching, MODERATE * oil.largest_pressure / film.scale))
    return oil.transform(np.minimum(p * film.scale, oil.largest_pressure)) / film.scale


def pseudo_transient(film: LinerFilm) -> tuple[bool, int]:
    """Solve by pseudo-transient continuation from a dry guess; returns (found, Newton steps).

    The implicit steps in pseudo time grow; the last solution has no additional storage.
    """
    f, work, rates = film.film, film.film.work, film.rates
    work.warm = False
    _dry_guess(film)
    rate = abs(f.vx) + abs(f.vz) + float(np.max(np.abs(film.rigid[2]))) + rates.liner + rates.mass + 1e-300
    start = film.P.copy(), film.fill.copy(), work.active.copy()
    film.balance()

    def attempt(extra: float) -> tuple[bool, int]:
        film.rates = rates._replace(pseudo=extra)
        film.pseudo_old[:] = _stored(film)
        ok, steps = film.solve()
        film.rates, work.ready = rates, work.ready and extra == 0.0
        work.warm = work.warm or ok
        for field, other in zip((film.P, film.fill, work.active), start, strict=True):
            (other if ok else field)[:] = field if ok else other
        if not ok:
            film.balance()
        return ok, steps

    return pseudo_time(attempt, rate)


def _stored(film: LinerFilm) -> np.ndarray:
    """Quantity (n, m) that pseudo time stores at the present state: mass, or the deflection by the film's unclipped
    pressure."""
    if film.kind != OIL:
        return film.beta * (film.load.p + (film.P - film.load.drive))
    return film.film.content


def failure(film: LinerFilm) -> Status:
    """Status of a film that was not found."""
    f, s, rigid = film.film, film.film.system, film.rigid
    # in pseudo time it ended with the last film that it found
    unfed = s.turns > 0.0 and has_unfed_row(s.linear_pressure, f.H, s.fixed, s.turns, s.cavity_pressure)
    if unfed and not rigid[2].any():
        return Status.NO_OIL
    if film.oil is not None and float(film.load.p.max()) * film.scale > NEARLY_SOLID * film.oil.largest_pressure:
        return Status.NO_PRESSURE
    if film.contact is not None or film.beta == 0.0:
        return Status.NOT_CONVERGED
    # tension may pull the liner shut: without cavitation, or by the cavity's own pressure
    shut = not f.ruptures or float(rigid[0].min()) + film.beta * film.cavity_load <= 0.0
    return Status.NO_FILM if shut else Status.NOT_CONVERGED
