"""Films, equilibria and runs are those of the records."""

import numpy as np
import pytest

from tests.contracts.test_evaluation import QUICK
from tests.recorded import record
from tests.sampling import covering_places

# Films come from direct solutions and from iterations that end at round-off; equilibria end at 1e-8 of the load; in a
# run each step ends at 1e-8 of the forces, and thirty of them let the round-off of another machine grow.
TOLERANCES = {"films": 1e-9, "equilibria": 1e-6, "runs": 1e-6}
# Iterations that end at a tolerance of their own: heat, shear thinning.
EARLY = {"carreau", "lumped", "energy", "walls", "across"}
PART = 20
DRAWN = record.film_rows()


def check(kind, places, tolerance):
    """The records at some places of a kind, made anew, are the stored ones."""
    stored, calls = record.read(kind), record.records(kind)
    assert len(stored) == len(calls), f"{kind}: {len(stored)} records of {len(calls)}; record those that are new"
    for k in places:
        off = record.differences(kind, calls[k](), stored[k])
        limit = tolerance(k) if callable(tolerance) else tolerance
        worst = int(np.argmax(off))
        assert off[worst] <= limit, f"{kind} {k}: {record.COLUMNS_OF[kind][worst]} is off by {off[worst]:.2g}"


def of_film(k):
    """Tolerance of a film's record."""
    return 1e-6 if EARLY & set(DRAWN[k][1].values()) else TOLERANCES["films"]


def parts(places):
    """Places in parts."""
    return [places[first : first + PART] for first in range(0, len(places), PART)]


@pytest.mark.parametrize("k", [place for place, (k, _) in enumerate(DRAWN) if k in QUICK])
def test_films(k):
    check("films", [k], of_film)


@pytest.mark.slow
@pytest.mark.parametrize("places", parts(range(len(DRAWN))), ids=str)
def test_all_films(places):
    check("films", places, of_film)


@pytest.mark.slow
@pytest.mark.parametrize("place", covering_places([tuple(row.values()) for _, row in record.steady_rows()]))
def test_equilibria(place):
    """Every pair of levels that the recorded bearings have."""
    check("equilibria", [place], TOLERANCES["equilibria"])


@pytest.mark.slow
@pytest.mark.parametrize("k", range(len(record.RUNS)))
# profiles are drawn without regard to the coarse grids
@pytest.mark.filterwarnings("ignore:.* it departs from a straight line .*:UserWarning")
def test_runs(k):
    check("runs", [k], TOLERANCES["runs"])
