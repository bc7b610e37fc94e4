# SPDX-License-Identifier: BSD-3-Clause
"""The labelled drawings of docs/glossary.md and README.md: the drive from the front and cut along its axis, and where
the six drives of a UR5 sit. Each can be read at a width of 400 pixels. Teeth and deformation are drawn larger than they
are; the arm is in the proportions of its data sheet."""
import argparse
from pathlib import Path

import numpy as np
from matplotlib.patches import Circle, Polygon, Rectangle

from lab import BLUE, CHECKOUT, GREEN, GREY, ORANGE, PURPLE, RED, plt

SHOWN_TEETH = 50      # a quarter of the flexspline's 200; the circular spline has one more a lobe, as in the drive
RADIUS, WAVE = 1.0, 0.075  # of the rim, and how far a lobe stands out; exaggerated some ten times
HEIGHT = 0.05         # of a tooth
BALLS = 23
TEXT = 12             # size of the letters [pt]
SECTION = {"facecolor": "0.75", "edgecolor": "0.25", "hatch": "////", "linewidth": 0.6}
# Modified Denavit-Hartenberg lengths of a UR5, data sheet [m].
D1, A2, A3, D4, D5, D6 = 0.0892, 0.425, 0.3923, 0.1092, 0.0947, 0.0823


def toothed(teeth, radius_of, inward):
    """Outline of a ring whose teeth stand on `radius_of(angle)`, four points a pitch."""
    pitch = 2.0 * np.pi / teeth
    angle = np.concatenate([k * pitch + pitch * np.array([-0.30, -0.12, 0.12, 0.30]) for k in range(teeth)])
    radius = radius_of(angle) + np.tile([0.0, 1.0, 1.0, 0.0], teeth) * (-HEIGHT if inward else HEIGHT)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def note(axis, text, at, of, colour="black"):
    axis.annotate(text, of, at, color=colour, fontsize=TEXT, ha="center", va="center",
                  arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.8})


def front(axis):
    def rim(angle):
        return RADIUS + WAVE * np.cos(2.0 * angle)

    around = np.linspace(0.0, 2.0 * np.pi, 400)
    outer = RADIUS + WAVE + HEIGHT + 0.012
    axis.add_patch(Circle((0, 0), outer + 0.16, facecolor="#cfe3f0", edgecolor=BLUE))
    axis.add_patch(Polygon(toothed(SHOWN_TEETH + 2, lambda angle: np.full_like(angle, outer), True), facecolor="white",
                           edgecolor=BLUE, linewidth=0.9))
    axis.add_patch(Polygon(toothed(SHOWN_TEETH, rim, False), facecolor="#f7d9c4", edgecolor=RED, linewidth=0.9))
    for inside, colour, fill in ((0.06, RED, "white"), (0.062, GREY, "0.92")):
        radius = rim(around) - inside
        axis.add_patch(Polygon(np.column_stack([radius * np.cos(around), radius * np.sin(around)]), facecolor=fill,
                               edgecolor=colour, linewidth=0.9))
    for ball in 2.0 * np.pi * (np.arange(BALLS) + 0.5) / BALLS:
        radius = rim(ball) - 0.155
        axis.add_patch(Circle((radius * np.cos(ball), radius * np.sin(ball)), 0.062, facecolor="white",
                              edgecolor="0.3", linewidth=0.8))
    radius = rim(around) - 0.25
    axis.add_patch(Polygon(np.column_stack([radius * np.cos(around), radius * np.sin(around)]), facecolor="#d6ead9",
                           edgecolor=GREEN))
    axis.add_patch(Circle((0, 0), 0.16, facecolor="white", edgecolor=GREEN))
    axis.plot([-1.42, 1.42], [0, 0], ls=(0, (8, 3, 2, 3)), color="0.3", lw=0.8)
    note(axis, "circular spline\n202 teeth, turns\nwith the joint", (-1.45, 1.42), (-0.86, 0.92), BLUE)
    note(axis, "flexspline\n200 teeth, its rim\nis elastic", (1.48, 1.42), (0.69, 0.74), RED)
    note(axis, "wave generator\non the motor's shaft:\noval plug in a bearing", (-1.3, -1.62), (-0.25, -0.55), GREEN)
    note(axis, "balls between\ntwo races", (1.35, -1.62), (0.56, -0.62), "0.3")
    note(axis, "lobe: teeth\nin mesh", (1.85, -0.85), (1.11, -0.08), "black")
    note(axis, "major\naxis", (1.85, 0.35), (1.35, 0.0), "black")
    note(axis, "teeth apart", (0.0, 1.62), (0.0, 1.02), "black")
    axis.set_title("The drive from the front", fontsize=TEXT + 2)
    axis.set(xlim=(-2.2, 2.2), ylim=(-1.95, 1.8), aspect="equal")


def mirrored(axis, corners, **style):
    for sign in (1.0, -1.0):
        axis.add_patch(Polygon([(x, sign * y) for x, y in corners], **style))


def cut(axis):
    """Along the axis, through the lobes: motor on the left, output on the right."""
    axis.add_patch(Rectangle((-1.9, -0.14), 2.15, 0.28, facecolor="#d6ead9", edgecolor=GREEN))
    axis.add_patch(Rectangle((-2.05, -0.55), 0.75, 1.1, facecolor="0.9", edgecolor="0.4"))
    axis.text(-1.675, 0.33, "motor", ha="center", va="center", fontsize=TEXT)
    mirrored(axis, [(-0.18, 0.14), (0.22, 0.14), (0.22, 0.62), (-0.18, 0.62)], facecolor="#d6ead9", edgecolor=GREEN)
    for sign in (1.0, -1.0):
        axis.add_patch(Circle((0.02, sign * 0.71), 0.085, facecolor="white", edgecolor="0.3"))
    mirrored(axis, [(-0.12, 0.80), (0.16, 0.80), (0.16, 0.84), (-0.12, 0.84)], facecolor="0.92", edgecolor=GREY)
    # Cup: toothed rim on the right, thin wall, bottom and flange on the left, fixed to the housing.
    mirrored(axis, [(0.20, 0.97), (-0.16, 0.97), (-0.16, 0.92), (-0.92, 0.92), (-1.02, 0.86), (-1.04, 0.60),
                    (-1.12, 0.60), (-1.12, 0.34), (-0.96, 0.34), (-0.96, 0.80), (-0.90, 0.87), (-0.16, 0.87),
                    (-0.16, 0.85), (0.20, 0.85)], facecolor="#f7d9c4", edgecolor=RED, linewidth=0.9)
    mirrored(axis, [(-0.16, 0.98), (0.22, 0.98), (0.22, 1.25), (-0.16, 1.25)], facecolor="#cfe3f0", edgecolor=BLUE)
    mirrored(axis, [(0.22, 0.98), (0.55, 0.98), (0.55, 0.0), (0.75, 0.0), (0.75, 1.25), (0.22, 1.25)],
             facecolor="#cfe3f0", edgecolor=BLUE)
    mirrored(axis, [(-1.22, 0.34), (-1.12, 0.34), (-1.12, 0.60), (-1.12, 1.38), (0.10, 1.38), (0.10, 1.52),
                    (-1.22, 1.52)], **SECTION)
    for sign in (1.0, -1.0):
        axis.add_patch(Circle((0.03, sign * 1.315), 0.058, facecolor="white", edgecolor="0.3"))
    axis.plot([-2.2, 1.5], [0, 0], ls=(0, (8, 3, 2, 3)), color="0.3", lw=0.8)
    note(axis, "output:\nthe joint's\nlink", (1.3, 0.55), (0.75, 0.3), BLUE)
    note(axis, "housing", (-1.75, 1.7), (-1.17, 1.45), "0.3")
    note(axis, "output bearing", (0.75, 1.74), (0.06, 1.33), "0.3")
    note(axis, "circular\nspline", (1.35, -0.75), (0.18, -1.12), BLUE)
    note(axis, "rim with\nthe teeth", (0.95, -1.85), (0.05, -0.93), RED)
    note(axis, "cup: thin wall,\ntwists under load", (-0.4, -1.85), (-0.55, -0.885), RED)
    note(axis, "flange:\nfixed to the\nhousing", (-1.85, -1.15), (-1.05, -0.55), RED)
    note(axis, "wave\ngenerator", (-0.55, 0.45), (-0.15, 0.35), GREEN)
    axis.set_title("Cut along its axis, through the lobes", fontsize=TEXT + 2)
    axis.set(xlim=(-2.35, 1.75), ylim=(-2.05, 1.9), aspect="equal")


def arm(axis):
    """A UR5 from the side; a dot is a joint with a drive in it."""
    lift, bend, tilt = np.radians([62.0, -78.0, -74.0])
    shoulder = np.array([0.0, D1])
    elbow = shoulder + A2 * np.array([np.cos(lift), np.sin(lift)])
    wrist_1 = elbow + A3 * np.array([np.cos(lift + bend), np.sin(lift + bend)])
    down = np.array([np.cos(lift + bend + tilt), np.sin(lift + bend + tilt)])
    wrist_2, wrist_3 = wrist_1 + 0.55 * D5 * down, wrist_1 + D5 * down
    tool = wrist_3 + D6 * down
    path = np.array([[0.0, 0.0], shoulder, elbow, wrist_1, wrist_3, tool])
    axis.plot(*path.T, color="0.75", lw=13, solid_capstyle="round", zorder=1)
    axis.plot([-0.12, 0.12], [-0.012, -0.012], color="0.4", lw=4)
    names = [("base", np.array([0.0, 0.015]), (-0.17, 0.02)), ("shoulder", shoulder, (-0.19, 0.13)),
             ("elbow", elbow, (0.02, 0.55)), ("wrist_1", wrist_1, (0.66, 0.46)), ("wrist_2", wrist_2, (0.73, 0.335)),
             ("wrist_3", wrist_3, (0.73, 0.25))]
    for name, at, text in names:
        size_3 = not name.startswith("wrist")
        colour = ORANGE if size_3 else PURPLE
        axis.plot(*at, "o", color=colour, ms=12 if size_3 else 8, mec="black", mew=0.6, zorder=2)
        note(axis, name, text, at, "black")
    axis.plot([], [], "o", color=ORANGE, ms=9, label="joint of size 3: drive of size 25, 101:1")
    axis.plot([], [], "o", color=PURPLE, ms=7, label="joint of size 1: drive of size 14, 101:1")
    axis.legend(loc="upper center", fontsize=TEXT, bbox_to_anchor=(0.5, 0.06), frameon=False)
    axis.text(tool[0] + 0.02, tool[1] - 0.04, "tool,\npayload", fontsize=TEXT)
    axis.set_title("The six drives of a UR5", fontsize=TEXT + 2)
    axis.set(xlim=(-0.34, 0.90), ylim=(-0.16, 0.62), aspect="equal")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=CHECKOUT / "docs" / "images", help="folder [%(default)s]")
    given = parser.parse_args()
    for name, draw in (("drive_front", front), ("drive_cut", cut), ("arm_drives", arm)):
        figure, axis = plt.subplots(figsize=(6.4, 5.4))
        axis.axis("off")
        draw(axis)
        figure.tight_layout(pad=0.3)
        figure.savefig(given.out / f"{name}.png", dpi=125)
        plt.close(figure)


if __name__ == "__main__":
    main()
