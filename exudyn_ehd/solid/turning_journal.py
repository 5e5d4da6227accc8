"""A journal that is a finite-element body: the modes of its surface as waves that turn under the film.

The surface turns with the journal, the film's vertices do not. At the journal's angle phi against the joint's frame,
its modes q open the gap at (theta, z) by

    delta = S(theta - phi, z) q = sum_n [cos(n theta), sin(n theta)] P_n(z) r_n,   r = T(phi) q,

with profiles P_n of its waves around: a turn by phi mixes the two phases of a wave, ``dT/dphi = D T``. A journal keeps
its shape at any angle, to rounding, and delta's rate at a vertex is that of

    dr/dt = T dq/dt + (dphi/dt) D r,

the motion of the modes and the transport by the spin. Pressures that load r by Q load q by T^T Q, and the angle by the
moment Q . D r: the film's power is that of both.

The surface is that of `exudyn_ehd.solid.fe_bore`: rigid motion that the modes cause is the frame's. Waves and profiles
of which no mode has more than `NEGLIGIBLE` of its displacement are left out, in the gap and in the loads alike.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exudyn_ehd.solid.fe_bore import FESurface, ReducedBore
from exudyn_ehd.solid.harmonics import with_middles
from exudyn_ehd.solid.journal import JournalModes
from exudyn_ehd.solid.pressure_modes import AROUND
from exudyn_ehd.status import ROUNDING, InputError

# Share of a mode's largest residual displacement on the film.
NEGLIGIBLE = 2e-4


@dataclass(frozen=True, kw_only=True, eq=False)
class FEJournal(FESurface):
    """Journal as a finite-element body (ObjectFFRFreducedOrder), which deforms under the oil by its modes as it turns.

    For any body, also one that is not the same in all directions: its surface turns under the film, which takes its
    radial displacement. Inertia and spin of the body are Exudyn's. First give the body the modes that an oil pressure
    excites: `add_bore_modes` with the journal's radius. A round pin without own dynamics: `ElasticJournal`.

    Parameters
    ----------
    fem : FEMinterface
        The mesh that the reduced body was made of, with its elements.
    nodes : sequence of int or None, default None
        Numbers of the mesh nodes on the journal; by default those on the cylinder around the joint's axis.
    radius_tolerance : float, default 0.02
        Largest difference of a node's radius from the bearing's journal radius, divided by that radius.
    settled : bool, default True
        As in `FEBore`; the initial shape stands still in the joint's frame while the journal turns. False: stiff modes
        start undeformed and oscillate at first.
    exact_jacobian : bool, default True
        As in `FEBore`.

    Examples
    --------
    After the example of `mesh_from_fem`:

    >>> pin = ehd.FEJournal(fem=fem)  # JournalBearing(..., journal=pin); the journal is the reduced body made of fem
    """

    def require_fit(self, radius: float, length: float, bush: object) -> None:
        """Raise `InputError` for a bush around it."""
        if bush is not None:
            raise InputError(
                "JournalBearing.journal=FEJournal(...) goes with a rigid bore, got "
                f"bush={type(bush).__name__}(...): leave one out, or take ElasticJournal(...) for a cylinder."
            )


@dataclass(frozen=True, kw_only=True, eq=False)
class TurningJournal:
    """A journal found in a reduced body; what `FEJournal` becomes when its joint is made.

    Parameters
    ----------
    surface : ReducedBore
        Outward displacements.
    mass : ndarray (k,)
        Centrifugal forces on the modes, over the square of the spin [kg m].

    Attributes
    ----------
    waves : JournalModes
        What the film knows, K waves that stand in the joint's frame.
    """

    surface: ReducedBore
    mass: np.ndarray

    def require_fit(self, radius: float, length: float, bush: object) -> None:
        """Check nothing: the description of the journal was checked."""

    @property
    def count(self) -> int:
        """k, the number of the body's modes."""
        return self.surface.count

    @cached_property
    def _parts(self) -> tuple[JournalModes, np.ndarray]:
        half, cuts = 0.5 * self.surface.length, self.surface.faces.cuts[1]
        edges = np.concatenate(([-half], cuts[np.abs(cuts) < half * (1.0 - 1e-6)], [half]))
        z, theta = with_middles(edges), 2.0 * np.pi * np.arange(AROUND) / AROUND
        # inward displacement opens the gap
        inward = -self.surface.radial(theta, z)
        # below it the residual is rounding of the rigid fit
        floor = ROUNDING * np.abs(self.surface.displacements).max(axis=(0, 1))
        size = np.maximum(np.abs(inward).max(axis=(0, 1)), np.maximum(floor, np.finfo(float).tiny))
        # waves of four angles or more
        spectrum = np.fft.rfft(inward, axis=0)[: AROUND // 4 + 1] * (2.0 / AROUND)
        spectrum[0] *= 0.5
        waves, phases, profiles, rows = [], [], [], []
        for n, wave in enumerate(spectrum):
            both = wave.real, -wave.imag
            # sines of no wave are nothing
            left, singular, _ = np.linalg.svd(np.hstack(both) / np.tile(size, 2), full_matrices=False)
            shapes = left[:, singular > NEGLIGIBLE * np.sqrt(z.size)]
            for phase in range(2 if n else 1):
                waves += shapes.shape[1] * [float(n)]
                phases += shapes.shape[1] * [0.5 * np.pi * phase]
                profiles.append(shapes.T)
                rows.append(shapes.T @ both[phase])
        number = np.array(waves)
        modes = JournalModes(
            edges=edges,
            waves=number,
            phases=np.array(phases),
            profiles=np.concatenate(profiles),
            stiffness=np.zeros_like(number),
            error=NEGLIGIBLE,
        )
        return modes, np.concatenate(rows)

    @property
    def waves(self) -> JournalModes:
        """Waves of the journal's surface that the film sees."""
        return self._parts[0]

    @cached_property
    def _partner(self) -> tuple[np.ndarray, np.ndarray]:
        """Number of the other phase of every wave, and the wave's rate per angle from there."""
        n, is_sine = self.waves.waves, self.waves.phases > 0.0
        own = np.arange(n.size)
        for wave in np.unique(n[n > 0.0]):
            cosine, sine = (np.flatnonzero((n == wave) & (is_sine == s)) for s in (False, True))
            own[cosine], own[sine] = sine, cosine
        return own, np.where(is_sine, n, -n)

    def turned(self, x: np.ndarray) -> np.ndarray:
        """D x for waves x (K,) or (K, m), the derivative to the angle; minus its transpose."""
        partner, rate = self._partner
        return np.asarray((rate * x[partner].T).T)

    def map(self, angle: float) -> np.ndarray:
        """T (K, k) at an angle, rad."""
        C, n = self._parts[1], self.waves.waves[:, None]
        partner, rate = self._partner
        return np.asarray(np.cos(n * angle) * C + np.sign(rate)[:, None] * np.sin(n * angle) * C[partner])

    # as the film's element reads the modes of a bore
    modes = None

    @cached_property
    def stiffness(self) -> np.ndarray:
        """Stiffness (k,) of the modes in the film's object: zero, since the body has its own."""
        return np.zeros(self.count)

    def radial(self, theta: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Return the opening of the gap by unit modes at zero angle, on the grid theta x z, (len(theta), len(z), k)."""
        return self.waves.radial(theta, z) @ self.map(0.0)
