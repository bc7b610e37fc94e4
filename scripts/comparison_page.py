# SPDX-License-Identifier: BSD-3-Clause
"""Makes the page and the figures of a report from the data that `joint_twin compare` or `joint_twin trend` has written.

`compare` of an arm gives a page for each joint and one for the arm. Each figure is drawn twice, for wide and for narrow
screens. Both are in the page, and as files beside it."""
import argparse
import base64
import concurrent.futures
import datetime
import json
import os
import signal
import sys

try:
    import jinja2
    import numpy as np
    from drawing import plt
except ImportError as missing:
    sys.exit(f"comparison_page: {missing.name} is not installed; apt-get install python3-{missing.name.split('.')[0]}")

from matplotlib.dates import AutoDateLocator, ConciseDateFormatter
from matplotlib.ticker import MaxNLocator

GREY, BLUE, RED, GREEN, ORANGE = "#7a7a7a", "#0072B2", "#D55E00", "#009E73", "#E69F00"
DPI = 130
STYLE = {"figure.dpi": DPI, "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
         "grid.color": "0.9", "grid.linewidth": 0.6, "axes.axisbelow": True, "axes.titlesize": 9.5,
         "axes.titlelocation": "left", "legend.frameon": False, "legend.fontsize": 8, "lines.linewidth": 0.9,
         "axes.edgecolor": "0.5"}
WIDTHS = {"wide": 8.6, "narrow": 4.1}  # [inch]
SHOWN_INDICATORS = 12
LOWEST_ORDER = 0.3   # lowest order of ripple; errors of the load cause lower orders
RING_STRETCH = 10.0  # factor by which the deformation of the flexspline is drawn larger


def read_table(directory, name):
    """Columns of a table by name; None if the report lacks the table, or if the table has no rows."""
    path = os.path.join(directory, name + ".csv")
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        lines = file.readlines()
    return dict(zip(names, np.loadtxt(lines, delimiter=",", ndmin=2).T)) if lines else None


def new_figure(width, height, rows=1, columns=1, **settings):
    return plt.subplots(rows, columns, figsize=(width, height), constrained_layout=True, squeeze=False, **settings)


def with_gaps(time, *columns):
    """Time and columns, with a NaN at each gap between rows, so that no line is drawn over the gap."""
    step = np.diff(time)
    holes = np.flatnonzero(step > 20.0 * np.median(step)) + 1 if len(step) else []
    return [np.insert(column, holes, np.nan) for column in (time, *columns)]


def shift_to(course, twin, name):
    """Measured minus simulated angle at the first common instant. A twin does not start at the robot's position."""
    start = max(course["time"][0], twin["time"][0])
    return (np.interp(start, course["time"], course[name]) - np.interp(start, twin["time"], twin[name]))


def draw_course(width, data):
    course, twin = data["course"], data["twin_states"]
    if course is None:
        return None
    figure, axes = new_figure(width, 7.4, 4, sharex=True, gridspec_kw={"height_ratios": [1, 1, 1.5, 1]})
    position, speed, current, residual = axes[:, 0]
    time, angle, velocity, measured, predicted, band = with_gaps(
        course["time"], course["position"], course["velocity"], course["current_measured"], course["current_predicted"],
        course["current_band"])
    position.set_title("Angle of the joint [rad]")
    position.plot(time, angle, color=GREY, label="measured")
    speed.set_title("Speed [rad/s]")
    speed.plot(time, velocity, color=GREY, label="measured")
    if twin is not None:
        position.plot(twin["time"], twin["position"] + shift_to(course, twin, "position"), color=BLUE,
                      label="twin that ran beside it")
        speed.plot(twin["time"], twin["velocity"], color=BLUE)
        position.legend(loc="best", ncol=2)
    current.set_title("Motor current [A]")
    current.plot(time, measured, color=GREY, lw=0.8, label="measured")
    current.fill_between(time, predicted - band, predicted + band, color=BLUE, alpha=0.2, lw=0,
                         label="open: stiction")
    current.plot(time, predicted, color=BLUE, lw=0.8, label="healthy twin")
    span = np.nanpercentile(measured, [0.1, 99.9])
    reach = max(0.5, span[1] - span[0])
    current.set_ylim(span[0] - 0.25 * reach, span[1] + 0.35 * reach)
    current.legend(loc="upper right", ncol=3, columnspacing=1.0, handlelength=1.3)
    residual.set_title("Measured less twin [A]")
    residual.plot(time, measured - predicted, color=RED, lw=0.7)
    limit = 1.3 * max(0.05, np.nanpercentile(np.abs(measured - predicted), 99.5))
    begin, end = course["time"][0], course["time"][-1]
    residual.set(ylim=(-limit, limit), xlabel="time [s]", xlim=(begin, end if end > begin else begin + 1.0))
    return figure


def draw_factor(axes, points, record):
    """Draws the interval of the friction factor as a band about the mean measured friction, for each direction. Band
    and measured friction include the common factor of the joints."""
    factor = record["friction_factor"]
    if factor is None:
        return
    mean = record["friction_ratio"] / factor["value"] * points["twin"]
    label = "95 % interval of the mean"
    for rows in (points["speed"] < 0.0, points["speed"] > 0.0):
        axes.fill_between(points["speed"][rows], factor["low"] * mean[rows], factor["high"] * mean[rows], color=RED,
                          alpha=0.15, lw=0, label=label)
        label = None


def draw_friction(width, data):
    points, curve = data["friction"], data["friction_twin"]
    if points is None:
        return None
    figure, axes = new_figure(width, 3.6 if width > 6 else 3.9)
    axes = axes[0][0]
    axes.set_title("Friction at the joint against the motion [N·m]")
    for way in (-1.0, 1.0):
        if not (np.sign(points["speed"]) == way).any():
            continue
        label = way == np.sign(points["speed"])[0]
        axes.fill_between(way * curve["speed"], curve["at_typical_load"], curve["at_largest_load"], color=BLUE,
                          alpha=0.18,
                          lw=0, label="twin, typical to largest load" if label else None)
        axes.plot(way * curve["speed"], curve["at_typical_load"], color=BLUE, label=None)
    axes.plot(points["speed"], points["twin"], ls="", marker="o", ms=5, mfc="none", color=BLUE,
              label="twin, same rows")
    axes.errorbar(points["speed"], points["measured"], yerr=points["deviation"], ls="", marker="o", ms=4, color=RED,
                  elinewidth=0.7, label="measured, and its scatter")
    draw_factor(axes, points, data["record"])
    axes.set_ylim(bottom=min(0.0, np.min(points["measured"] - points["deviation"])))
    axes.set_xlabel("speed [rad/s]")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17 if width > 6 else -0.15), ncol=2 if width > 6 else 1)
    return figure


def draw_torsion(width, data):
    means, twin = data["torsion"], data["torsion_twin"]
    if means is None:
        return None
    figure, axes = new_figure(width, 3.8)
    axes = axes[0][0]
    axes.set_title("Torsion: motor angle over ratio less joint angle [mrad]")
    axes.plot(twin["torque"], 1e3 * twin["torsion"], color=BLUE, label="twin's loop")
    axes.plot(means["torque"], 1e3 * means["forward"], ls="", marker=">", ms=4, color=RED, label="measured, forward")
    axes.plot(means["torque"], 1e3 * means["backward"], ls="", marker="<", ms=4, color=ORANGE, label="backward")
    axes.set_xlabel("joint torque [N·m]")
    axes.legend(loc="upper left")
    return figure


def draw_spectrum(width, data):
    spectrum = data["spectrum"]
    if spectrum is None:
        return None
    figure, axes = new_figure(width, 3.4 if width > 6 else 3.8)
    axes = axes[0][0]
    axes.set_title("Amplitude in the current's residual [A]")
    for name, colour, label in (("forward", BLUE, "forward"), ("backward", ORANGE, "backward")):
        if spectrum[name].any():
            axes.plot(spectrum["order"], spectrum[name], color=colour, lw=0.8, label=label)
    ripple = spectrum["order"] > LOWEST_ORDER
    top = 1.3 * max(spectrum["forward"][ripple].max(), spectrum["backward"][ripple].max())
    for name, text in (("wave_generator_1", "1"), ("wave_generator_2", "2"), ("wave_generator_4", "4"),
                       ("cage_lobes", "cage"), ("ball", "ball"), ("outer", "outer race"), ("inner", "inner race")):
        order = data["record"]["line_orders"][name]
        axes.axvline(order, color="0.75", lw=0.7, zorder=0)
        axes.text(order, top, " " + text, rotation=90, va="top", ha="right", fontsize=7, color="0.35")
    resolved = data["record"]["highest_order"]
    if resolved < spectrum["order"][-1]:
        axes.axvspan(resolved, spectrum["order"][-1], color="0.93", lw=0, zorder=-1)
        if resolved < 0.75 * spectrum["order"][-1]:
            axes.text(resolved, 0.7 * top, "  too few rows a turn\n  at the highest speed", fontsize=7, color="0.35")
    axes.set(xlim=(0.0, spectrum["order"][-1]), ylim=(0.0, top), xlabel="order: cycles per turn of the motor")
    axes.legend(loc="upper right", bbox_to_anchor=(1.0, 1.14), ncol=2)
    return figure


def draw_teeth(width, data):
    teeth, motion = data["teeth"], data["record"]["motion"]
    side_by_side = width > 6
    figure, axes = new_figure(width, 4.0 if side_by_side else 7.4, *((1, 2) if side_by_side else (2, 1)),
                              subplot_kw={"projection": "polar"})
    angle = np.arctan2(teeth["y"], teeth["x"])
    radius = np.hypot(teeth["x"], teeth["y"])
    loop = np.append(np.arange(len(angle)), 0)
    scale = max(np.abs(teeth["mesh_largest"]).max(), teeth["wave_generator_largest"].max(), 1e-9)
    ring = 1.5 * scale * (1.0 + RING_STRETCH * (radius / radius.mean() - 1.0))
    for one, case in zip(axes.flat, ("typical", "largest")):
        mesh, contact = np.abs(teeth["mesh_" + case]), teeth["wave_generator_" + case]
        one.fill_between(angle[loop], (ring - contact)[loop], ring[loop], color=BLUE, alpha=0.4, lw=0,
                         label=f"wave generator, up to {contact.max():.0f} N")
        loaded = mesh > 0.0
        one.bar(angle[loaded], mesh[loaded], width=2.0 * np.pi / len(angle), bottom=ring[loaded], color=RED, lw=0,
                label=f"mesh, up to {mesh.max():.0f} N on {np.count_nonzero(mesh > 1.0)} teeth")
        one.plot(angle[loop], ring[loop], color="black", lw=0.9)
        one.set_ylim(0.0, ring.max() + 0.85 * scale)
        one.set_axis_off()
        one.set_title(f"{case} load, {motion[case + '_load']:.0f} N·m", loc="center", y=0.93)
        one.legend(loc="upper center", bbox_to_anchor=(0.5, 0.06))
    return figure


def draw_windows(width, data):
    windows = data["windows"]
    if windows is None or not data["record"]["windows_assessed"]:
        return None
    figure, axes = new_figure(width, 2.6)
    axes = axes[0][0]
    axes.set_title("Largest deviation of a window over its threshold")
    axes.axhline(1.0, color=ORANGE, lw=0.8)
    for level, colour, name in ((0, GREY, "OK"), (1, ORANGE, "WARN"), (2, RED, "ERROR")):
        part = windows["level"] == level
        if part.any():
            axes.plot(windows["time"][part], windows["largest_score"][part], ls="", marker="o", ms=3.5, color=colour,
                      label=name)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("end of the window [s]")
    axes.legend(loc="upper right", bbox_to_anchor=(1.0, 1.22 if width > 6 else 1.35), ncol=3)
    return figure


FIGURES = {"course": draw_course, "friction": draw_friction, "torsion": draw_torsion, "spectrum": draw_spectrum,
           "teeth": draw_teeth, "windows": draw_windows}


def recording_times(trend):
    """For each recording its date, or None without one. If no recording has a date, the numbers of the recordings."""
    if not trend["has_dates"]:
        return list(range(1, len(trend["recordings"]) + 1))
    dates = [recording["date"] for recording in trend["recordings"]]
    return [date and datetime.datetime.strptime(date, "%Y-%m-%dT%H:%M:%SZ") for date in dates]


def joint_rows(trend, place):
    """(time, fields of the joint) of each recording that could be read."""
    return [(time, recording["joints"][place]) for time, recording in zip(recording_times(trend), trend["recordings"])
            if recording["joints"]]


def draw_joint_trend(axes, trend, place):
    joint, rows = trend["joints"][place], joint_rows(trend, place)
    axes.set_title(f"{joint['joint']}: {joint['level']}")
    for level, colour in (("OK", BLUE), ("WARN", ORANGE), ("ERROR", RED), ("NOT JUDGED", GREY)):
        part = [(time, row) for time, row in rows if row["friction_for_trend"] is not None and row["level"] == level]
        if part:
            value, at, low, high = (np.array([row[name] for _, row in part]) for name in
                                    ("friction_for_trend", "friction", "friction_low", "friction_high"))
            axes.errorbar([time for time, _ in part], value, yerr=(value * (1.0 - low / at), value * (high / at - 1.0)),
                          ls="", marker="o", ms=4, color=colour, elinewidth=0.8)
    without = [time for time, row in rows if row["friction_for_trend"] is None]
    if without:
        axes.plot(without, np.full(len(without), 0.04), ls="", marker="x", ms=4, color=GREY,
                  transform=axes.get_xaxis_transform())
    judged = [(time, row) for time, row in rows if row["friction_for_trend"] is not None]
    if joint["level"] == "WARN":
        at = np.array([(time - judged[0][0]) / (judged[-1][0] - judged[0][0]) for time, _ in judged])
        logarithms = np.log([row["friction_for_trend"] for _, row in judged])
        weights = np.array([np.log(row["friction_high"] / row["friction_low"]) for _, row in judged]) ** -2.0
        middle = np.average(logarithms - np.log(joint["change"]) * at, weights=weights)
        axes.plot([time for time, _ in judged], np.exp(middle + np.log(joint["change"]) * at), color=RED)
    axes.axhline(1.0, color="0.6", lw=0.7)


def mark_times(axes, trend):
    locator = AutoDateLocator(maxticks=5) if trend["has_dates"] else MaxNLocator(5, integer=True)
    axes.xaxis.set_major_locator(locator)
    if trend["has_dates"]:
        axes.xaxis.set_major_formatter(ConciseDateFormatter(locator))
    else:
        axes.set_xlabel("number of the recording")


def draw_trend_friction(width, trend):
    columns = 1 if width < 6 else min(3, len(trend["joints"]))
    lines = -(-len(trend["joints"]) // columns)
    figure, axes = new_figure(width, 2.2 * lines + 0.4, lines, columns, sharex=True, sharey=True)
    for place, one in enumerate(axes.flat):
        draw_joint_trend(one, trend, place)
    for one in axes[-1]:
        mark_times(one, trend)
    return figure


def draw_trend_temperature(width, trend):
    times = recording_times(trend)
    received = [(joint["joint"], [(time, row["temperature"]) for time, row in joint_rows(trend, place)
                                  if row["temperature_source"] == "received"])
                for place, joint in enumerate(trend["joints"])]
    estimated = [(time, recording["temperature_estimate"]) for time, recording in zip(times, trend["recordings"])
                 if recording["temperature_estimate"] is not None]
    if not estimated and not any(rows for _, rows in received):
        return None
    figure, axes = new_figure(width, 2.8)
    axes = axes[0][0]
    axes.set_title("Temperature of the joints [°C]")
    for name, rows in [*received, ("by the friction in common", estimated)]:
        if rows:
            axes.plot(*zip(*rows), marker="o", ms=3.5, ls="--" if rows is estimated else "-", label=name)
    axes.legend(loc="best", ncol=2)
    mark_times(axes, trend)
    return figure


TREND_FIGURES = {"friction": draw_trend_friction, "temperature": draw_trend_temperature}


def draw_all(directory, data, figures):
    """Writes each figure that has data, in each width. Returns the pictures as data URIs, by name and width."""
    plt.rcParams.update(STYLE)
    pictures = {}
    for name, draw in figures.items():
        for kind, width in WIDTHS.items():
            figure = draw(width, data)
            if figure is None:
                continue
            path = os.path.join(directory, f"{name}.png" if kind == "wide" else f"{name}_{kind}.png")
            figure.canvas.print_png(path)  # savefig would draw and lay out everything twice
            plt.close(figure)
            with open(path, "rb") as file:
                text = base64.b64encode(file.read()).decode("ascii")
            pictures.setdefault(name, {})[kind] = "data:image/png;base64," + text
    return pictures


def read_record(directory, name):
    with open(os.path.join(directory, name), encoding="utf-8") as file:
        return json.load(file)


def write_page(directory, template, **values):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(os.path.dirname(os.path.abspath(__file__))),
                                     autoescape=True, trim_blocks=True, lstrip_blocks=True)
    environment.filters["short"] = lambda value: "" if value is None else f"{value:.3g}"
    with open(os.path.join(directory, "report.html"), "w", encoding="utf-8") as file:
        file.write(environment.get_template(template).render(**values))


def make_joint_page(directory):
    record = read_record(directory, "comparison.json")
    data = {name: read_table(directory, name) for name in ("course", "friction", "friction_twin", "spectrum", "torsion",
                                                           "torsion_twin", "teeth", "twin_states", "windows")}
    data["record"] = record
    pictures = draw_all(directory, data, FIGURES)
    health = sorted(record["health"], key=lambda row: -abs(row["score"]))
    write_page(directory, "comparison_page.html", record=record, pictures=pictures, health=health,
               shown=SHOWN_INDICATORS, twin_beside=data["twin_states"] is not None)


def make_trend_page(directory):
    trend = read_record(directory, "trend.json")
    write_page(directory, "trend_page.html", trend=trend, pictures=draw_all(directory, trend, TREND_FIGURES))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("directory", help="directory that `--report` of compare or trend has written")
    directory = parser.parse_args().directory
    if os.path.exists(os.path.join(directory, "trend.json")):
        make_trend_page(directory)
        return
    if not os.path.exists(os.path.join(directory, "arm.json")):
        make_joint_page(directory)
        return
    arm = read_record(directory, "arm.json")
    quiet = dict(initializer=signal.signal, initargs=(signal.SIGINT, signal.SIG_IGN))
    with concurrent.futures.ProcessPoolExecutor(**quiet) as pool:
        list(pool.map(make_joint_page, [os.path.join(directory, joint["joint"]) for joint in arm["joints"]]))
    write_page(directory, "arm_page.html", arm=arm)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit("comparison_page: interrupted")
