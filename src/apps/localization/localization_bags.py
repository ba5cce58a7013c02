"""Recorded drives (see the README of the reference data's folder `localization`) as bags of ROS messages, for
`localize`; and a plane on the earth to compare in. Used by localization_benchmark."""

import lzma
import math
import os

import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import TransformStamped, TwistStamped
from sensor_msgs.msg import Imu, NavSatFix
from tf2_msgs.msg import TFMessage


def columns(path):
    """A CSV file with a header line as a dictionary of arrays."""
    with lzma.open(path, "rt") as text:
        names = text.readline().strip().split(",")
        table = np.array([[float(cell or "nan") for cell in line.split(",")] for line in text])
    return dict(zip(names, table.T))


class Plane:
    """East, north, up about an origin on the WGS 84 ellipsoid."""

    A, F = 6378137.0, 1.0 / 298.257223563

    def __init__(self, latitude, longitude, altitude):
        self.latitude, self.longitude, self.altitude = latitude, longitude, altitude
        sl, cl = math.sin(math.radians(latitude)), math.cos(math.radians(latitude))
        so, co = math.sin(math.radians(longitude)), math.cos(math.radians(longitude))
        self.turn = np.array([[-so, co, 0.0], [-sl * co, -sl * so, cl], [cl * co, cl * so, sl]])
        self.origin = self.ecef(latitude, longitude, altitude)

    @classmethod
    def ecef(cls, latitude, longitude, altitude):
        lat, lon = np.radians(latitude), np.radians(longitude)
        e2 = cls.F * (2.0 - cls.F)
        n = cls.A / np.sqrt(1.0 - e2 * np.sin(lat) ** 2)
        return np.stack([(n + altitude) * np.cos(lat) * np.cos(lon), (n + altitude) * np.cos(lat) * np.sin(lon),
                         (n * (1.0 - e2) + altitude) * np.sin(lat)], axis=-1)

    def from_ecef(self, points):
        return (points - self.origin) @ self.turn.T

    def __call__(self, latitude, longitude, altitude):
        return self.from_ecef(self.ecef(latitude, longitude, altitude))

    def text(self):
        return "%.9f, %.9f, %.4f" % (self.latitude, self.longitude, self.altitude)


def quaternion(matrix):
    """x, y, z, w of a rotation."""
    w = math.sqrt(max(0.0, 1.0 + matrix[0, 0] + matrix[1, 1] + matrix[2, 2])) / 2.0
    if w > 0.1:
        return ((matrix[2, 1] - matrix[1, 2]) / (4 * w), (matrix[0, 2] - matrix[2, 0]) / (4 * w),
                (matrix[1, 0] - matrix[0, 1]) / (4 * w), w)
    vectors, values = np.linalg.eigh(matrix + matrix.T)[::-1]
    axis = vectors[:, np.argmax(values)]
    return (*axis, w)


def time(t):
    return rospy.Time.from_sec(1000.0 + t)


class Drive:
    """Messages in the order of their stamps, each serialized once however many bags it goes to."""

    def __init__(self):
        self.messages = []

    def add(self, topic, t, message):
        if hasattr(message, "header"):
            message.header.stamp = time(t)
        self.messages.append((t, topic, message))

    def imu(self, t, rate, force, topic="/imu", frame="imu_link"):
        message = Imu()
        message.header.frame_id = frame
        message.angular_velocity.x, message.angular_velocity.y, message.angular_velocity.z = rate
        message.linear_acceleration.x, message.linear_acceleration.y, message.linear_acceleration.z = force
        message.orientation_covariance[0] = -1.0
        self.add(topic, t, message)

    def fix(self, t, latitude, longitude, altitude, stddev, status):
        message = NavSatFix()
        message.header.frame_id = "gps"
        message.latitude, message.longitude, message.altitude = latitude, longitude, altitude
        message.status.status, message.status.service = status, 1
        if stddev is not None:
            message.position_covariance[0], message.position_covariance[4] = stddev[0] ** 2, stddev[1] ** 2
            message.position_covariance[8] = stddev[2] ** 2
            message.position_covariance_type = NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN
        self.add("/fix", t, message)

    def twist(self, topic, t, linear, yaw_rate=0.0):
        message = TwistStamped()
        message.twist.linear.x, message.twist.linear.y, message.twist.linear.z = linear
        message.twist.angular.z = yaw_rate
        self.add(topic, t, message)

    def link(self, child, translation, rotation):
        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = "base_link", child
        transform.header.stamp = time(-1.0)
        move = transform.transform
        move.translation.x, move.translation.y, move.translation.z = translation
        move.rotation.x, move.rotation.y, move.rotation.z, move.rotation.w = quaternion(rotation)
        self.messages.append((-1.0, "/tf_static", TFMessage([transform])))

    def write(self, path, keep=lambda topic, t: True):
        with rosbag.Bag(path, "w") as bag:
            for t, topic, message in sorted(self.messages, key=lambda entry: entry[0]):
                if keep(topic, t):
                    bag.write(topic, message, time(t))


def mount(forward, up):
    """base_from_imu: the rotation that takes these directions of the sensor to x and z."""
    x = np.array(forward) / np.linalg.norm(forward)
    y = np.cross(up, x)
    y /= np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)])


def drive_0708(folder, end=300.0, every=4, noise=0.0, imu_offset=-0.125, imu_place=(0.0, 0.0, 1.4),
               velocity=True):
    """The drive, the plane, and the fixes that were not given away: t, position (n, 3), velocity (n, 3)."""
    imu = columns(os.path.join(folder, "drive_0708/imu.csv.xz"))
    gnss = columns(os.path.join(folder, "drive_0708/gnss.csv.xz"))
    plane = Plane(gnss["lat"][0], gnss["lon"][0], gnss["h"][0])
    drive = Drive()
    turn = mount((-0.988, -0.103, 0.118), (0.0, 0.0, 1.0))
    drive.link("imu_link", imu_place, turn)
    drive.link("gps", (imu_place[0], imu_place[1] + 0.05, imu_place[2]), np.eye(3))
    for i in range(len(imu["t"])):
        t = imu["t"][i] + imu_offset
        if 0.0 <= t <= end:
            drive.imu(t, (imu["gx"][i], imu["gy"][i], imu["gz"][i]), (imu["ax"][i], imu["ay"][i], imu["az"][i]))
    random = np.random.default_rng(1)
    places = plane(gnss["lat"], gnss["lon"], gnss["h"])
    truth = []
    for i, t in enumerate(gnss["t"]):
        if t > end:
            break
        if i % every == 0:
            shift = random.normal(0.0, noise, 3) if noise > 0.0 else np.zeros(3)
            stddev = [math.hypot(gnss[n][i], noise) for n in ("sde", "sdn", "sdu")]
            drive.fix(t, gnss["lat"][i] + math.degrees(shift[1] / 6.37e6),
                      gnss["lon"][i] + math.degrees(shift[0] / 6.38e6 / math.cos(math.radians(gnss["lat"][i]))),
                      gnss["h"][i] + shift[2], stddev, 2 if gnss["q"][i] == 1 and noise < 0.1 else 0)
            if velocity:
                drive.twist("/fix_velocity", t, (gnss["ve"][i], gnss["vn"][i], gnss["vu"][i]))
        if i % every != 0 or noise > 0.0:
            if gnss["q"][i] == 1:
                truth.append((t, *places[i], gnss["ve"][i], gnss["vn"][i], gnss["vu"][i]))
    return drive, plane, np.array(truth), np.array([imu_place[0], imu_place[1] + 0.05, imu_place[2]])


def comma2k19(folder, imu=True, wheels=True, covariance=True):
    """The drive, the plane, and the truth: t, position (n, 3), velocity (n, 3); the receiver's own fixes."""
    at = lambda name: columns(os.path.join(folder, "comma2k19_seg40", name + ".csv.xz"))
    gnss, truth = at("gnss"), at("truth")
    plane = Plane(gnss["lat"][0], gnss["lon"][0], gnss["alt"][0])
    drive = Drive()
    drive.link("imu_link", (1.5, 0.0, 1.0), np.diag([1.0, -1.0, -1.0]))
    drive.link("gps", (1.5, 0.0, 1.0), np.eye(3))
    if imu:
        accel, gyro = at("accel"), at("gyro")
        rates = np.stack([np.interp(accel["t"], gyro["t"], gyro[n]) for n in ("gx", "gy", "gz")], axis=1)
        for t, rate, x, y, z in zip(accel["t"], rates, accel["fx"], accel["fy"], accel["fz"]):
            drive.imu(t, rate, (x, y, z))
    if wheels:
        wheel = at("wheel")
        for t, left, right in zip(wheel["t"], wheel["rl"], wheel["rr"]):
            drive.twist("/wheel_odometry", t, (0.5 * (left + right), 0.0, 0.0), (right - left) / 1.57)
    for t, lat, lon, alt in zip(gnss["t"], gnss["lat"], gnss["lon"], gnss["alt"]):
        drive.fix(t, lat, lon, alt, (2.0, 2.0, 4.0) if covariance else None, 0)
    places = plane.from_ecef(np.stack([truth[n] for n in ("ex", "ey", "ez")], axis=1))
    speeds = np.stack([truth[n] for n in ("vx", "vy", "vz")], axis=1) @ plane.turn.T
    fixes = np.concatenate([gnss["t"][:, None], plane(gnss["lat"], gnss["lon"], gnss["alt"])], axis=1)
    return drive, plane, np.concatenate([truth["t"][:, None], places, speeds], axis=1), fixes
