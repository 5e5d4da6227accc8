"""Pictures of films and histories with matplotlib, in one style; no display needed.

Module map
----------
records    what pictures look at: a film, the film of a joint, a history; in which unit a quantity is shown
mixins     ``plot_...`` methods of what is or has a film or a history; draws nothing itself
style      sizes, colours, fonts; opening and writing a figure
maps       unrolled maps of pressure, gap, fill and temperature; a ball's socket
histories  orbit in the clearance circle, polar diagram of the load, quantities over time or angle, waterfall
bush       in space: deformed bushes with contours of a nodal field; pressure around the bore, with the journal in it
curves     rotors over their speed; one column of any table over another
files      films of a run: orbit and pressure as gif or mp4, film and bush for ParaView
"""
