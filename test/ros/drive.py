"""Inputs for a running relative_map: three lanes on a straight road far from the map's origin, and a car on it."""

import math
import threading

import rospy
from relative_map.msg import Chassis, LocalizationEstimate, NavigationInfo, NavigationPath, PathPoint

ORIGIN = (586000.0, 4140000.0)  # of the order of UTM coordinates
HEADING = 0.6  # of the road
LENGTH = 600.0
SPACING = 3.5  # of the lanes
IMU_X = 0.40  # of imu_link in base_link, see urdf/sample_car.urdf
NAN = float('nan')


def at(s, l):
    """The point of the map frame at s along the middle lane and l to its left."""
    return (ORIGIN[0] + s * math.cos(HEADING) - l * math.sin(HEADING),
            ORIGIN[1] + s * math.sin(HEADING) + l * math.cos(HEADING))


def navigation_path(name, l, priority):
    path = NavigationPath(path_priority=priority)
    path.path.name = name
    for i in range(int(LENGTH) + 1):
        x, y = at(i, l)
        path.path.path_point.append(
            PathPoint(x=x, y=y, z=NAN, theta=NAN, kappa=NAN, dkappa=NAN, ddkappa=NAN, s=NAN))
    return path


def navigation(frame='map'):
    message = NavigationInfo()
    message.header.stamp = rospy.Time.now()
    message.header.frame_id = frame
    message.navigation_path = [navigation_path('middle', 0.0, 0), navigation_path('right', -SPACING, 1),
                               navigation_path('left', SPACING, 2)]
    return message


class Drive:
    """Publishes localization and chassis from a thread of its own, while `running`."""

    speed = 10.0

    def __init__(self, rate=40.0):
        self.navigation = rospy.Publisher('navigation', NavigationInfo, queue_size=1, latch=True)
        self.localization = rospy.Publisher('localization', LocalizationEstimate, queue_size=10)
        self.chassis = rospy.Publisher('chassis', Chassis, queue_size=10)
        self.set()
        self.running = False
        self._rate = rate
        self._thread = threading.Thread(target=self._publish, daemon=True)
        self._thread.start()

    def set(self, s=50.0, l=0.2, heading=HEADING, link='base_link', frame='map', position=None):
        """The car stands (while it says that it drives) at one place, so that maps can be compared with it."""
        self.position = position or at(s, l)
        self.heading, self.link, self.frame = heading, link, frame

    def estimate(self):
        message = LocalizationEstimate()
        message.header.stamp = message.measurement_time = rospy.Time.now()
        message.header.frame_id = self.frame
        message.child_frame_id = self.link
        message.pose.position.x, message.pose.position.y = self.position
        message.pose.orientation.z = math.sin(self.heading / 2)
        message.pose.orientation.w = math.cos(self.heading / 2)
        message.pose.heading = self.heading
        message.pose.linear_velocity.x = self.speed * math.cos(self.heading)
        message.pose.linear_velocity.y = self.speed * math.sin(self.heading)
        return message

    def _publish(self):
        rate = rospy.Rate(self._rate)
        while not rospy.is_shutdown():
            if self.running:
                self.localization.publish(self.estimate())
                chassis = Chassis(speed_mps=self.speed, gear_location=Chassis.GEAR_DRIVE)
                chassis.header.stamp = rospy.Time.now()
                self.chassis.publish(chassis)
            rate.sleep()
