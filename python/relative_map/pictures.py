"""The pictures of plot_maps: bird's view, curves over time, single maps. Colours by Okabe and Ito, as in rviz."""
import os

import numpy
from matplotlib import pyplot
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import FuncFormatter, NullFormatter

from relative_map.bags import JUMP, SOURCES, STATUS_NAMES

BLUE, GREEN, PURPLE, GREY = "#0072B2", "#009E73", "#CC79A7", "#8A8A8A"
ORANGE, VERMILLION, YELLOW, SKY, BLACK = "#E69F00", "#D55E00", "#F0E442", "#56B4E9", "#202020"
PRIORITY_COLORS = (BLUE, GREEN, PURPLE, GREY)  # of 0, 1, 2, and all others
SOURCE_COLORS = (VERMILLION, BLACK, ORANGE, SKY)  # none, line + markers, line alone, markers alone
FAINT, STRONG = 0.22, 0.60  # fills of the other lanes, and of the current one
# Line colour and dashes of each type of paint; white is drawn in black rims.
PAINT = {1: (YELLOW, (3, 3)), 2: ("white", (3, 3)), 3: (YELLOW, None), 4: ("white", None), 5: (YELLOW, None),
         6: (VERMILLION, None)}
pyplot.rcParams["axes.formatter.useoffset"] = False  # 1.75 stays readable
ZOOM = (80.0, 32.0)  # [m] width and height of a close view
AHEAD, BEHIND, SIDE = 110.0, 10.0, 14.0  # [m] of a single map


def save(figure, path):
    """All of it or nothing: what was there before is harmed by neither a full disk nor an interrupt."""
    unfinished = path + ".part"
    try:
        figure.savefig(unfinished, dpi=110, facecolor="white", format=os.path.splitext(path)[1][1:])
        os.replace(unfinished, path)
    finally:
        pyplot.close(figure)
        if os.path.exists(unfinished):
            os.remove(unfinished)


def priority_color(priority):
    return PRIORITY_COLORS[min(priority, len(PRIORITY_COLORS) - 1)]


def pale(color, share):
    """Opaque, so that it looks the same where stretches of a lane overlap."""
    return 1.0 - share * (1.0 - numpy.array(to_rgb(color)))


def fill_of(lane):
    return pale(priority_color(lane.priority), STRONG if lane.current else FAINT)


def draw_lanes(axis, lanes, scale=1.0):
    """`scale`: of line widths; 0: no lines."""
    lanes = [lane for lane in lanes if len(lane.left) > 1 and len(lane.right) > 1]
    axis.add_collection(PolyCollection([numpy.concatenate((lane.left, lane.right[::-1])) for lane in lanes],
                                       facecolors=[fill_of(lane) for lane in lanes], linewidths=0, zorder=1))
    strokes = {}
    if scale == 0.0:
        return
    for points, kind in (stretch for lane in lanes for side in lane.paint for stretch in side):
        if len(points) > 1:
            strokes.setdefault(kind, []).append(points)
    for kind, lines in strokes.items():
        if kind not in PAINT:
            axis.add_collection(LineCollection(lines, colors="#707070", linewidths=0.8 * scale, zorder=2))
            continue
        color, dashes = PAINT[kind]
        axis.add_collection(LineCollection(lines, colors=BLACK, linewidths=2.8 * scale, zorder=3))
        style = "solid" if dashes is None else (0, dashes)
        axis.add_collection(LineCollection(lines, colors=color, linewidths=1.6 * scale, linestyles=style, zorder=4))


def lane_legend(lanes):
    seen = sorted({min(lane.priority, 3) for lane in lanes})
    names = {0: "priority 0 (best)", 3: "priority 3 and on"}
    handles = [Patch(color=pale(priority_color(priority), STRONG), label=names.get(priority, "priority %d" % priority))
               for priority in seen]
    return handles + [Patch(color=pale(BLACK, FAINT), label="pale: not the current lane")]


def draw_way(axis, drive, width):
    """The way of the vehicle, in the colours of the lane's source."""
    points = numpy.column_stack((drive.x, drive.y))
    steps = numpy.stack((points[:-1], points[1:]), axis=1)
    jump = numpy.hypot(*(points[1:] - points[:-1]).T) > JUMP
    good = numpy.isfinite(steps).all(axis=(1, 2)) & ~jump
    colors = numpy.array(SOURCE_COLORS)[numpy.where(drive.driven[1:], numpy.minimum(drive.source[1:], 3), 0)]
    axis.add_collection(LineCollection(steps[good], colors=colors[good], linewidths=width, zorder=6, capstyle="round"))
    empty = ~drive.driven & numpy.isfinite(drive.x)
    axis.plot(drive.x[empty], drive.y[empty], "x", color=VERMILLION, markersize=5, zorder=7)


def close_views(drive):
    """Where to look closely: the start, the middle and the end of the way."""
    known = numpy.flatnonzero(numpy.isfinite(drive.x + drive.y))
    way = numpy.concatenate(([0.0], numpy.cumsum(numpy.hypot(numpy.diff(drive.x[known]), numpy.diff(drive.y[known])))))
    middles = [min(ZOOM[0] / 3, way[-1]), way[-1] / 2, max(way[-1] - ZOOM[0] / 3, 0.0)]
    return [known[int(numpy.searchsorted(way, middle).clip(0, len(known) - 1))] for middle in middles]


def vehicle_legend(drive):
    used = {0 if not driven else min(source, 3) for driven, source in zip(drive.driven, drive.source)}
    handles = [Line2D([], [], color=SOURCE_COLORS[source], linewidth=2.5, marker="" if source else "x",
                      linestyle="-" if source else "", label="vehicle: " + SOURCES[source]) for source in sorted(used)]
    return handles + [Line2D([], [], color=BLACK, marker="o", linestyle="", label="start"),
                      Line2D([], [], color=BLACK, marker="s", linestyle="", label="end")]


def bird_view(drive, title, path):
    known = numpy.isfinite(drive.x + drive.y)
    lanes = [lane for stretch in drive.stretches for lane in stretch]
    shown = numpy.concatenate([numpy.column_stack((drive.x, drive.y))[known]] + [lane.center for lane in lanes])
    places = close_views(drive)
    corners = [numpy.array((drive.x[place], drive.y[place])) - numpy.array(ZOOM) / 2 for place in places]
    shown = numpy.concatenate((shown, corners, numpy.array(corners) + ZOOM))
    low, high = shown.min(axis=0) - 8.0, shown.max(axis=0) + 8.0
    height = 12.2 * min(max((high - low)[1] / (high - low)[0], 0.06), 0.7)
    figure = pyplot.figure(figsize=(13.0, height + 4.0), constrained_layout=True)
    grid = figure.add_gridspec(3, 3, height_ratios=(height + 0.6, 2.2, 0.6))
    axis = figure.add_subplot(grid[0, :])
    # On a long way the lanes are so narrow that their paint would cover them.
    draw_lanes(axis, lanes, scale=0.5 if high[0] - low[0] < 250.0 else 0.0)
    draw_way(axis, drive, 1.4)
    for index, sign in zip(numpy.flatnonzero(known)[[0, -1]], "os"):
        axis.plot(drive.x[index], drive.y[index], sign, color=BLACK, markersize=8, zorder=8)
    axis.set_xlim(low[0], high[0])
    axis.set_ylim(low[1], high[1])
    axis.set_title(title)
    axis.set_xlabel("east [m]")
    axis.set_ylabel("north [m]")
    for column, (letter, place, corner) in enumerate(zip("ABC", places, corners)):
        axis.add_patch(Rectangle(corner, *ZOOM, fill=False, edgecolor=BLACK, linewidth=0.8, zorder=9))
        axis.annotate(letter, corner, xytext=(3, 3), textcoords="offset points", fontweight="bold", zorder=9)
        view = figure.add_subplot(grid[1, column])
        draw_lanes(view, lanes, scale=0.8)
        draw_way(view, drive, 2.2)
        view.set_xlim(corner[0], corner[0] + ZOOM[0])
        view.set_ylim(corner[1], corner[1] + ZOOM[1])
        view.set_title("%s: at %.0f s" % (letter, drive.seconds[place]), fontsize=10)
    for each in figure.axes:
        each.set_aspect("equal")
        each.grid(alpha=0.25, linewidth=0.5)
        each.tick_params(labelsize=8)
    legend = figure.add_subplot(grid[2, :])
    legend.axis("off")
    legend.legend(handles=vehicle_legend(drive) + lane_legend(lanes), loc="center", ncol=5, frameon=False, fontsize=9)
    save(figure, path)


def shade_gaps(axes, drive):
    """Where there was no map."""
    edges = numpy.flatnonzero(numpy.diff(numpy.concatenate(([1], drive.driven, [1]))))
    ends = numpy.append(drive.seconds, drive.seconds[-1] + 0.1)
    for start, end in zip(edges[::2], edges[1::2]):
        for axis in axes:
            axis.axvspan(ends[start], ends[end], color=VERMILLION, alpha=0.18, linewidth=0)


def with_band(axis, drive, name, color, label, factor=1.0):
    values, sigma = factor * getattr(drive, name), factor * getattr(drive, name + "_stddev")
    axis.plot(drive.seconds, values, color=color, linewidth=1.3, label=label)
    if numpy.isfinite(sigma).any():
        axis.fill_between(drive.seconds, values - sigma, values + sigma, color=color, alpha=0.25, linewidth=0,
                          label="$\\pm 1\\sigma$")


def draw_source(axis, drive):
    kinds = numpy.where(drive.driven, numpy.minimum(drive.source, 3), 0)
    used = sorted(set(kinds))
    ends = numpy.append(drive.seconds[1:], drive.seconds[-1] + 0.1)
    for row, kind in enumerate(used):
        spans = [(start, min(end - start, 0.5)) for start, end in zip(drive.seconds[kinds == kind], ends[kinds == kind])]
        axis.broken_barh(spans, (row - 0.3, 0.6), color=SOURCE_COLORS[kind], linewidth=0.3)
    reasons = ", ".join(sorted({STATUS_NAMES.get(code, str(code)) for code in drive.code[~drive.driven]}))
    axis.set_yticks(range(len(used)))
    axis.set_yticklabels([SOURCES[kind] for kind in used])
    axis.set_ylim(-0.6, len(used) - 0.4)
    axis.set_title("where the current lane comes from" + ("; no map: " + reasons if reasons else ""))


def draw_ages(axis, drive):
    series = ((drive.map_age, BLUE, "map: from its stamp to the bag's time"),
              (drive.marker_age, ORANGE, "lane markers: from their stamp to the map's"))
    for values, color, label in series:
        if numpy.isfinite(values).any():
            axis.plot(drive.seconds, 1e3 * values, color=color, linewidth=1.0, label=label)


def draw_rate(axis, drive):
    axis.plot(drive.seconds[1:], 1e3 * numpy.diff(drive.seconds), ".", color=BLUE, markersize=3,
              label="from map to map")
    if numpy.isfinite(drive.tick_time).any():
        axis.plot(drive.seconds, drive.tick_time, color=ORANGE, linewidth=1.2, label="a tick's work, from /diagnostics")
    axis.set_yscale("log")
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: "%g" % value))
    axis.yaxis.set_minor_formatter(NullFormatter())
    lowest, highest = axis.get_ylim()
    axis.set_ylim(min(lowest, 50.0), max(highest, 500.0))


def curves(drive, title, path):
    longitudinal = numpy.isfinite(drive.longitudinal_offset_stddev).any() or numpy.any(drive.longitudinal_offset > 0)
    rows = 7 + bool(longitudinal)
    figure, axes = pyplot.subplots(rows, 1, sharex=True, figsize=(13.0, 1.75 * rows), constrained_layout=True,
                                   gridspec_kw={"height_ratios": [0.55] + [1.0] * (rows - 1)})
    rest = iter(axes)
    figure.suptitle(title)
    draw_source(next(rest), drive)

    def panel(title, unit, *shown):
        """`shown`: values that the scale has room for, lest noise looks like motion."""
        axis = next(rest)
        axis.set_title(title)
        axis.set_ylabel(unit)
        axis.update_datalim([(0.0, value) for value in shown])
        return axis

    axis = panel("lateral offset, left positive", "[m]", -0.2, 0.2)
    with_band(axis, drive, "lateral_offset", BLUE, "lane from line")
    axis.plot(drive.seconds, drive.from_middle, color=ORANGE, linewidth=1.0, label="vehicle from the lane's middle")
    with_band(panel("heading offset, left positive", "[deg]", -0.5, 0.5), drive, "heading_offset", BLUE, "lane from line",
              180.0 / numpy.pi)
    if longitudinal:
        with_band(panel("longitudinal offset: true place from the localized one", "[m]", -0.5, 0.5), drive,
                  "longitudinal_offset", BLUE, "along the line")
    axis = panel("half widths of the current lane", "[m]", 1.4, 2.1)
    with_band(axis, drive, "left_half_width", BLUE, "left")
    with_band(axis, drive, "right_half_width", ORANGE, "right")
    axis = panel("how far ahead lane markers back the map", "[m]", 0.0, 50.0)
    axis.plot(drive.seconds, numpy.where(drive.driven, drive.marker_range, numpy.nan), color=BLUE, linewidth=1.3)
    axis.set_ylim(bottom=0.0)
    draw_rate(panel("time from map to map, and the work for one", "[ms]"), drive)
    draw_ages(panel("ages", "[ms]", 0.0, 100.0), drive)
    shade_gaps(axes, drive)
    for axis in axes:
        axis.title.set_fontsize(10)
        axis.grid(alpha=0.3, linewidth=0.5)
        if axis.get_legend_handles_labels()[0]:
            axis.legend(loc="upper right", fontsize=8, ncol=4, framealpha=0.85)
    axes[-1].set_xlabel("time since the bag's first map [s]")
    axes[-1].set_xlim(0.0, max(drive.seconds[-1], 0.1))
    save(figure, path)


def single_maps(maps, path):
    """`maps`: (title, lanes in the body frame, seen paint) each."""
    borders = numpy.concatenate([side for _, lanes, _ in maps for lane in lanes for side in (lane.left, lane.right)])
    near = borders[(borders[:, 0] > -BEHIND) & (borders[:, 0] < AHEAD), 1]
    right, left = max(near.min(initial=-6.0) - 2.0, -SIDE), min(near.max(initial=6.0) + 2.0, SIDE)
    # Laid out by hand, in inches: every map has the same scale, with no space lost.
    width, height = 12.2, 12.2 * (left - right) / (AHEAD + BEHIND)
    whole = len(maps) * (height + 0.55) + 1.0
    figure = pyplot.figure(figsize=(13.0, whole))
    for row, (title, lanes, paint) in enumerate(maps):
        bottom = whole - (row + 1) * (height + 0.55) + 0.25
        axis = figure.add_axes((0.65 / 13.0, bottom / whole, width / 13.0, height / whole))
        draw_lanes(axis, lanes)
        for lane in lanes:
            if lane.current:
                axis.plot(*lane.center.T, color=BLACK, linewidth=1.0, dashes=(8, 4), zorder=5)
        for points in paint:
            axis.plot(*points.T, color=ORANGE, linewidth=1.5, zorder=6)
        axis.plot([0.0], [0.0], marker=">", color=BLACK, markersize=11, zorder=7)
        axis.set_xlim(-BEHIND, AHEAD)
        axis.set_ylim(right, left)
        axis.set_aspect("equal")
        axis.set_title(title, fontsize=10)
        axis.set_ylabel("left [m]")
        axis.grid(alpha=0.25, linewidth=0.5)
    axis.set_xlabel("ahead of the vehicle [m]")
    handles = lane_legend([lane for _, lanes, _ in maps for lane in lanes])
    handles += [Line2D([], [], color=BLACK, marker=">", linestyle="", label="vehicle"),
                Line2D([], [], color=BLACK, linewidth=1.0, dashes=(8, 4), label="centerline"),
                Line2D([], [], color="#707070", linewidth=0.8, label="boundary without paint")]
    if any(paint for _, _, paint in maps):
        handles.append(Line2D([], [], color=ORANGE, linewidth=1.5, label="lane markers as seen"))
    figure.legend(handles=handles, loc="lower center", ncol=4, frameon=False, fontsize=9)
    save(figure, path)
