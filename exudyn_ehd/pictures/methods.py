"""The ``plot_...`` methods of what carries a film or a history. Matplotlib is imported when something is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class FilmPictures:
    """Pictures of a film at one instant; mixed into what has the attributes of `pictures.data.Film`.

    Every method draws into ``ax`` if given (a matplotlib Axes, so that pictures can be combined) or into a figure of its own, writes
    it to ``path`` if given, and returns the figure.
    """

    def plot_pressure(self, *, ax: Any = None, path: Any = None) -> Figure:
        """Unrolled map of the pressure, with the boundary of the unbroken film and the housing's supply areas."""
        return self._map("PRESSURE", ax, path)

    def plot_gap(self, *, ax: Any = None, path: Any = None) -> Figure:
        """Unrolled map of the gap, as `plot_pressure`."""
        return self._map("GAP", ax, path)

    def plot_fill(self, *, ax: Any = None, path: Any = None) -> Figure:
        """Unrolled map of the film fraction of a mass-conserving film, as `plot_pressure`."""
        return self._map("FILL", ax, path)

    def plot_temperature(self, *, ax: Any = None, path: Any = None) -> Figure:
        """Unrolled map of the film's temperature, as `plot_pressure`."""
        return self._map("TEMPERATURE", ax, path)

    def plot_contact_pressure(self, *, ax: Any = None, path: Any = None) -> Figure:
        """Unrolled map of the pressure of asperities or wall, as `plot_pressure`; of a joint's film."""
        return self._map("CONTACT_PRESSURE", ax, path)

    def plot_wear_depth(self, *, ax: Any = None, path: Any = None) -> Figure:
        """Unrolled map of what was worn off the bore, as `plot_pressure`; of a joint's film."""
        return self._map("WEAR_DEPTH", ax, path)

    def plot_bearing(self, *, camera: tuple[float, float] | None = None, ax: Any = None, path: Any = None) -> Figure:
        """The bearing in space: pressure around the bore, journal, load on the bush; ``camera`` elevation and azimuth, degrees."""
        from exudyn_ehd.pictures.bearing3d import plot_bearing

        film: Any = self
        return plot_bearing(film, camera=camera, ax=ax, path=path)

    def _map(self, field: str, ax: Any, path: Any) -> Figure:
        from exudyn_ehd.pictures import maps

        film: Any = self
        return maps.plot_map(film, getattr(maps, field), ax=ax, path=path)


class HistoryPictures:
    """Pictures of a history; mixed into what has the attributes of `pictures.data.History`. See `FilmPictures`."""

    def plot_orbit(self, *, ends: bool = False, text: str = "", ax: Any = None, path: Any = None) -> Figure:
        """Orbit of the journal in the clearance circle; with ``ends`` also at both ends; ``text`` names it in a legend."""
        from exudyn_ehd.pictures.orbit import plot_orbit

        history: Any = self
        return plot_orbit(history, ends=ends, text=text, ax=ax, path=path)

    def plot_load(self, *, text: str = "", ax: Any = None, path: Any = None) -> Figure:
        """Polar diagram of the load of the journal on the bush, in the housing's joint frame."""
        from exudyn_ehd.pictures.load import plot_load

        history: Any = self
        return plot_load(history, text=text, ax=ax, path=path)

    def plot_traces(self, quantities: Any = ("minimum_gap", "peak_pressure"), **options: Any) -> Figure:
        """Quantities over time, or over an ``angle``; options as in `pictures.traces.plot_traces`."""
        from exudyn_ehd.pictures.traces import plot_traces

        history: Any = self
        return plot_traces(history, quantities, **options)
