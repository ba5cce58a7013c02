"""The lanes of a relative_map/MapMsg as numpy arrays. Body frame: x forward, y left, in metres; angles in radians.

    for lane in lanes_of(message):
        if lane.current:
            y_in_20_m = numpy.interp(lane.vehicle_s + 20.0, lane.path["s"], lane.path["y"])
"""
import math

import numpy

OVERLAP = 0.3  # [m] of stretches that follow each other: no seam shows
SEARCHED = 25.0  # [m] of a curve, from its start: the vehicle is beside one of these points


PATH = numpy.dtype([(name, float) for name in ("x", "y", "theta", "kappa", "dkappa", "s")])


class Lane:
    """One lane of a map.

    left, right, center   N x 2 arrays [m] of the borders and the centerline, in the frame that they were carried to
    priority, current     0 is the best; whether the vehicle is in it
    paint                 of (left, right): [(points, type as in LaneBoundaryType)]
    id, speed_limit       as in the message; [m/s]
    vehicle_s             [m] along the path: where the vehicle is beside it
    path                  the whole centerline in the body frame: a structured array of x, y [m], theta [rad],
                          kappa [1/m], dkappa [1/m^2] and s [m] from its first point
    """

    def __init__(self, left, right, center, priority, current, paint, id="", speed_limit=math.nan, path=None,
                 vehicle_s=math.nan):
        self.left, self.right, self.center = left, right, center
        self.priority, self.current = priority, current
        self.paint = paint
        self.id, self.speed_limit, self.vehicle_s = id, speed_limit, vehicle_s
        self.path = numpy.empty(0, PATH) if path is None else path


def path_of(navigation_path):
    """The points of a LaneNavigationPath as a structured array, see Lane.path."""
    points = navigation_path.navigation_path.path.path_point
    return numpy.array([(p.x, p.y, p.theta, p.kappa, p.dkappa, p.s) for p in points], PATH)


def points_of(curve):
    points = [(point.x, point.y) for segment in curve.segment for point in segment.line_segment.point]
    return numpy.array(points).reshape(-1, 2)


def arc_lengths(points):
    return numpy.concatenate(([0.0], numpy.cumsum(numpy.hypot(*numpy.diff(points, axis=0).T))))


def part(points, start, end):
    """The points between two arc lengths, both ends interpolated."""
    s = arc_lengths(points)
    start, end = max(start, 0.0), min(end, s[-1])
    if end <= start:
        return numpy.empty((0, 2))
    wanted = numpy.concatenate(([start], s[(s > start) & (s < end)], [end]))
    return numpy.column_stack([numpy.interp(wanted, s, points[:, axis]) for axis in (0, 1)])


def foot_on(points, place, start, end):
    """Where along a curve, between two arc lengths, it passes a place, and how far [m] to its left that is: (s, l)."""
    s = arc_lengths(points)
    looked_at = (s[1:] >= start) & (s[:-1] <= end)
    looked_at[-1] |= not looked_at.any()
    starts, along, s = points[:-1][looked_at], numpy.diff(points, axis=0)[looked_at], s[:-1][looked_at]
    squares = numpy.maximum((along ** 2).sum(axis=1), 1e-12)
    to_place = numpy.array(place) - starts
    feet = starts + along * numpy.clip((to_place * along).sum(axis=1) / squares, 0.0, 1.0)[:, None]
    i = int(numpy.argmin(numpy.hypot(*(feet - place).T)))
    left = (along[i, 0] * to_place[i, 1] - along[i, 1] * to_place[i, 0]) / numpy.sqrt(squares[i])
    return s[i] + numpy.hypot(*(feet[i] - starts[i])), left


def beside_origin(points):
    """Where along a curve the vehicle, at the origin, is, and how far [m] to its left: (s, l).
    On a lap the curve may come by again farther on."""
    return foot_on(points, (0.0, 0.0), 0.0, SEARCHED)


def carried(points, pose):
    x, y, heading = pose
    c, s = math.cos(heading), math.sin(heading)
    return points @ numpy.array([[c, s], [-s, c]]) + (x, y)


def lanes_of(message, behind=math.inf, ahead=math.inf, until=None):
    """The lanes of a map in the body frame, so far [m] along them from the vehicle, or up to beside a place ahead."""
    def end(points, here):
        if until is None:
            return here + ahead
        return foot_on(points, until, here, here + SEARCHED + 2.0 * math.hypot(*until))[0]

    lanes = []
    paths = {path.lane_id: path for path in message.navigation_path}
    for lane in message.hdmap.lane:
        curves, paints = [], []
        for curve, kinds in ((lane.left_boundary.curve, lane.left_boundary.boundary_type),
                             (lane.right_boundary.curve, lane.right_boundary.boundary_type),
                             (lane.central_curve, [])):
            points = points_of(curve)
            if len(points) < 2 or not numpy.isfinite(points).all():
                break
            here = beside_origin(points)[0]
            first, last = here - behind, end(points, here) + OVERLAP
            curves.append(part(points, first, last))
            ends = [kind.s for kind in kinds[1:]] + [math.inf]
            paints.append([(part(points, max(kind.s, first), min(kind_end, last)), kind.types[0] if kind.types else 0)
                           for kind, kind_end in zip(kinds, ends)])
        if len(curves) == 3:
            path = paths.get(lane.id)
            lanes.append(Lane(*curves, path.navigation_path.path_priority if path else 99,
                              lane.id == message.current_lane_id, paints[:2], lane.id, lane.speed_limit,
                              path_of(path) if path else None, path.vehicle_s if path else math.nan))
    return lanes


def carry(lanes, pose):
    return [Lane(carried(lane.left, pose), carried(lane.right, pose), carried(lane.center, pose), lane.priority,
                 lane.current, [[(carried(points, pose), kind) for points, kind in side] for side in lane.paint],
                 lane.id, lane.speed_limit, lane.path, lane.vehicle_s)
            for lane in lanes]
