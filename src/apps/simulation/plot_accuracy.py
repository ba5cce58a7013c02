#!/usr/bin/env python3
"""Draws what accuracy_benchmark --plot DIR has written to DIR/maps.csv: a picture for each scene, and one of all."""
import csv
import math
import pathlib
import sys
from collections import defaultdict

DISTANCES = (0, 5, 10, 20, 30, 50)  # [m]


def number(text):
    return float(text) if text else math.nan


def rms(values):
    known = [value for value in values if not math.isnan(value)]
    return math.sqrt(sum(value * value for value in known) / len(known)) if known else math.nan


def read(file):
    """{scene: {method: [row, ...]}}; where a scene was driven with its lines and without, methods come twice."""
    scenes = defaultdict(lambda: defaultdict(list))
    with open(file, newline="") as stream:
        rows = list(csv.DictReader(stream))
    with_lines = {row["scene"] for row in rows if row["markers_alone"] == "0"}
    for row in rows:
        alone = row["markers_alone"] == "1" and row["scene"] in with_lines
        scenes[row["scene"]][row["method"] + (", markers alone" if alone else "")].append(row)
    return scenes


def profile(rows):
    return [rms([number(row[f"center_at_{distance}_m"]) for row in rows]) for distance in DISTANCES]


def draw_scene(plt, name, methods, file):
    figure, axes = plt.subplots(4, 1, figsize=(10, 14), constrained_layout=True)
    first_seed = next(iter(methods.values()))[0]["seed"]
    for i, (method, rows) in enumerate(methods.items()):
        color = f"C{i}"
        drive = [row for row in rows if row["seed"] == first_seed]
        times = [number(row["time"]) for row in drive]
        for axis, distance in zip(axes, (10, 30)):
            axis.plot(times, [number(row[f"center_at_{distance}_m"]) for row in drive], label=method,
                      color=color, linewidth=1)
        axes[3].plot(DISTANCES, profile(rows), marker="o", label=method, color=color)
        claims = [3.0 * number(row["claimed"]) for row in drive]
        if any(not math.isnan(claim) for claim in claims):
            axes[2].plot(times, [number(row["beside"]) for row in drive], label=method, color=color, linewidth=1)
            axes[2].fill_between(times, [-claim for claim in claims], claims, alpha=0.15, color=color)
    for axis, distance in zip(axes, (10, 30)):
        axis.set_title(f"{name}: error of the center {distance} m ahead, drive {first_seed}, left positive")
        axis.set_xlabel("time [s]")
    axes[2].set_title("at the vehicle, and three of the standard deviations that the maps claim")
    axes[2].set_xlabel("time [s]")
    axes[3].set_title("RMS of all drives")
    axes[3].set_xlabel("distance ahead [m]")
    axes[3].set_ylim(bottom=0)
    for axis in axes:
        axis.set_ylabel("[m]")
        axis.grid(alpha=0.3)
        if axis.has_data():
            axis.legend()
    figure.savefig(file, dpi=100)
    plt.close(figure)


def draw_all(plt, scenes, file):
    names = list(scenes)
    methods = list(dict.fromkeys(method for scene in scenes.values() for method in scene))
    figure, axes = plt.subplots(2, 1, figsize=(max(12, 0.5 * len(names)), 9), constrained_layout=True)
    for axis, distance in zip(axes, (10, 30)):
        for i, method in enumerate(methods):
            heights = [rms([number(row[f"center_at_{distance}_m"]) for row in scenes[name].get(method, [])])
                       for name in names]
            width = 0.8 / len(methods)
            axis.bar([k - 0.4 + (i + 0.5) * width for k in range(len(names))], heights, width, label=method)
        axis.set_xticks(range(len(names)))
        axis.set_xticklabels(names, rotation=30, ha="right")
        axis.set_ylabel("[m]")
        axis.set_title(f"RMS of the center's error {distance} m ahead")
        axis.grid(alpha=0.3, axis="y")
        axis.legend()
    figure.savefig(file, dpi=100)
    plt.close(figure)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: plot_accuracy.py DIR, where accuracy_benchmark --plot DIR has been")
    try:
        import matplotlib
    except ImportError:
        sys.exit("plot_accuracy.py: matplotlib is missing: apt-get install python3-matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    folder = pathlib.Path(sys.argv[1])
    scenes = read(folder / "maps.csv")
    for name, methods in scenes.items():
        draw_scene(pyplot, name, methods, folder / f"{name}.png")
    draw_all(pyplot, scenes, folder / "all.png")
    print(f"{len(scenes) + 1} pictures are in {folder}")


if __name__ == "__main__":
    main()
