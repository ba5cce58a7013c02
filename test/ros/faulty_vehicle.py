"""A vehicle that goes round a circle, whose messages can be spoiled on their way out."""

import math
import threading

import rospy
from relative_map.msg import Chassis, LaneMarkers, LocalizationEstimate, NavigationInfo, NavigationPath, PathPoint

CENTER = (448000.0, 4425000.0)  # of the circle, of the order of UTM coordinates
RADIUS = 100.0
SPEED = 10.0
YAW_RATE = SPEED / RADIUS
IMU_X = 0.40  # of imu_link in base_link, see urdf/sample_car.urdf
NAN = float('nan')


def set_yaw(orientation, yaw):
    orientation.z, orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)


def on_circle(angle):
    return CENTER[0] + RADIUS * math.cos(angle), CENTER[1] + RADIUS * math.sin(angle)


def navigation():
    """The circle, counter-clockwise, as one line with a point a metre or so."""
    line = NavigationPath()
    line.path.name = 'circle'
    count = int(2.0 * math.pi * RADIUS)
    for i in range(count):
        x, y = on_circle(2.0 * math.pi * i / count)
        line.path.path_point.append(PathPoint(x=x, y=y, z=NAN, theta=NAN, kappa=NAN, dkappa=NAN, ddkappa=NAN, s=NAN))
    message = NavigationInfo(navigation_path=[line])
    message.header.frame_id = 'map'
    return message


def localization(seconds):
    """Of imu_link; the vehicle begins in the south and goes on east."""
    heading = math.remainder(YAW_RATE * seconds, 2.0 * math.pi)
    x, y = on_circle(heading - math.pi / 2.0)
    message = LocalizationEstimate(child_frame_id='imu_link')
    message.header.frame_id = 'map'
    message.pose.position.x = x + IMU_X * math.cos(heading)
    message.pose.position.y = y + IMU_X * math.sin(heading)
    message.pose.heading = heading
    set_yaw(message.pose.orientation, heading)
    aside = YAW_RATE * IMU_X  # velocity of imu_link to the left
    message.pose.linear_velocity.x = SPEED * math.cos(heading) - aside * math.sin(heading)
    message.pose.linear_velocity.y = SPEED * math.sin(heading) + aside * math.cos(heading)
    message.pose.angular_velocity_vrf.z = YAW_RATE
    return message


def chassis(_seconds):
    return Chassis(speed_mps=SPEED, gear_location=Chassis.GEAR_DRIVE)


def lane_markers(_seconds):
    message = LaneMarkers()
    message.header.frame_id = 'camera_link'
    for marker, c0 in ((message.left_lane_marker, 1.75), (message.right_lane_marker, -1.75)):
        marker.quality, marker.view_range, marker.model_degree = 0.9, 40.0, 3
        marker.c0_position, marker.c2_curvature = c0, 0.5 / RADIUS
    return message


class Sensor:
    """Publishes what `make` makes for the time of driving, spoiled by `spoil`, at `rate` [Hz]."""

    def __init__(self, topic, message_type, make, rate):
        self.topic, self.message_type, self.rate = topic, message_type, rate
        self.spoil = None
        self._make, self._publisher, self._next = make, None, 0.0
        self.start()

    def start(self):
        self._publisher = rospy.Publisher(self.topic, self.message_type, queue_size=10)

    def stop(self):
        publisher, self._publisher = self._publisher, None
        publisher.unregister()

    def tick(self, now, seconds):
        publisher = self._publisher
        if publisher is None or now.to_sec() < self._next:
            return
        self._next = max(self._next + 1.0 / self.rate, now.to_sec() - 0.1)
        message = self._make(seconds)
        message.header.stamp = now
        if self.spoil:
            self.spoil(message)
        publisher.publish(message)


class Vehicle:
    """Drives from its creation on."""

    def __init__(self):
        self.localization = Sensor('localization', LocalizationEstimate, localization, 40.0)
        self.chassis = Sensor('chassis', Chassis, chassis, 40.0)
        self.lane_markers = Sensor('perception/lane_markers', LaneMarkers, lane_markers, 15.0)
        self._sensors = (self.localization, self.chassis, self.lane_markers)
        self.navigation = rospy.Publisher('navigation', NavigationInfo, queue_size=1, latch=True)
        self.navigation.publish(navigation())
        threading.Thread(target=self._drive, daemon=True).start()

    def _drive(self):
        start = rospy.Time.now()
        rate = rospy.Rate(100.0)
        while not rospy.is_shutdown():
            now = rospy.Time.now()
            for sensor in self._sensors:
                sensor.tick(now, (now - start).to_sec())
            rate.sleep()
