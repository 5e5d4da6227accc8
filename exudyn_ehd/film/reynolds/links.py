"""Finite-volume Reynolds equation in scaled form: coefficients of the links, right-hand side, balance of the vertices.

With H = h/c, lengths over R and P = p c^2 / (12 mu R^2) in 1/s, the balance of a control volume reads

    sum over its links of (V H - H^3 dP/ds) + d(H)/dt area = 0,      V = (U_x, U_z) / (2 R) in 1/s,

which is the conservative form of the paper's Eq. (4) (Poiseuille and Couette flux of a thin film, squeeze). Links in
theta use the gap on the link itself, ``HF``; links in z the mean of both vertices, which is exact for a tilted journal.

An effect (flow factors of rough surfaces, shear thinning, a temperature field) changes what a link carries to
``V carrier - conductance dP/ds``; a plain film has the carrier H, the conductance H^3 and no `LinkFlux`.

Symbols: H (n, m) gap at vertices, HF (n, m) gap on the link i -> i+1, kx / kz link conductances with their metric, fx /
fz Couette fluxes with their metric, b right-hand side of ``A P = b``, P scaled pressure.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numba import njit

from exudyn_ehd.film.grid import Mesh

_FAST = {"reassoc", "contract", "nsz", "arcp"}
_unsigned = np.uint64
_0, _1 = _unsigned(0), _unsigned(1)


class LinkFlux(NamedTuple):
    """Coefficients of all links of a film with flux effects, (n, m) arrays that the effects write.

    Attributes
    ----------
    carriers, speeds : bool
        Whether an effect changes the carriers, or lets conductances depend on the speed. If not, the carriers are the
        gaps themselves and the derivatives stay what they are here.
    gap_x, gap_z : arrays
        Gaps of the links in theta (the film solver's own array) and in z.
    gx, gx_h, gx_v, gz, gz_h, gz_v : arrays
        Conductances per unit metric, their derivatives to the link's gap and to the scaled circumferential speed vx.
    cx, cx_h, cz, cz_h : arrays
        Carriers and their derivatives to the link's gap.
    """

    carriers: bool
    speeds: bool
    gap_x: np.ndarray
    gap_z: np.ndarray
    gx: np.ndarray
    gx_h: np.ndarray
    gx_v: np.ndarray
    gz: np.ndarray
    gz_h: np.ndarray
    gz_v: np.ndarray
    cx: np.ndarray
    cx_h: np.ndarray
    cz: np.ndarray
    cz_h: np.ndarray

    @property
    def flow(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Conductances and carriers alone."""
        return self.gx, self.gz, self.cx, self.cz

    @property
    def slopes(self) -> tuple[np.ndarray, ...]:
        """Conductances' derivatives, carriers and their derivatives, each in theta and z."""
        return self.gx_h, self.gz_h, self.cx, self.cz, self.cx_h, self.cz_h

    @property
    def by_speed(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Conductances' derivatives to the speed; None if they have none."""
        return (self.gx_v, self.gz_v) if self.speeds else None

    def reset(self) -> None:
        """Plain carriers, and no dependence on the speed, where effects have left others."""
        if self.carriers:
            self.cx[:], self.cz[:] = self.gap_x, self.gap_z
            self.cx_h[:] = self.cz_h[:] = 1.0
        self.reset_speeds()

    def reset_speeds(self) -> None:
        """No dependence on the speed, where effects have left one."""
        if self.speeds:
            self.gx_v[:] = self.gz_v[:] = 0.0


class Fluidity(Protocol):
    """A viscosity that varies with the temperature: its ratio at the vertices, and 1 over it on the links, (n, m) or
    (1, 1)."""

    ratio: np.ndarray
    inverse_x: np.ndarray
    inverse_z: np.ndarray


class FluxEffect(Protocol):
    """An effect that changes `LinkFlux` in place.

    Attributes
    ----------
    changes_carriers, depends_on_speed : bool
        Whether it changes the carriers, or the conductances by the speed.
    """

    changes_carriers: bool
    depends_on_speed: bool

    def apply(self, flux: LinkFlux, gap_x: np.ndarray, gap_z: np.ndarray, vx: float, vz: float) -> None:
        """Change conductances and carriers for the links' gaps (n, m) and scaled speeds, with their derivatives."""

    def start(self, flux: LinkFlux, H: np.ndarray, vx: float, vz: float) -> None:
        """Overwrite ``flux`` with a plain film of the gaps H (n, m) at the vertices, changed by this effect.

        Sets the links' gap in z.
        """
        plain_flux(H, flux.gap_x, flux.gap_z, flux.gx, flux.gx_h, flux.gz, flux.gz_h)
        flux.reset()
        self.apply(flux, flux.gap_x, flux.gap_z, vx, vz)


class ShearFactor(Protocol):
    """Factor on the viscosity of Couette shear that depends on the gap, on the sliding speed, and maybe on gradients of
    the pressure."""

    def factor(
        self, H: np.ndarray, vx: float, ratio_out: np.ndarray, ratio_h_out: np.ndarray, ratio_v_out: np.ndarray
    ) -> np.ndarray | None:
        """mu/mu_0 at the vertices with its derivatives with respect to H and vx.

        Returns those (2, n, m) to the gradients of the solver's unknown along theta and z, None if there are none.
        """


class LinkLaw(FluxEffect, ShearFactor, Protocol):
    """A law of the oil that changes what links carry and the shear.

    Attributes
    ----------
    field : Fluidity or None
        Viscosity over that of the film's scale, set by the bearing's model if it varies over the film.
    """

    field: Fluidity | None = None


def link_flux(gap_x: np.ndarray, effects: tuple[FluxEffect, ...]) -> LinkFlux:
    """Buffers for these effects; ``gap_x`` (n, m) as in `LinkFlux`."""
    carriers = any(effect.changes_carriers for effect in effects)
    speeds = any(effect.depends_on_speed for effect in effects)
    gap_z, gx, gx_h, gx_v, gz, gz_h, gz_v = np.zeros((7, *gap_x.shape))
    cx, cz = np.zeros((2, *gap_x.shape)) if carriers else (gap_x, gap_z)
    cx_h, cz_h = np.ones((2, *gap_x.shape))
    return LinkFlux(carriers, speeds, gap_x, gap_z, gx, gx_h, gx_v, gz, gz_h, gz_v, cx, cx_h, cz, cz_h)


@njit(cache=True, fastmath=_FAST)
def plain_flux(H, HF, gap_z_out, gx, gx_h, gz, gz_h):
    """The plain film's conductances with their derivatives, and the links' gap in z."""
    n, m = H.shape
    for i in range(n):
        for j in range(m):
            h = HF[i, j]
            gx[i, j] = h * h * h
            gx_h[i, j] = 3.0 * h * h
        for j in range(m):
            h = 0.5 * (H[i, j] + H[i, j + 1]) if j + 1 < m else H[i, j]
            gap_z_out[i, j] = h
            gz[i, j] = h * h * h
            gz_h[i, j] = 3.0 * h * h


@njit(cache=True, fastmath=_FAST, inline="always")
def conductances(H, HF, flow, flow_x, mesh, kx_out, kz_out):
    """Conductances of the links with their metric, ``H^3 width / distance``.

    ``flow_x`` = 0 drops the circumferential pressure flow.

    ``flow``: `LinkFlux.flow`, or None for a plain film.
    """
    n, m = H.shape
    mesh = Mesh(*mesh)
    for i in range(n):
        lx = mesh.link_x[i] * flow_x
        wx = mesh.width_x[i]
        for j in range(m):
            if flow is None:
                h = HF[i, j]
                g = h * h * h
            else:
                g = flow[0][i, j]
            kx_out[i, j] = g * lx * mesh.width_z[j]
        for j in range(m - 1):
            if flow is None:
                h = 0.5 * (H[i, j] + H[i, j + 1])
                g = h * h * h
            else:
                g = flow[1][i, j]
            kz_out[i, j] = g * mesh.link_z[j] * wx
        kz_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST, inline="always")
def couette_fluxes(H, HF, flow, vx, vz, mesh, fx_out, fz_out):
    """Couette fluxes of the links; 0 where there is no link. ``flow`` as in `conductances`."""
    n, m = H.shape
    mesh = Mesh(*mesh)
    for i in range(n):
        v = vx if mesh.link_x[i] != 0.0 else 0.0
        for j in range(m):
            fx_out[i, j] = v * (HF[i, j] if flow is None else flow[2][i, j]) * mesh.width_z[j]
        for j in range(m - 1):
            carrier = 0.5 * (H[i, j] + H[i, j + 1]) if flow is None else flow[3][i, j]
            fz_out[i, j] = vz * carrier * mesh.width_x[i]
        fz_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST, inline="always")
def right_hand_side(fx, fz, b_out):
    """b = net Couette inflow of every control volume."""
    n, m = fx.shape
    for i in range(n):
        p = i - 1 if i > 0 else n - 1
        for j in range(m):
            b_out[i, j] = fx[p, j] - fx[i, j]
        b_out[i, 0] -= fz[i, 0]
        for j in range(1, m):
            b_out[i, j] += fz[i, j - 1] - fz[i, j]


@njit(cache=True, fastmath=_FAST, inline="always")
def add_squeeze(H_t, width_x, width_z, b_out):
    """Subtract the storage term ``dH/dt area``."""
    n, m = H_t.shape
    for i in range(n):
        for j in range(m):
            b_out[i, j] -= H_t[i, j] * width_x[i] * width_z[j]


@njit(cache=True, fastmath=_FAST)
def set_links(H, HF, H_t, squeeze, flow, vx, vz, flow_x, mesh, kx_out, kz_out, fx_out, fz_out, b_out):
    """Coefficients of the links and right-hand side in one call; without a ``squeeze`` H_t is not read."""
    conductances(H, HF, flow, flow_x, mesh, kx_out, kz_out)
    couette_fluxes(H, HF, flow, vx, vz, mesh, fx_out, fz_out)
    right_hand_side(fx_out, fz_out, b_out)
    if squeeze:
        add_squeeze(H_t, mesh[0], mesh[1], b_out)


@njit(cache=True, fastmath=_FAST)
def lacks(links, p, out):
    """Write what the balances lack (n, m), ``b - A P`` for links (kx, kz, b): b less what pressure flows take away.

    At fixed vertices it is minus the inflow that they supply.
    """
    kx, kz, b = links[0].reshape(-1), links[1].reshape(-1), links[2].reshape(-1)
    x, lack, m, size = p.reshape(-1), out.reshape(-1), _unsigned(p.shape[1]), _unsigned(p.size)
    last = size - m
    for c in range(m):
        # nothing flows over the last row's links
        before, far = (c if c > _0 else size) - _1, last + c
        lack[c] = b[c] - kx[c] * (x[c] - x[c + m]) + kx[far] * (x[far] - x[c])
        lack[c] += kz[before] * (x[before] - x[c]) - kz[c] * (x[c] - x[c + _1])
    for c in range(m, last):
        taken = kx[c] * (x[c] - x[c + m]) - kx[c - m] * (x[c - m] - x[c])
        lack[c] = b[c] - taken - kz[c] * (x[c] - x[c + _1]) + kz[c - _1] * (x[c - _1] - x[c])
    for c in range(last, size):
        on, far = c + _1 if c + _1 < size else _0, c - last
        lack[c] = b[c] - kx[c] * (x[c] - x[far]) + kx[c - m] * (x[c - m] - x[c])
        lack[c] += kz[c - _1] * (x[c - _1] - x[c]) - kz[c] * (x[c] - x[on])
