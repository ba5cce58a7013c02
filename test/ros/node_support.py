"""What the tests of a running node or nodelet share: the node or nodelet under test, a vehicle that feeds it, and what it publishes."""

import os
import signal
import subprocess
import tempfile
import threading
import time
import unittest

import roslib.packages
import rosbag
import rosparam
import rospy
from relative_map.msg import Chassis, LaneMarkers, LocalizationEstimate, MapMsg, NavigationInfo

import vehicle_messages
from map_head import MapHead

DEADLINE = 20.0  # [s] far more than anything here takes: only a failing test waits for it


def wait_for(condition, what, deadline=DEADLINE):
    """The first true value of `condition()`; a failure that names `what` after the deadline."""
    end = time.monotonic() + deadline
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError('no %s within %.0f s' % (what, deadline))
        time.sleep(0.01)


def program(package, name):
    return roslib.packages.find_node(package, name)[0]


class MapProcess:
    """A stand-alone node, or a manager with the nodelet loaded into it."""

    def __init__(self, as_nodelet, parameters, arguments):
        if parameters:
            rosparam.upload_params('/relative_map', parameters)
        self.output = tempfile.NamedTemporaryFile()
        self.arguments = ['__name:=relative_map'] + arguments
        self.processes = []
        self.codes = None  # once it was stopped
        if as_nodelet:
            self._start([program('nodelet', 'nodelet'), 'manager', '__name:=relative_map_manager'])
            self.load()
        else:
            self._start([program('relative_map', 'relative_map_node')] + self.arguments)

    def _start(self, command):
        self.processes.append(subprocess.Popen(command, stdout=self.output, stderr=subprocess.STDOUT))

    def load(self):
        """Loads the nodelet into the manager, in place of one that has ended."""
        del self.processes[1:]
        self._start([program('nodelet', 'nodelet'), 'load', 'relative_map/RelativeMapNodelet', '/relative_map_manager'] +
                    self.arguments)

    def unload(self):
        """Unloads it from its manager, as roslaunch does; the exit code."""
        self.processes[1].send_signal(signal.SIGINT)
        return self.processes[1].wait(DEADLINE)

    def manager_is_alive(self):
        return self.processes[0].poll() is None

    def alive(self):
        return all(process.poll() is None for process in self.processes)

    def exit_code(self):
        """That of the node, or of `nodelet load`; None while it runs."""
        return self.processes[-1].poll()

    def text(self):
        with open(self.output.name) as output:
            return output.read()

    def stop(self):
        """Interrupts it, as roslaunch does; the exit codes, or what else was wrong."""
        if self.codes is None:
            self.codes = [] if self.alive() else ['it ended by itself']
            for process in reversed(self.processes):
                process.send_signal(signal.SIGINT)
                try:
                    self.codes.append(process.wait(DEADLINE))
                except subprocess.TimeoutExpired:
                    process.kill()
                    self.codes.append('it did not end when interrupted')
        return self.codes


class MapLog:
    """Every map that was published since it was made."""

    def __init__(self, topic='relative_map'):
        self.data = []
        self.connections = []  # the header of each map's connection
        self.subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._receive, tcp_nodelay=True)

    def _receive(self, message):
        self.connections.append(message._connection_header)
        self.data.append(message._buff)

    def heads(self, first=0):
        return [MapHead(data) for data in self.data[first:]]

    def message(self, index):
        return MapMsg().deserialize(self.data[index])

    def next_where(self, condition, what):
        """The first map from now on whose head fulfils the condition, as a whole message."""
        index = len(self.data)

        def found():
            nonlocal index
            while index < len(self.data):
                if condition(MapHead(self.data[index])):
                    return True
                index += 1
            return False

        try:
            wait_for(found, 'map with ' + what)
        except AssertionError as failure:
            last = MapHead(self.data[-1]) if self.data else None
            raise AssertionError('%s; the last one: %s' % (failure, last and (last.code, last.text))) from None
        return self.message(index)

    def next_with(self, code):
        return self.next_where(lambda head: head.code == code, 'status %d' % code)

    def newest_where(self, condition, what):
        """As soon as the newest map from now on, read as a whole, fulfils the condition: that one."""
        first = len(self.data)

        def found():
            if len(self.data) == first:
                return None
            map = self.message(-1)
            return map if condition(map) else None

        return wait_for(found, 'map with ' + what)

    def write_bag(self, path):
        with rosbag.Bag(path, 'w') as bag:
            for head, data in zip(self.heads(), self.data):
                bag.write('/relative_map', (MapMsg._type, data, MapMsg._md5sum, MapMsg), head.stamp, raw=True)


class Latest:
    """The newest message of a topic."""

    def __init__(self, topic, message_type):
        self.message = None
        self.subscriber = rospy.Subscriber(topic, message_type, self._receive)

    def _receive(self, message):
        self.message = message


class Vehicle:
    """Publishes what a car senses; what it leaves out or alters is up to its fields."""

    def __init__(self, rate, names):
        self.rate = rate
        self.sends_localization = self.sends_chassis = self.sends_markers = True
        self.alter = lambda localization: localization
        self.alter_chassis = lambda chassis: chassis
        self.alter_markers = lambda markers: markers
        self.marker_offset = 0.0  # [m] of the lane's middle from the car, left positive
        self.stamps = []  # of all localizations that were sent
        self.navigation = rospy.Publisher(names('navigation'), NavigationInfo, queue_size=1, latch=True)
        self._localization = rospy.Publisher(names('localization'), LocalizationEstimate, queue_size=100,
                                             tcp_nodelay=True)
        self._chassis = rospy.Publisher(names('chassis'), Chassis, queue_size=10)
        self._markers = rospy.Publisher(names('perception/lane_markers'), LaneMarkers, queue_size=10)
        self._thread = threading.Thread(target=self._drive, daemon=True)
        self._stopped = threading.Event()
        self._x = 20.0

    def start(self):
        self._thread.start()

    def stop(self):
        self._stopped.set()
        if self._thread.is_alive():
            self._thread.join()
        for publisher in (self.navigation, self._localization, self._chassis, self._markers):
            publisher.unregister()

    def connected(self):
        return all(publisher.get_num_connections() > 0
                   for publisher in (self.navigation, self._localization, self._chassis, self._markers))

    def sense(self, stamp, with_markers=True):
        if self.sends_localization:
            self.stamps.append(stamp)
            self._localization.publish(self.alter(vehicle_messages.localization(stamp, self._x)))
        if self.sends_chassis:
            self._chassis.publish(self.alter_chassis(vehicle_messages.chassis(stamp)))
        if self.sends_markers and with_markers:
            self._markers.publish(self.alter_markers(vehicle_messages.lane_markers(stamp, self.marker_offset)))

    def _drive(self):
        start, count = time.monotonic(), 0
        while not self._stopped.is_set():
            self.sense(rospy.Time.now(), with_markers=count % 5 == 0)
            self._x += vehicle_messages.SPEED / self.rate
            count += 1
            self._stopped.wait(max(0.0, start + count / self.rate - time.monotonic()))


class NodeTest(unittest.TestCase):
    """A test of a node or a nodelet (parameter ~kind of the test) that it starts for itself."""

    def start(self, parameters=None, arguments=(), vehicle_rate=100.0, names=lambda name: name):
        """Starts the process under test, a log of its maps, and a vehicle that stands still for now."""
        self.maps = MapLog(names('relative_map'))
        self.addCleanup(self.maps.subscriber.unregister)
        self.vehicle = Vehicle(vehicle_rate, names)
        self.addCleanup(self.vehicle.stop)
        self.addCleanup(self._forget_parameters)
        self.start_process(parameters, arguments)

    def start_process(self, parameters=None, arguments=()):
        self.process = MapProcess(rospy.get_param('~kind') == 'nodelet', parameters, list(arguments))
        self.addCleanup(self._expect_a_clean_end, self.process)
        wait_for(lambda: self.vehicle.connected() or not self.process.alive(), 'subscriber of all inputs')
        self.assertTrue(self.process.alive(), self.process.text())

    def drive(self, **kwargs):
        """Starts, drives on three lines, and waits for the first map of them."""
        self.start(**kwargs)
        self.vehicle.navigation.publish(vehicle_messages.three_lines())
        self.vehicle.start()
        return self.three_lanes()

    def three_lanes(self):
        return self.maps.newest_where(lambda map: len(map.hdmap.lane) == 3, 'three lanes')

    def expect_contract(self):
        """All maps that were received keep the output contract, their order included."""
        with tempfile.TemporaryDirectory() as folder:
            bag = os.path.join(folder, 'maps.bag')
            self.maps.write_bag(bag)
            check = subprocess.run([program('relative_map', 'check_maps'), bag], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, universal_newlines=True)
            self.assertEqual(check.returncode, 0, check.stdout)

    def _expect_a_clean_end(self, process):
        codes = process.stop()
        self.assertEqual(codes, [0] * len(codes), process.text())

    def _forget_parameters(self):
        for name in ('/relative_map', '/use_sim_time'):
            if rospy.has_param(name):
                rospy.delete_param(name)
