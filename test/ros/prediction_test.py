#!/usr/bin/env python3
"""A running prediction, node or nodelet: topics in, predictions, markers and diagnostics out."""

import signal
import subprocess
import threading
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from relative_map.msg import PerceptionObstacle, PerceptionObstacles, LocalizationEstimate
from relative_map.msg import PredictionObstacles, PredictionStatus
from visualization_msgs.msg import MarkerArray

import vehicle_messages
from node_support import program, wait_for


def command(kind, *arguments):
    if kind == 'node':
        return [program('relative_map', 'prediction_node'), '__name:=road_users'] + list(arguments)
    return [program('nodelet', 'nodelet'), 'standalone', 'relative_map/PredictionNodelet', '__name:=road_users'
            ] + list(arguments)


class Prediction(unittest.TestCase):
    def setUp(self):
        self.kind = rospy.get_param('~kind')
        self.predictions = []
        self.markers = []
        self.diagnostics = []
        rospy.Subscriber('prediction', PredictionObstacles, self.predictions.append)
        rospy.Subscriber('road_users/markers', MarkerArray, self.markers.append)
        rospy.Subscriber('/diagnostics', DiagnosticArray, self.diagnostics.append)
        self.localization = rospy.Publisher('localization', LocalizationEstimate, queue_size=10)
        self.obstacles = rospy.Publisher('perception/obstacles', PerceptionObstacles, queue_size=10)
        self.process = subprocess.Popen(command(self.kind), stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def tearDown(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.assertEqual(self.process.wait(20), 0)

    def drive(self, stop):
        """At 10 m/s along x, behind one that drives at 12 m/s."""
        start = rospy.Time.now()
        while not stop.is_set():
            now = rospy.Time.now()
            t = (now - start).to_sec()
            x = 20.0 + vehicle_messages.SPEED * t
            self.localization.publish(vehicle_messages.localization(now, x=x))
            message = PerceptionObstacles()
            message.header.stamp = now
            message.header.frame_id = 'base_link'
            other = PerceptionObstacle(id=7, type=PerceptionObstacle.VEHICLE, length=4.5, width=1.8)
            other.position.x = 50.0 + 12.0 * t - x
            message.perception_obstacle = [other]
            self.obstacles.publish(message)
            stop.wait(0.1)

    def test_what_is_seen_is_predicted(self):
        wait_for(lambda: self.predictions, 'prediction')
        self.assertEqual(self.predictions[-1].status.code, PredictionStatus.NO_LOCALIZATION)
        stop = threading.Event()
        driver = threading.Thread(target=self.drive, args=(stop,))
        driver.start()
        try:
            def good():
                last = self.predictions[-1]
                return last.prediction_obstacle and abs(
                    last.prediction_obstacle[0].perception_obstacle.velocity.x - 12.0) < 0.5 and last

            message = wait_for(good, 'vehicle at 12 m/s')
            wait_for(lambda: self.markers and self.markers[-1].markers, 'markers')
            wait_for(lambda: any('no map of late' in status.message for array in self.diagnostics
                                 for status in array.status), 'diagnostic that names the map')
        finally:
            stop.set()
            driver.join()
        self.assertEqual(message.status.code, PredictionStatus.NO_MAP)
        self.assertEqual(message.header.frame_id, 'base_link')
        other = message.prediction_obstacle[0]
        self.assertEqual(other.perception_obstacle.id, 7)
        self.assertAlmostEqual(sum(mode.probability for mode in other.trajectory), 1.0, places=6)
        points = other.trajectory[0].trajectory_point
        self.assertEqual(len(points), 81)
        self.assertAlmostEqual(points[-1].relative_time, 8.0, places=9)
        travelled = points[-1].path_point.x - points[0].path_point.x
        self.assertAlmostEqual(travelled, 96.0, delta=10.0)
        wait_for(lambda: self.predictions[-1].status.code == PredictionStatus.STALE_LOCALIZATION or
                 self.predictions[-1].status.code == PredictionStatus.STALE_OBSTACLES, 'complaint of old inputs')

    def test_bad_parameters_are_refused_by_name(self):
        refused = subprocess.run(command(self.kind, '__name:=refused', '_prediction/lane/preview_time:=-1.0', '_wrong:=1'),
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=30, check=False)
        text = refused.stdout.decode()
        self.assertIn('prediction/lane/preview_time is -1', text)
        self.assertIn('wrong is not a parameter', text)
        if self.kind == 'node':
            self.assertNotEqual(refused.returncode, 0)


if __name__ == '__main__':
    rospy.init_node('prediction_test')
    rostest.rosrun('relative_map', 'prediction', Prediction)
