"""Reads a drive out of a bag of maps: numbers of every map, and the lanes along the way. `open_bag`, then `read_drive`."""
import math
import os
import sys

import numpy
import rosbag
from relative_map.lanes import beside_origin, carried, carry, lanes_of, points_of
from relative_map.msg import FusionState, MapMsg, MapStatus

LANE_STEP = 10.0  # [m] of driving between the maps whose lanes are kept
LANE_REACH = 40.0  # [m] ahead of the vehicle up to which they are
JUMP = 20.0  # [m] from map to map that is no driving

SOURCES = {FusionState.NONE: "no map", FusionState.FUSED: "line + markers", FusionState.NAVIGATION_LINE: "line alone",
           FusionState.LANE_MARKERS: "markers alone"}
STATUS_NAMES = {getattr(MapStatus, name): name for name in dir(MapStatus)
                if name.isupper() and isinstance(getattr(MapStatus, name), int)}
ESTIMATES = ("lateral_offset", "longitudinal_offset", "heading_offset", "left_half_width", "right_half_width")


class Fault(Exception):
    """What cannot be plotted, and why, in one sentence."""


class Drive:
    """Arrays with a number for each map; NaN where it has none. Positions are relative to `origin`."""

    def __init__(self, columns, origin, stretches, notes):
        for name in columns[0]:
            setattr(self, name, numpy.array([column[name] for column in columns]))
        self.origin, self.stretches, self.notes = origin, stretches, notes
        self.driven = (self.code == MapStatus.OK) & (self.lanes > 0)
        self.known = numpy.isfinite(self.x + self.y)
        self.seconds = (self.time - self.time[0]) * 1e-9
        steps = numpy.hypot(numpy.diff(self.x[self.known]), numpy.diff(self.y[self.known]))
        self.way = float(steps[steps < JUMP].sum())  # [m]

    def pose_at(self, stamp):
        """x, y and heading at a map's stamp [ns], between the poses of the maps."""
        known = numpy.flatnonzero(numpy.isfinite(self.x + self.heading))
        if not len(known):
            return math.nan, math.nan, math.nan
        order = known[numpy.argsort(self.stamp[known], kind="stable")]
        since = (self.stamp[order] - stamp) * 1e-9
        turned = numpy.unwrap(self.heading[order])
        return tuple(numpy.interp(0.0, since, values) for values in (self.x[order], self.y[order], turned))


def heading_of(pose, convention):
    """Counter-clockwise from east, or NaN."""
    if math.isfinite(pose.heading):
        return pose.heading
    q = pose.orientation
    norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
    if not (math.isfinite(norm) and norm > 1e-6):
        return math.nan
    yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z)
    return yaw + math.pi / 2 if convention == "rfu" else yaw


def lateral_distance(message):
    """[m] of the vehicle from the middle of its lane, left positive."""
    for lane in message.hdmap.lane:
        if lane.id != message.current_lane_id:
            continue
        points = points_of(lane.central_curve)
        if len(points) > 1 and numpy.isfinite(points).all():
            return beside_origin(points)[1]
    return math.nan


class Reader:
    def __init__(self, convention):
        self.convention = convention
        self.columns, self.stretches, self.notes, self.origin = [], [], [], None
        self.links = {}  # name: (x, y, yaw) in its parent, parent
        self.kept = None  # place of the last kept lanes, and the lanes
        self.tick_time = math.nan

    def add(self, topic, message, time, map_topic):
        if topic == map_topic:
            self.add_map(message, time)
        elif message._type == "tf2_msgs/TFMessage":
            for transform in message.transforms:
                place, q = transform.transform.translation, transform.transform.rotation
                yaw = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
                self.links[transform.child_frame_id.lstrip("/")] = (
                    (place.x, place.y, yaw), transform.header.frame_id.lstrip("/"))
        elif message._type == "diagnostic_msgs/DiagnosticArray":
            for status in message.status:
                for value in status.values:
                    if value.key == "tick time [ms]":
                        self.tick_time = float(value.value)

    def body_pose(self, message):
        """x, y, heading of the body frame at the map's stamp; NaN where the pose has none."""
        localization, body = message.localization, message.header.frame_id
        if localization.header.stamp.is_zero() and not localization.header.frame_id:
            return math.nan, math.nan, math.nan
        heading = heading_of(localization.pose, self.convention)
        x, y = localization.pose.position.x, localization.pose.position.y
        link = localization.child_frame_id.lstrip("/")
        if link and link != body:
            place, parent = self.links.get(link, ((0.0, 0.0, 0.0), None))
            if parent == body:
                heading -= place[2]
                x -= place[0] * math.cos(heading) - place[1] * math.sin(heading)
                y -= place[0] * math.sin(heading) + place[1] * math.cos(heading)
            else:
                self.note("poses are those of '%s': no transform to '%s' in the bag" % (link, body))
        # A map may be for a later time than the pose that it was made from.
        ahead = (message.header.stamp - localization.header.stamp).to_sec()
        velocity, turn = localization.pose.linear_velocity, localization.pose.angular_velocity_vrf.z
        if 0.0 < ahead < 0.5 and math.isfinite(velocity.x + velocity.y):
            x, y = x + ahead * velocity.x, y + ahead * velocity.y
            heading += ahead * turn if math.isfinite(turn) else 0.0
        return x, y, heading

    def note(self, text):
        if text not in self.notes:
            self.notes.append(text)

    def add_map(self, message, time):
        x, y, heading = self.body_pose(message)
        if math.isfinite(x + y):
            if self.origin is None:
                self.origin = (x, y)
            x, y = x - self.origin[0], y - self.origin[1]
        stamp, fusion = message.header.stamp.to_nsec(), message.fusion
        column = {"time": time.to_nsec(), "stamp": stamp, "code": message.status.code, "source": fusion.source,
                  "lanes": len(message.hdmap.lane), "x": x, "y": y, "heading": heading,
                  "from_middle": lateral_distance(message), "marker_range": fusion.marker_range,
                  "marker_age": fusion.marker_age if fusion.marker_age >= 0.0 else math.nan,
                  "map_age": (time.to_nsec() - stamp) * 1e-9, "tick_time": self.tick_time}
        for name in ESTIMATES:
            sigma = getattr(fusion, name + "_stddev")
            column[name] = getattr(fusion, name) if message.hdmap.lane else math.nan
            column[name + "_stddev"] = sigma if sigma >= 0.0 and message.hdmap.lane else math.nan
        self.columns.append(column)
        self.keep_lanes(message, (x, y, heading))

    def keep_lanes(self, message, pose):
        if not message.hdmap.lane or not math.isfinite(sum(pose)):
            self.finish_stretch(ahead=LANE_STEP)
            return
        moved = math.hypot(pose[0] - self.kept[0][0], pose[1] - self.kept[0][1]) if self.kept else math.inf
        if moved >= LANE_STEP:
            self.finish_stretch(until=pose if moved <= LANE_REACH else None)
            self.kept = pose, message

    def finish_stretch(self, ahead=LANE_REACH, until=None):
        """Lanes up to where the next map's begin, so that each place is drawn once."""
        if self.kept:
            (x, y, heading), message = self.kept
            if until:
                until = carried(numpy.array([[until[0] - x, until[1] - y]]), (0.0, 0.0, -heading))[0]
            self.stretches.append(carry(lanes_of(message, 0.0, ahead, until), (x, y, heading)))
        self.kept = None


def open_bag(path):
    if os.path.exists(path) and not os.path.isdir(path) and not os.path.isfile(path):
        raise Fault("%s: is a pipe or a device, and no file" % path)  # opening one could wait for ever
    try:
        return rosbag.Bag(path)
    except rosbag.ROSBagUnindexedException:
        raise Fault("%s: the recording was cut off and has no index; `rosbag reindex` may save it" % path)
    except OSError as fault:
        raise Fault("%s: %s" % (path, fault.strerror or fault))
    except Exception as fault:  # rosbag lets errors of all kinds out where a file is not what it expects
        raise Fault("%s: not a readable bag: %s" % (path, fault or type(fault).__name__))


def check_topic(bag, path, topic):
    topics = bag.get_type_and_topic_info().topics
    if topic not in topics or not topics[topic].message_count:
        others = [name for name, info in topics.items() if info.msg_type == MapMsg._type and info.message_count]
        hint = "; there are some on %s (--topic)" % ", ".join(others) if others else ""
        raise Fault("%s: there is no map on %s%s" % (path, topic, hint))
    for connection in bag._get_connections(topic):
        if connection.datatype != MapMsg._type:
            raise Fault("%s: %s has type %s, not %s" % (path, topic, connection.datatype, MapMsg._type))
        if connection.md5sum != MapMsg._md5sum:
            raise Fault("%s: the maps on %s have another version's definition" % (path, topic))


def read_drive(bag, path, topic, convention, progress):
    check_topic(bag, path, topic)
    reader = Reader(convention)
    wanted = [topic, "/tf_static", "/diagnostics"]
    total = bag.get_message_count(wanted)
    try:
        for count, (name, message, time) in enumerate(bag.read_messages(wanted)):
            reader.add(name, message, time, topic)
            progress((count + 1) / total)
    except Exception as fault:  # of rosbag, of decompression, of deserialization
        raise Fault("%s: it is damaged after %d maps: %s" % (path, len(reader.columns), fault or type(fault).__name__))
    reader.finish_stretch()
    if not reader.columns:
        raise Fault("%s: there is no map on %s" % (path, topic))
    return Drive(reader.columns, reader.origin or (0.0, 0.0), reader.stretches, reader.notes)


def seen_paint(message, drive):
    """The lane markers that the map was made with, where they were when the map was; none of other frames."""
    seen, body = message.lane_marker, message.header.frame_id
    if message.fusion.marker_age < 0.0 or seen.header.frame_id.lstrip("/") not in ("", body):
        return []
    before, now = (numpy.array(drive.pose_at(stamp.to_nsec())) for stamp in (seen.header.stamp, message.header.stamp))
    x, y, turn = before - now
    c, s = math.cos(now[2]), math.sin(now[2])
    pose = (c * x + s * y, c * y - s * x, turn)
    lines = []
    for marker in (seen.left_lane_marker, seen.right_lane_marker):
        if marker.quality > 0.0 and 0.0 < marker.view_range - marker.longitude_start < 500.0:
            xs = numpy.linspace(marker.longitude_start, marker.view_range, 60)
            ys = numpy.polyval((marker.c3_curvature_derivative, marker.c2_curvature, marker.c1_heading_angle,
                                marker.c0_position), xs)
            lines.append(carried(numpy.column_stack((xs, ys)), pose))
    return [line for line in lines if numpy.isfinite(line).all()]


def single_maps(bag, topic, drive, count):
    """(title, lanes, seen paint) of so many maps, evenly over those that have lanes."""
    full = numpy.flatnonzero(drive.lanes > 0)
    chosen = {int(full[int((k + 0.5) * len(full) / count)]) for k in range(count)} if len(full) else set()
    maps = []
    for index, (_, raw, _) in enumerate(bag.read_messages([topic], raw=True)):
        if index in chosen:
            message = MapMsg().deserialize(raw[1])
            title = "at %.1f s: %d lanes, %s" % (drive.seconds[index], len(message.hdmap.lane),
                                                 SOURCES.get(message.fusion.source, "?"))
            lanes = lanes_of(message)
            if lanes:
                maps.append((title, lanes, seen_paint(message, drive)))
    return maps


def show_progress(share):
    """A line on a terminal, nothing elsewhere."""
    if sys.stderr.isatty():
        sys.stderr.write("\rreading %3d %%%s" % (100 * share, "\n" if share >= 1.0 else ""))
