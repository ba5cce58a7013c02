"""Errors of predictions of recorded traffic: reads what predict_scene wrote and what then happened, and shares no
code with the predictor. Lengths in [m], times in [s]."""
import csv
import hashlib
import json
import math
from pathlib import Path

STEP = 0.1
HORIZONS = (1.0, 3.0, 5.0, 8.0)
# A road user counts if it moved by more than this in the last second, and if this much of its future is known.
MOVED = 1.0
FUTURE = 3.0
MISS = 2.0


class Track:
    """Positions by their place on the 0.1 s grid."""

    def __init__(self, kind, ego):
        self.kind = kind
        self.ego = ego
        self.points = {}

    def known(self, first, last):
        return all(i in self.points for i in range(first, last + 1))


def read_tracks(scene):
    """{id: Track} of SCENE/tracks.csv, as it was recorded."""
    tracks = {}
    with open(Path(scene) / 'tracks.csv', newline='') as stream:
        for row in csv.DictReader(stream):
            track = tracks.setdefault(row['id'], Track(row['type'], row.get('ego', '0') in ('1', '1.0')))
            track.points[round(float(row['t']) / STEP)] = (float(row['x']), float(row['y']))
    return tracks


def source_of(scene):
    """The recording that a scene is from: the name of the folder that it lies in, without what follows '_'."""
    return Path(scene).resolve().parent.name.split('_')[0]


def part_of(scene):
    """'look' or 'judge': a fixed rule, so that nobody tunes to what he reports."""
    return 'look' if hashlib.sha256(Path(scene).resolve().name.encode()).digest()[0] % 2 == 0 else 'judge'


def distance(a, b):
    return math.hypot(a[0] - b[0], a[1] - b[1])


class Errors:
    """What was measured of one kind of road users, method and horizon."""

    def __init__(self):
        self.rows = []

    def add(self, row):
        self.rows.append(row)

    def mean(self, name):
        values = [row[name] for row in self.rows if row.get(name) is not None]
        return sum(values) / len(values) if values else float('nan')


def mode_error(points, truth, count):
    """(ADE, FDE) over the first `count` points."""
    errors = [distance(p, q) for p, q in zip(points[:count], truth[:count])]
    return sum(errors) / count, errors[-1]


def along_across(points, truth, last):
    """The error at one point in the truth's direction there, and across it."""
    before = truth[max(0, last - 5)]
    dx, dy = truth[last][0] - before[0], truth[last][1] - before[1]
    length = math.hypot(dx, dy)
    if length < 0.1:
        dx, dy, length = 1.0, 0.0, 1.0
    ex, ey = points[last][0] - truth[last][0], points[last][1] - truth[last][1]
    return abs(ex * dx + ey * dy) / length, abs(ey * dx - ex * dy) / length


def within_sigma(mode, truth, last):
    """The error in standard deviations, along and across the mode's own direction."""
    points = mode['xy']
    before = points[max(0, last - 5)]
    dx, dy = points[last][0] - before[0], points[last][1] - before[1]
    length = math.hypot(dx, dy)
    if length < 0.3:
        return None
    ex, ey = truth[last][0] - points[last][0], truth[last][1] - points[last][1]
    sa, sc = mode['sigma'][last]
    return abs(ex * dx + ey * dy) / length / sa, abs(ey * dx - ex * dy) / length / sc


def distance_to_path(point, path):
    """From a point to a polyline, whose last segment goes on."""
    best = float('inf')
    for i in range(len(path) - 1):
        ax, ay = path[i]
        bx, by = path[i + 1]
        dx, dy = bx - ax, by - ay
        square = dx * dx + dy * dy
        if square < 1e-4:
            continue
        u = ((point[0] - ax) * dx + (point[1] - ay) * dy) / square
        u = max(0.0, u if i == len(path) - 2 else min(1.0, u))
        best = min(best, math.hypot(point[0] - ax - u * dx, point[1] - ay - u * dy))
    return best


def lane_hits(modes, truth, last):
    """{lane: (p, right)} of the ways that the modes take: right if the truth lies within 0.3 m of the nearest of them and
    2 m of it. Ways are told apart by their lane."""
    ways = {}
    for mode in modes:
        way = ways.setdefault(mode['lane'], [0.0, []])
        way[0] += mode['p']
        way[1].append(mode['xy'])
    gaps = {lane: min(distance_to_path(truth[last], path) for path in way[1]) for lane, way in ways.items()}
    nearest = min(gaps.values())
    return {lane: (way[0], gaps[lane] < min(MISS, nearest + 0.3)) for lane, way in ways.items()}


def score_object(entry, track, result):
    """Adds the errors of one predicted road user at one start."""
    start = round(entry['t'] / STEP)
    future = 0
    while start + future + 1 in track.points and future < 80:
        future += 1
    if track.ego or future < round(FUTURE / STEP) or not track.known(start - 10, start):
        return
    if distance(track.points[start], track.points[start - 10]) <= MOVED:
        return
    truth = [track.points[start + i] for i in range(1, future + 1)]
    modes = sorted(entry['modes'], key=lambda mode: -mode['p'])
    if not modes:
        result.setdefault('missing', []).append((entry['t'], entry['id']))
        return
    for horizon in HORIZONS:
        count = round(horizon / STEP)
        if future < count or len(modes[0]['xy']) < count:
            continue
        ade, fde = mode_error(modes[0]['xy'], truth, count)
        all_modes = [mode_error(mode['xy'], truth, count) for mode in modes[:6]]
        along, across = along_across(modes[0]['xy'], truth, count - 1)
        sigma = within_sigma(modes[0], truth, count - 1)
        row = {'ade': ade, 'fde': fde, 'min_ade': min(e[0] for e in all_modes), 'min_fde': min(e[1] for e in all_modes),
               'miss': float(fde > MISS), 'along': along, 'across': across,
               'in3': None if sigma is None else float(max(sigma) <= 3.0), 'deviations': sigma}
        if modes[0]['lane'] and horizon in (3.0, 5.0):
            hits = lane_hits(modes, truth, count - 1)
            row['hits'] = list(hits.values())
            row['top'] = float(hits[modes[0]['lane']][1])
        row['best_p'] = modes[min(range(len(all_modes)), key=lambda i: all_modes[i][1])]['p']
        row['hit_modes'] = [(mode['p'], e == min(all_modes)) for mode, e in zip(modes, all_modes)]
        result.setdefault((entry['type'], horizon), Errors()).add(row)


def score_file(predictions, scene, result):
    """Adds all that predict_scene wrote of a scene."""
    tracks = read_tracks(scene)
    with open(predictions) as stream:
        for line in stream:
            entry = json.loads(line)
            score_object(entry, tracks[str(entry['id'])], result)
    return result


def calibration_error(pairs, bins=10):
    """Mean distance between what was said and how often it came true, weighted by how often it was said."""
    groups = {}
    for p, right in pairs:
        group = groups.setdefault(min(bins - 1, int(p * bins)), [0, 0.0, 0])
        group[0] += 1
        group[1] += p
        group[2] += right
    total = sum(group[0] for group in groups.values())
    return sum(abs(group[1] - group[2]) for group in groups.values()) / total if total else float('nan')
