# SPDX-License-Identifier: BSD-3-Clause
"""Draws the simulation of a joint: commands, motion, and forces of the teeth."""
import numpy as np

from drawing import BLUE, GREEN, GREY, ORANGE, RED, STYLE, plt

MOST_POINTS = 4000  # per curve; more than the picture has pixels
MAP_COLUMNS = 400
MAP_TEETH = 10  # to each side of the major axis
RING_STRETCH = 13.0  # the flexspline's deformation is drawn this much larger


def thin(series, name, factor=1.0):
    """Time and values, reduced to the number of points that a figure can show."""
    step = max(1, len(series) // MOST_POINTS)
    return series.time[::step], series[name][::step] * factor


def legend(axes):
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc="lower right", bbox_to_anchor=(1.005, 0.93), ncol=3, borderpad=0.2, handlelength=1.5)


def steps(series, end):
    """Times and torques of a course of steps: a stamped torque is valid until the next one."""
    return np.append(series.time, end), np.append(series["torque"], series["torque"][-1])


def draw_torques(axes, recording, end):
    axes.set_title("Torque at the joint [N·m]")
    load = recording["load"]
    axes.plot(*thin(recording["joint_states"], "joint_torque"), color=GREEN, label="through the teeth")
    if len(load):
        axes.plot(*steps(load, end), color=ORANGE, drawstyle="steps-post", label="external load")
    legend(axes)


def draw_motor_torque(axes, recording, end):
    axes.set_title("Torque at the motor [N·m]")
    command = recording["command"]
    if len(command):
        axes.plot(*steps(command, end), color=GREY, lw=2.6, alpha=0.4, drawstyle="steps-post", label="commanded")
    axes.plot(*thin(recording["joint_states"], "motor_torque"), color=BLUE, label="applied")
    axes.plot(*thin(recording["health"], "friction_torque"), color=RED, lw=1.0, label="all friction")
    legend(axes)


def draw_speed(axes, recording):
    states, measured = recording["joint_states"], recording["measured"]
    axes.set_title("Joint speed, as its encoders see it [rad/s]")
    if len(measured):
        axes.plot(*thin(measured, "velocity"), color=GREY, lw=2.6, alpha=0.4, label="robot, measured")
    axes.plot(*thin(states, "motor_velocity", 1.0 / recording.ratio), color=BLUE, lw=1.6,
              label=f"motor encoder / {recording.ratio:g}")
    axes.plot(*thin(states, "output_velocity"), color=ORANGE, lw=1.2, ls=(0, (4, 4)), label="output encoder")
    legend(axes)


def torsion(recording):
    """Time [s] and torsion (motor angle / ratio - joint angle) [mrad], from the true angles of the model."""
    encoders = recording["encoders"]
    time, motor = thin(encoders, "motor_angle_true", 1.0 / recording.ratio)
    return time, (motor - thin(encoders, "output_angle_true")[1]) * 1e3


def draw_torsion(axes, recording):
    axes.set_title(f"Torsion: motor angle / {recording.ratio:g} − joint angle [mrad]")
    axes.plot(*torsion(recording), color=BLUE)


def wave_generator_frame(forces):
    """Mesh force over time and angle from the nearer end of the major axis, mean of both lobes [N]."""
    mesh = forces["mesh_force"]
    teeth = np.arctan2(forces["tooth_y"], forces["tooth_x"])
    angle = (teeth - forces["wave_generator_angle"][:, None] + 0.5 * np.pi) % np.pi - 0.5 * np.pi
    time = np.repeat(forces.time[:, None], mesh.shape[1], axis=1)
    pitch = 2.0 * np.pi / mesh.shape[1]
    bins = [np.linspace(forces.time[0], forces.time[-1], max(1, min(MAP_COLUMNS, len(forces) // 2)) + 1),
            (np.arange(2 * MAP_TEETH + 2) - MAP_TEETH - 0.5) * pitch]
    sums, _, _ = np.histogram2d(time.ravel(), angle.ravel(), bins=bins, weights=mesh.ravel())
    counts, _, _ = np.histogram2d(time.ravel(), angle.ravel(), bins=bins)
    return bins, (sums / np.maximum(counts, 1)).T


def draw_tooth_map(axes, recording, figure):
    forces = recording["contact_forces"]
    axes.set(title="Mesh force of each tooth around the lobes [N]: + leading, − trailing flank", xlabel="time [s]",
             ylabel="from the major\naxis [°]")
    bins, force = wave_generator_frame(forces)
    limit = max(np.abs(force).max(), 1e-9)
    image = axes.pcolormesh(bins[0], np.degrees(bins[1]), force, cmap="RdBu_r", vmin=-limit, vmax=limit,
                            rasterized=True)
    axes.grid(False)
    inset = axes.inset_axes([0.8, 1.035, 0.2, 0.05])
    bar = figure.colorbar(image, cax=inset, orientation="horizontal")
    bar.set_ticks([-limit, 0, limit])
    bar.set_ticklabels([f"{-limit:.0f}", "0", f"{limit:.0f}"])
    bar.ax.xaxis.set_ticks_position("top")
    bar.ax.tick_params(labelsize=7, length=2, pad=1)
    bar.outline.set_visible(False)


def draw_ring(axes, recording):
    """All tooth forces at the instant of the largest mesh force, on the deformed flexspline."""
    forces = recording["contact_forces"]
    axes.set(yticks=[], xticks=np.radians([0, 90, 180, 270]))
    axes.spines["polar"].set_visible(False)
    most = np.unravel_index(np.abs(forces["mesh_force"]).argmax(), forces["mesh_force"].shape)[0]
    x, y = forces["tooth_x"][most], forces["tooth_y"][most]
    contact, mesh = forces["wave_generator_force"][most], np.abs(forces["mesh_force"][most])
    radius = np.hypot(x, y)
    angle = np.arctan2(y, x)
    ring = 1.4 * max(contact.max(), mesh.max(), 1e-9) * (1.0 + RING_STRETCH * (radius / radius.mean() - 1.0))
    loop = np.append(np.arange(len(angle)), 0)
    axes.fill_between(angle[loop], (ring - contact)[loop], ring[loop], color=BLUE, alpha=0.4, lw=0,
                      label=f"wave generator (up to {contact.max():.0f} N)")
    axes.bar(angle, mesh, width=2.0 * np.pi / len(angle), bottom=ring, color=RED, lw=0,
             label=f"mesh (up to {mesh.max():.0f} N)")
    axes.plot(angle[loop], ring[loop], color="black", lw=1.0, label=f"flexspline, deformation × {RING_STRETCH:g}")
    major = forces["wave_generator_angle"][most]
    axes.plot([major, major + np.pi], [ring.max() * 0.97] * 2, color=GREY, lw=0.8, ls=":", label="major axis")
    axes.set_ylim(0.0, 1.05 * (ring + mesh).max())
    axes.set_title(f"Tooth forces at the most loaded instant, {forces.time[most]:.2f} s", loc="center", pad=12)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.06), ncol=2)


def draw_loop(axes, recording):
    health, states = recording["health"], recording["joint_states"]
    axes.set_title("Joint torque [N·m] over torsion [mrad]")
    time, angle = torsion(recording)
    torque = np.interp(time, states.time, states["joint_torque"])
    axes.plot(angle, torque, color=GREEN, lw=0.7)
    valid = health["torsional_stiffness_valid"].astype(bool)
    if valid.any():
        axes.text(0.04, 0.93, f"slope at the end: {health['torsional_stiffness'][valid][-1] * 1e-3:.1f} kN·m/rad",
                  transform=axes.transAxes, va="top", fontsize=8, color=GREY)


def draw_health(axes, recording):
    health = recording["health"]
    axes.set(title="Teeth loaded; bearing load [kN]", xlabel="time [s]")
    axes.plot(*thin(health, "teeth_loaded"), color=BLUE, label="teeth")
    right = axes.twinx()
    right.spines["right"].set_visible(True)
    right.grid(False)
    right.plot(*thin(health, "wave_generator_load", 1e-3), color=ORANGE, label="bearing")
    right.set_ylim(bottom=0.0)
    axes.set_ylim(bottom=0.0)
    handles = [a + b for a, b in zip(axes.get_legend_handles_labels(), right.get_legend_handles_labels())]
    axes.legend(*handles, loc="lower right", bbox_to_anchor=(1.0, 0.95), ncol=2, borderpad=0.2, handlelength=1.5)


def draw(recording, title, path):
    """Writes the figure as PNG."""
    plt.rcParams.update({**STYLE, "figure.dpi": 120})
    # constrained_layout is not used, because in matplotlib 3.3 it leaves no room for a title above nested grids.
    figure = plt.figure(figsize=(13.5, 9.0))
    figure.suptitle(title, fontsize=13, fontweight="bold", x=0.01, y=0.985, ha="left")
    left, right = figure.add_gridspec(1, 2, width_ratios=[1.75, 1.0], left=0.055, right=0.965, bottom=0.06, top=0.925,
                                      wspace=0.12)
    rows = left.subgridspec(6, 1, height_ratios=[1, 1, 1, 1, 0.1, 1.5], hspace=0.34)  # room for the scale of the map
    axes = [figure.add_subplot(rows[0])]
    axes += [figure.add_subplot(rows[row], sharex=axes[0]) for row in (1, 2, 3, 5)]
    end = recording["health"].time[-1]
    draw_motor_torque(axes[0], recording, end)
    draw_torques(axes[1], recording, end)
    draw_speed(axes[2], recording)
    draw_torsion(axes[3], recording)
    draw_tooth_map(axes[4], recording, figure)
    for one in axes[:-1]:
        one.tick_params(labelbottom=False)
    axes[0].set_xlim(0.0, end)
    columns = right.subgridspec(4, 1, height_ratios=[2.1, 0.05, 1.2, 1.0], hspace=0.34)  # room for the ring's legend
    draw_ring(figure.add_subplot(columns[0], projection="polar"), recording)
    draw_loop(figure.add_subplot(columns[2]), recording)
    draw_health(figure.add_subplot(columns[3]), recording)
    figure.savefig(path)
    plt.close(figure)
