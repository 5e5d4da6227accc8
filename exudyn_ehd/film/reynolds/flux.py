"""Flux coefficients of the links where an effect changes them; absent, the plain kernels of `reynolds` are used.

A link carries ``q = v carrier - conductance dP/ds``. Plain: conductance H^3, carrier H with the gap H on the link. An effect (flow
factors of rough surfaces, shear thinning, a temperature field) multiplies or adds in `LinkFlux` buffers and keeps the derivatives
with respect to the link's gap and to the speeds exact.

Symbols: gx, gz conductances and cx, cz carriers per unit metric on the links in theta and z; suffix _h derivative with respect to
the link's gap, _v with respect to the scaled speed v = U / (2 R) (only of the conductance in that direction's flux and carriers
by the circumferential speed vx).
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numba import njit

_FAST = {"reassoc", "contract", "nsz", "arcp"}


class LinkFlux:
    """Buffers of one film's flux coefficients, all (n, m); see the module's docstring.

    Parameters
    ----------
    gap_x : (n, m) array
        Gap on the links in theta, the film solver's own array.
    carriers, speeds : bool
        Whether an effect changes the carriers, or lets conductances depend on the speed. If not, the carriers are the gaps
        themselves, and the derivatives stay what they are here.
    """

    def __init__(self, gap_x: np.ndarray, *, carriers: bool = True, speeds: bool = True) -> None:
        shape = gap_x.shape
        self.carriers, self.speeds = carriers, speeds
        self.gap_x = gap_x
        self.gap_z: np.ndarray = np.zeros(shape)
        self.gx, self.gx_h, self.gx_v = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        self.gz, self.gz_h, self.gz_v = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        self.cx: np.ndarray = np.zeros(shape) if carriers else gap_x
        self.cx_h: np.ndarray = np.ones(shape)
        self.cz: np.ndarray = np.zeros(shape) if carriers else self.gap_z
        self.cz_h: np.ndarray = np.ones(shape)

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
        """The same from scratch, as the first effect, for the gaps H (n, m) at the vertices; sets the links' gap in z."""
        plain_flux(H, flux.gap_x, flux.gap_z, flux.gx, flux.gx_h, flux.gz, flux.gz_h)
        flux.reset()
        self.apply(flux, flux.gap_x, flux.gap_z, vx, vz)


def link_flux(gap_x: np.ndarray, effects: tuple[FluxEffect, ...]) -> LinkFlux:
    """Buffers for these effects; ``gap_x`` (n, m) as in `LinkFlux`."""
    return LinkFlux(
        gap_x,
        carriers=any(effect.changes_carriers for effect in effects),
        speeds=any(effect.depends_on_speed for effect in effects),
    )


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


@njit(cache=True, fastmath=_FAST)
def conductances_from(gx, gz, width_x, width_z, link_x, link_z, flow_x, kx_out, kz_out):
    """Link conductances with their metric, as `reynolds.conductances`."""
    n, m = gx.shape
    for i in range(n):
        lx = link_x[i] * flow_x
        for j in range(m):
            kx_out[i, j] = gx[i, j] * lx * width_z[j]
        for j in range(m - 1):
            kz_out[i, j] = gz[i, j] * link_z[j] * width_x[i]
        kz_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def couette_fluxes_from(cx, cz, vx, vz, width_x, width_z, link_x, fx_out, fz_out):
    """Couette fluxes with their metric, as `reynolds.couette_fluxes`."""
    n, m = cx.shape
    for i in range(n):
        v = vx if link_x[i] != 0.0 else 0.0
        for j in range(m):
            fx_out[i, j] = v * cx[i, j] * width_z[j]
        for j in range(m - 1):
            fz_out[i, j] = vz * cz[i, j] * width_x[i]
        fz_out[i, m - 1] = 0.0


@njit(cache=True, fastmath=_FAST)
def flux_sensitivity(
    lam, P, fill, gx_h, gx_v, gz_h, gz_v, cx, cx_h, cz, cz_h, vx, vz, flow_x, width_x, width_z, link_x, link_z,
    cell_out, face_out, speed_out,
):  # fmt: skip
    """Gradient of ``-lam . r`` for general coefficients: cell_out, face_out (k, n, m), speed_out (k, 2).

    ``fill`` (n, m) is the film fraction, taken from upstream; pass ones for closures without one.
    """
    count, n, m = lam.shape
    for k in range(count):
        sx = 0.0
        sz = 0.0
        for i in range(n):
            nxt = i + 1 if i + 1 < n else 0
            linked = 1.0 if link_x[i] != 0.0 else 0.0
            lx = link_x[i] * flow_x
            for j in range(m):
                up = fill[i, j] if vx >= 0.0 else fill[nxt, j]
                d = (lam[k, i, j] - lam[k, nxt, j]) * width_z[j]
                drop = lx * (P[nxt, j] - P[i, j])
                face_out[k, i, j] = -d * (linked * vx * up * cx_h[i, j] - gx_h[i, j] * drop)
                sx -= d * (linked * up * cx[i, j] - gx_v[i, j] * drop)
                cell_out[k, i, j] = 0.0
            for j in range(m - 1):
                up = fill[i, j] if vz >= 0.0 else fill[i, j + 1]
                d = (lam[k, i, j] - lam[k, i, j + 1]) * width_x[i]
                drop = link_z[j] * (P[i, j + 1] - P[i, j])
                g = -0.5 * d * (vz * up * cz_h[i, j] - gz_h[i, j] * drop)
                cell_out[k, i, j] += g
                cell_out[k, i, j + 1] += g
                sz -= d * up * cz[i, j]
                sx += d * gz_v[i, j] * drop
        speed_out[k, 0] = sx
        speed_out[k, 1] = sz
