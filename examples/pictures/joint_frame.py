"""Sketch of the joint frame, angles, signs: ``python examples/pictures/joint_frame.py`` draws it beside itself."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Arc, Circle, Polygon, Rectangle

HOUSING, OIL, JOURNAL, DARK, FORCE, SPIN = "#d9dee4", "#fbe7b2", "#b9c4d0", "#222222", "#d55e00", "#0072b2"
BORE, RADIUS, E = 1.0, 0.74, np.array([0.10, -0.16])


def arrow(ax, start, end, color=DARK, width=1.3, style="-|>"):
    """Arrow between two points."""
    look = {"arrowstyle": style, "color": color, "lw": width, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 11}
    ax.annotate("", end, start, arrowprops=look)


def turn(ax, centre, radius, first, last, color=DARK, width=1.3):
    """Arrow along a circle, angles in degrees."""
    ax.add_patch(Arc(centre, 2 * radius, 2 * radius, theta1=first, theta2=last, color=color, lw=width))
    a = np.radians([last - 2.0, last])
    points = np.asarray(centre) + radius * np.column_stack([np.cos(a), np.sin(a)])
    arrow(ax, points[0], points[1] + 1.5 * (points[1] - points[0]), color, width)


def across(ax):
    """Cross-section in the mid-plane, seen against z."""
    ax.add_patch(Circle((0, 0), 1.3, fc=HOUSING, ec=DARK))
    ax.add_patch(Circle((0, 0), BORE, fc=OIL, ec=DARK))
    ax.add_patch(Circle(E, RADIUS, fc=JOURNAL, ec=DARK))
    for end, name, place in (((1.62, 0), "x", (1.57, 0.07)), ((0, 1.62), "y", (0.07, 1.52))):
        arrow(ax, (0, 0), end)
        ax.text(*place, name, style="italic")
    a = np.radians(52)
    out = np.array([np.cos(a), np.sin(a)])
    turn(ax, (0, 0), 1.14, 0, 50)
    ax.plot(*np.outer([0, BORE], out).T, ls=":", color=DARK, lw=1)
    ax.text(1.06, 0.5, "θ")
    along = E @ out
    inner = along + np.sqrt(along**2 - E @ E + RADIUS**2)
    arrow(ax, inner * out, BORE * out, style="<|-|>", width=1.6)
    ax.text(*(0.5 * (inner + BORE) * out + [-0.14, 0.02]), "h", style="italic")
    ax.plot(*np.array([[0, 0], E]).T, "o-", color=DARK, ms=3, lw=1)
    ax.text(-0.08, -0.16, "e", style="italic")
    turn(ax, E, 0.5, 215, 300, SPIN, 2)
    ax.text(E[0] - 0.10, E[1] - 0.45, "ω", color=SPIN)
    # the film presses ahead of its thinnest place
    arrow(ax, E, E + [0.10, 0.52], FORCE, 2.4)
    ax.text(0.04, 0.3, "F", color=FORCE, weight="bold")
    ax.text(-0.48, -0.4, "journal")
    ax.text(-0.62, 1.08, "housing")
    ax.set(xlim=(-1.4, 1.75), ylim=(-1.4, 1.7))


def along(ax):
    """Section along the axis, with a tilted journal."""
    for y in (1.0, -1.3):
        ax.add_patch(Rectangle((-1.4, y), 2.8, 0.3, fc=HOUSING, ec=DARK))
    ax.add_patch(Rectangle((-1.4, -1.0), 2.8, 2.0, fc=OIL, ec="none"))
    half, slope = 1.75, -0.07
    corners = [(z, -0.07 + slope * z + side * RADIUS) for side in (1, -1) for z in (half * side, -half * side)]
    ax.add_patch(Polygon(corners, fc=JOURNAL, ec=DARK))
    ax.plot([-half, half], [-0.07 - slope * half, -0.07 + slope * half], ls="-.", color=DARK, lw=1)
    for end, name, place in (((2.15, 0), "z", (2.08, 0.07)), ((0, 0.62), "y", (0.07, 0.5))):
        arrow(ax, (0, 0), end)
        ax.text(*place, name, style="italic")
    ax.text(-0.06, 0.12, "joint frame", ha="right")
    ax.text(0.2, -0.34, "tilted axis of the journal")
    arrow(ax, (-1.4, -1.5), (1.4, -1.5), style="<|-|>")
    ax.text(0, -1.68, "length, z from -L/2 to L/2", ha="center")
    ax.text(0, 1.42, "radial clearance c = bore radius - journal radius", ha="center")
    ax.set(xlim=(-1.85, 2.25), ylim=(-1.75, 1.7))


if __name__ == "__main__":
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 4.1), width_ratios=(3.15, 4.1), layout="constrained")
    across(axes[0])
    along(axes[1])
    for one in axes:
        one.set_aspect("equal")
        one.axis("off")
    figure.savefig(pathlib.Path(__file__).with_suffix(".png"), dpi=90)
