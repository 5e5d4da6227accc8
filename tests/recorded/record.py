"""Records of films, of equilibria and of runs in Exudyn.

A film's record has three steps of a run, each with everything that a joint asks of a film. The journal is put to three
places, one after the other, with rates of its own; each film starts from the history that the one before has left, and
from no iterate of it (`forget`). Of each film there is

* its status, force and moment, and two sums of the loads on the coordinates of flexible surfaces;
* the change of these along three random motions, by the tangent;
* the quantities of a history;
* two sums of each field that it leaves to the next step.

An equilibrium's record has the position under a load, stiffness, damping and threshold. A run's has three rows of the
history of thirty steps of `tests.fuzz.mixed_runs`. Sums have the weights sin(k + 1) and cos(2 k) over the numbers k of
vertices or coordinates.
"""

from __future__ import annotations

import dataclasses
import pathlib
import warnings

import numpy as np

import exudyn_ehd as ehd
from exudyn_ehd.joint.solved_film import History
from tests.fuzz import mixed_runs
from tests.recorded.draw import CLEARANCE, bearing_of, model_of, rows

HERE = pathlib.Path(__file__).parent
STATES, DIRECTIONS = 3, 3
# Rows of ``bearings.csv`` whose films are recorded: those added behind them are for the contracts alone.
RECORDED = 2000
STEP = 2e-4  # s
QUANTITIES = (
    "bush_temperature",
    "clearance",
    "contact_load",
    "contact_power_loss",
    "contact_torque",
    "film_temperature",
    "friction_torque",
    "friction_torque_bush",
    "journal_temperature",
    "leakage_lower",
    "leakage_upper",
    "minimum_gap",
    "peak_contact_pressure",
    "peak_pressure",
    "peak_temperature",
    "power_loss",
    "stored_power",
    "supply_flow",
)
# of a film's memory; no bearing here has pockets behind restrictors, or a sump; temperatures and voids of the next step
# show the rates of the last one
_OTHERS = ("pockets", "sump", "leaving", "heating", "last_step", "growth")
FIELDS = tuple(f.name for f in dataclasses.fields(History) if f.name not in _OTHERS)
LOADS = tuple(f"force {x}" for x in "xyz") + tuple(f"moment {x}" for x in "xyz") + ("load 1", "load 2")
COLUMNS = (
    ("status",)
    + LOADS
    + tuple(f"d{k} {name}" for k in range(1, DIRECTIONS + 1) for name in LOADS)
    + QUANTITIES
    + tuple(f"{name} {k}" for name in FIELDS for k in (1, 2))
)


def _sums(values):
    """Two sums (2, ...) of values (n, ...)."""
    k = np.arange(len(values))
    return np.array([np.sin(k + 1.0), np.cos(2.0 * k)]) @ values


def _loads(wrench, bore):
    """Wrench (6, ...) and two sums of the loads on bore coordinates (k, ...)."""
    return np.concatenate((wrench, _sums(bore) if len(bore) else np.zeros((2, *wrench.shape[1:]))))


def motions(rng, length, coordinates):
    """Three motions (3, 10 + 2 k) of a journal, and directions (3, 3, 10 + 2 k) with units of its size."""
    unit = np.concatenate(
        (
            [CLEARANCE] * 2 + [CLEARANCE / length] * 2 + [1e-2] * 2 + [1e-2 / length] * 2 + [100.0, 0.1],
            [0.05 * CLEARANCE] * coordinates + [1e-3] * coordinates,
        )
    )
    out = rng.normal(size=(STATES, unit.size)) * unit
    for motion in out:
        eps, a, share = rng.uniform(0.1, 0.85), rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.0, 0.8)
        motion[:2] = eps * CLEARANCE * np.cos(a), eps * CLEARANCE * np.sin(a)
        motion[2:4] *= share * (1.0 - eps) / max(1e-9, float(np.hypot(*motion[2:4])) / (2.0 * CLEARANCE / length))
        motion[8] = rng.choice([-1.0, 1.0]) * rng.uniform(50.0, 400.0)
        motion[10 : 10 + coordinates] *= 0.2
    return out, rng.normal(size=(STATES, DIRECTIONS, unit.size)) * unit


def steps(model, seed):
    """Yield (motion, history before, evaluation, directions) of three steps of a run, up to the first without a film.

    Parameters
    ----------
    model : BearingModel
    seed : int
        Of the motions.
    """
    k = model.bore.size if model.flexible else 0
    motion, directions = motions(np.random.default_rng([seed, 7]), model.bearing.length, k)
    start = motion[0].copy()
    start[4:8] = 0.0
    history = model.initial_history(start[:10])
    for n in range(STATES):
        model.forget()
        evaluation = model.evaluate(motion[n], history, STEP)
        found = evaluation.status is ehd.Status.CONVERGED
        # read now: who takes the evaluation may put the model to other states
        after = evaluation.history() if found else None
        yield motion[n], history, evaluation, directions[n]
        if not found:
            return
        history = after


def film_record(row, seed):
    """Numbers (3, columns) of a row's bearing.

    Parameters
    ----------
    row : dict
        As `tests.recorded.draw.bearing_of` takes it.
    seed : int
        Of the motions.
    """
    out = np.full((STATES, len(COLUMNS)), np.nan)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for n, (_, _, evaluation, directions) in enumerate(steps(model_of(row), seed)):
            out[n, 0] = evaluation.status.value
            if evaluation.status is not ehd.Status.CONVERGED:
                break
            tangent, values, history = (
                evaluation.tangent() @ directions.T,
                evaluation.quantities(),
                evaluation.history(),
            )
            # a film that remembers nothing leaves no history
            kept = [getattr(history, name, None) for name in FIELDS]
            bore = getattr(evaluation, "bore", None)
            out[n, 1:] = np.concatenate(
                (
                    _loads(evaluation.wrench, np.zeros(0) if bore is None else bore.load),
                    _loads(tangent[:6], tangent[6:]).T.ravel(),
                    [values.get(name, np.nan) for name in QUANTITIES],
                    *(np.full(2, np.nan) if x is None else _sums(np.ravel(x)) for x in kept),
                )
            )
    return out


EQUILIBRIUM = (
    ("x", "y")
    + tuple(f"K{a}{b}" for a in "xy" for b in "xy")
    + tuple(f"C{a}{b}" for a in "xy" for b in "xy")
    + ("whirl ratio", "critical mass", "minimum gap", "peak pressure", "power loss", "leakage")
)


def equilibrium_record(row, seed):
    """Numbers (1, columns) of a row's bearing under a random load; nan where no equilibrium was found."""
    rng = np.random.default_rng([seed, 11])
    bearing = bearing_of(row)
    speed, a = rng.uniform(100.0, 400.0), rng.uniform(0.0, 2.0 * np.pi)
    size = 10.0 ** rng.uniform(-1.0, 0.3) * bearing.reference_force(speed)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            found = ehd.equilibrium(bearing, speed=speed, load=(size * np.cos(a), size * np.sin(a)))
        except ehd.EHDError:
            return np.full((1, len(EQUILIBRIUM)), np.nan)
    film = found.film
    values = (*found.position, *found.stiffness.flat, *found.damping.flat, found.whirl_ratio, found.critical_mass)
    values += (film.minimum_gap, film.peak_pressure, film.power_loss, film.leakage)
    return np.nan_to_num(np.array([values]), nan=np.nan, posinf=-1.0)


RUN = (
    ("time", "x", "y", "bx", "by", "spin")
    + tuple(f"force {x}" for x in "xyz")
    + ("minimum gap", "peak pressure", "loss")
)
RUNS = tuple((kind, seed) for kind in mixed_runs.KINDS for seed in range(4))
RUN_STEPS = 30


def run_record(kind, seed):
    """Rows (3, columns) of a run's history after a third of its steps, two thirds, and all of them."""
    # tight: with the default 1e-6 another machine may take one iteration more or less, which is 3e-5 of a pressure
    out = mixed_runs.run(mixed_runs.draw(seed, kind), RUN_STEPS / mixed_runs.STEPS, relativeTolerance=1e-8)
    h = out.history
    values = np.column_stack(
        (h.time, h.motion[:, [0, 1, 2, 3, 8]], h.force, h.minimum_gap, h.peak_pressure, h.power_loss)
    )
    # times of whole steps, halved or not
    return values[np.searchsorted(h.time, h.time[-1] * (np.arange(1, STATES + 1) / STATES - 1e-9))]


def film_rows():
    """Places and rows of the bearings whose films are recorded.

    Coordinates of modal bushes hang on the choice of a basis among modes alike, which round-off makes: their films are
    recorded by equilibria and runs.
    """
    return [(k, row) for k, (_, row) in enumerate(rows()[:RECORDED]) if row["surfaces"] not in ("modal bush", "both")]


def steady_rows():
    """Places and rows of the bearings whose equilibria are recorded."""
    steady = [
        (k, row) for k, (_, row) in enumerate(rows()) if row["squeeze"] == "on" and row["supply"] != "turning hole"
    ]
    return steady[:200]


def records(kind):
    """Calls that make the records of a kind, in their order.

    Parameters
    ----------
    kind : str
        "films", "equilibria" or "runs".
    """
    if kind == "films":
        return [lambda row=row, k=k: film_record(row, k) for k, row in film_rows()]
    if kind == "runs":
        return [lambda run=run: run_record(*run) for run in RUNS]
    return [lambda row=row, k=k: equilibrium_record(row, k) for k, row in steady_rows()]


COLUMNS_OF = {"films": COLUMNS, "equilibria": EQUILIBRIUM, "runs": RUN}
# Columns that count beside each other, as components of one vector or matrix, or as the two sums of one field, of which
# one may vanish.
KINDS_OF = {
    "films": [[p + n for n in group] for p in ("", "d1 ", "d2 ", "d3 ") for group in (LOADS[:3], LOADS[3:6], LOADS[6:])]
    + [[f"{name} 1", f"{name} 2"] for name in FIELDS],
    "equilibria": [EQUILIBRIUM[:2], EQUILIBRIUM[2:6], EQUILIBRIUM[6:10], ["critical mass"], ["leakage"]],
    "runs": [RUN[1:3], RUN[3:5], RUN[6:9]],
}

# Sizes below which components are round-off: rad; kg and m^3/s of films without a cavity and without a supply, whose
# sums vanish to 1e-9 kg and 1e-19 m^3/s, while others are above 0.1 kg and 1e-8 m^3/s.
LEAST = {"bx": 1e-6, "critical mass": 1e-3, "leakage": 1e-12}


def read(kind):
    """Stored records (n, k, columns) of a kind."""
    with np.load(HERE / f"{kind}.npz") as file:
        return file["values"]


def differences(kind, found, expected):
    """Largest difference of each column (columns,) over its largest size in the record; inf where one is nan alone.

    Parameters
    ----------
    kind : str
        As in `records`.
    found, expected : (k, columns) arrays
    """
    columns, both = COLUMNS_OF[kind], np.isnan(found) & np.isnan(expected)
    size = np.abs(np.where(np.isnan(expected), 0.0, expected)).max(axis=0)
    for group in KINDS_OF[kind]:
        places = [columns.index(name) for name in group]
        size[places] = max(size[places].max(), LEAST.get(group[0], 0.0))
    off = np.where(both, 0.0, np.abs(found - expected))
    with np.errstate(invalid="ignore", divide="ignore"):
        relative = np.where(off == 0.0, 0.0, off / size)
    return np.where(np.isnan(relative), np.inf, relative).max(axis=0)


def main(kind, first=0, last=None):
    """Record the rows from ``first`` to ``last`` of a kind anew; all others stay."""
    calls = records(kind)
    last = len(calls) if last is None else last
    stored = read(kind) if (HERE / f"{kind}.npz").exists() else None
    fresh = [call() for call in calls[first:last]]
    if stored is None or stored.shape[1:] != fresh[0].shape or len(stored) != len(calls):
        stored = np.full((len(calls), *fresh[0].shape), np.nan)
    stored[first:last] = fresh
    # eleven digits are compared at most; the rest of them would only make the file larger
    exponent = np.floor(np.log2(np.where((stored == 0.0) | np.isnan(stored), 1.0, np.abs(stored))))
    unit = 2.0 ** (exponent - 40.0)
    np.savez_compressed(HERE / f"{kind}.npz", values=np.round(stored / unit) * unit)
