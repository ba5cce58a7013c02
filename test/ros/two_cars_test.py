#!/usr/bin/env python3
"""Cars in namespaces of their own: each gets the map of its inputs, in its frame, and of nobody else's."""

import threading
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from relative_map.msg import LocalizationEstimate, MapMsg, NavigationInfo
from tf2_msgs.msg import TFMessage

import vehicle_messages
from node_support import wait_for


class Car:
    """Drives beside the middle of so many lines, and is localized by a link of its own."""

    def __init__(self, name, lines, y, link):
        self.lines, self.y, self.link = lines, y, link
        self.map = None
        self.frames = set()
        self.navigation = rospy.Publisher('/%s/navigation' % name, NavigationInfo, queue_size=1, latch=True)
        self.localization = rospy.Publisher('/%s/localization' % name, LocalizationEstimate, queue_size=10)
        self.subscriber = rospy.Subscriber('/%s/relative_map' % name, MapMsg, self._receive, queue_size=1)
        self.navigation.publish(vehicle_messages.navigation(*[
            vehicle_messages.navigation_path('line_%d' % i, i, vehicle_messages.straight(400, 3.5 * i))
            for i in range(lines)]))

    def _receive(self, message):
        self.map = message
        self.frames.add(message.header.frame_id)

    def sense(self):
        self.localization.publish(
            vehicle_messages.localization(rospy.Time.now(), x=50.0, y=self.y, child_frame=self.link))

    def has_its_map(self):
        return self.map and len(self.map.hdmap.lane) == self.lines

    def y_of_lane(self):
        return next(path for path in self.map.navigation_path
                    if path.lane_id == self.map.current_lane_id).navigation_path.path.path_point[-1].y


class TwoCars(unittest.TestCase):
    def test_each_has_its_own_map(self):
        tf_of_car3 = rospy.Publisher('/car3/tf_static', TFMessage, queue_size=1, latch=True)
        # On the common topic there is a link of that name, too, and elsewhere: another car's.
        common_tf = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        tf_of_car3.publish(TFMessage([vehicle_messages.static_transform('gps_link', x=0.0, z=1.0)]))
        common_tf.publish(TFMessage([vehicle_messages.static_transform('gps_link', x=0.0, z=1.0, parent='nowhere')]))
        cars = {'car1': Car('car1', 1, 0.5, 'car1/imu_link'), 'car2': Car('car2', 2, -0.25, 'car2/base_link'),
                'car3': Car('car3', 3, 3.5, 'gps_link')}
        names = set()
        diagnostics = rospy.Subscriber('/diagnostics', DiagnosticArray,
                                       lambda array: names.update(status.name for status in array.status))
        ended = threading.Event()

        def drive():
            while not ended.wait(0.05):
                for car in cars.values():
                    car.sense()

        thread = threading.Thread(target=drive)
        thread.start()
        try:
            for name, car in cars.items():
                wait_for(car.has_its_map, 'map of %s (%s)' % (name, car.map and car.map.status))
            wait_for(lambda: sum(name.endswith('relative map') for name in names) == 3, 'diagnostics of all: %s' % names)
        finally:
            ended.set()
            thread.join()
            diagnostics.unregister()
        self.assertEqual({name: car.frames for name, car in cars.items()},
                         {'car1': {'car1/base_link'}, 'car2': {'car2/base_link'}, 'car3': {'base_link'}})
        self.assertAlmostEqual(cars['car1'].y_of_lane(), -0.5, 3)
        self.assertAlmostEqual(cars['car2'].y_of_lane(), 0.25, 3)
        self.assertAlmostEqual(cars['car3'].y_of_lane(), 0.0, 3)
        self.assertEqual({name.split(':')[0].strip('/') for name in names if name.endswith('relative map')},
                         {'car1/relative_map', 'car2/relative_map', 'car3/mapper'})


if __name__ == '__main__':
    rospy.init_node('two_cars_test')
    rostest.rosrun('relative_map', 'two_cars', TwoCars)
