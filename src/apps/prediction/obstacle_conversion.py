"""What others publish of road users, as PerceptionObstacles. Messages are read by their fields' names, so this needs none
of their packages; positions stay in the frame of the message, velocities are over ground along that frame's axes."""
import math

from relative_map.msg import PerceptionObstacle, PerceptionObstacles

NEAREST = 3.0  # [m] that a road user moves at most between two frames without ids, and
FORGET = 1.0  # [s] until one that is not seen any more is forgotten

# derived_object_msgs/Object's classifications.
DERIVED = {4: PerceptionObstacle.PEDESTRIAN, 5: PerceptionObstacle.BICYCLE, 6: PerceptionObstacle.VEHICLE,
           7: PerceptionObstacle.VEHICLE, 8: PerceptionObstacle.VEHICLE, 9: PerceptionObstacle.VEHICLE,
           10: PerceptionObstacle.UNKNOWN_UNMOVABLE, 11: PerceptionObstacle.UNKNOWN_UNMOVABLE}
# Labels of detectors, as they are commonly written.
LABELS = {'car': PerceptionObstacle.VEHICLE, 'truck': PerceptionObstacle.VEHICLE, 'bus': PerceptionObstacle.VEHICLE,
          'van': PerceptionObstacle.VEHICLE, 'vehicle': PerceptionObstacle.VEHICLE,
          'motorbike': PerceptionObstacle.VEHICLE, 'motorcycle': PerceptionObstacle.VEHICLE,
          'bicycle': PerceptionObstacle.BICYCLE, 'bike': PerceptionObstacle.BICYCLE, 'cyclist': PerceptionObstacle.BICYCLE,
          'person': PerceptionObstacle.PEDESTRIAN, 'pedestrian': PerceptionObstacle.PEDESTRIAN}


def yaw_of(q):
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))


def type_of(label):
    return LABELS.get(str(label).strip().lower(), PerceptionObstacle.UNKNOWN)


class NearestNeighbour:
    """Ids for places that have none: each is the nearest one of the frame before, carried on at its velocity."""

    def __init__(self):
        self.tracks = {}  # id: (time, x, y, vx, vy)
        self.next_id = 1

    def identify(self, time, places):
        """An id for each (x, y)."""
        if any(time < track[0] for track in self.tracks.values()):
            self.tracks = {}
        self.tracks = {i: track for i, track in self.tracks.items() if time - track[0] <= FORGET}
        pairs = []
        for k, (x, y) in enumerate(places):
            for i, (t, tx, ty, vx, vy) in self.tracks.items():
                distance = math.hypot(x - tx - vx * (time - t), y - ty - vy * (time - t))
                if distance <= NEAREST:
                    pairs.append((distance, k, i))
        ids, taken = {}, set()
        for _, k, i in sorted(pairs):
            if k not in ids and i not in taken:
                ids[k] = i
                taken.add(i)
        for k, (x, y) in enumerate(places):
            if k not in ids:
                ids[k] = self.next_id
                self.next_id += 1
                self.tracks[ids[k]] = (time, x, y, 0.0, 0.0)
                continue
            t, tx, ty, vx, vy = self.tracks[ids[k]]
            dt = time - t
            if dt > 0.0:  # noise halved: a rough velocity will do for the next search
                vx, vy = 0.5 * (vx + (x - tx) / dt), 0.5 * (vy + (y - ty) / dt)
            self.tracks[ids[k]] = (time, x, y, vx, vy)
        return [ids[k] for k in range(len(places))]


def obstacle(pose, kind, size=(0.0, 0.0, 0.0), number=0, confidence=0.0):
    result = PerceptionObstacle(id=number, type=kind, theta=yaw_of(pose.orientation), confidence=confidence)
    result.position.x, result.position.y, result.position.z = pose.position.x, pose.position.y, pose.position.z
    result.length, result.width, result.height = size
    return result


class Converter:
    """One for a stream of messages; the types are those of KINDS."""

    KINDS = ('vision_msgs/Detection3DArray', 'derived_object_msgs/ObjectArray', 'autoware_msgs/DetectedObjectArray',
             'geometry_msgs/PoseArray')

    def __init__(self, kind, labels=None):
        """`labels`: what vision_msgs' numbers mean, as {number: label}."""
        if kind not in self.KINDS:
            raise ValueError("'%s' is none of %s" % (kind, ', '.join(self.KINDS)))
        self.read = {self.KINDS[0]: self._vision, self.KINDS[1]: self._derived, self.KINDS[2]: self._autoware,
                     self.KINDS[3]: self._poses}[kind]
        self.labels = {int(key): value for key, value in (labels or {}).items()}
        self.ids = NearestNeighbour()
        self.numbers = {}

    def convert(self, message):
        """PerceptionObstacles of a message."""
        result = PerceptionObstacles(header=message.header)
        result.perception_obstacle = self.read(message)
        return result

    def _number_all(self, message, obstacles):
        places = [(o.position.x, o.position.y) for o in obstacles]
        for o, number in zip(obstacles, self.ids.identify(message.header.stamp.to_sec(), places)):
            o.id = number
        return obstacles

    def _vision(self, message):
        obstacles, tracked = [], True
        for detection in message.detections:
            best = max(detection.results, key=lambda result: result.score) if detection.results else None
            label = self.labels.get(int(best.id), best.id) if best is not None and str(best.id).isdigit() else getattr(best, 'id', '')
            size = detection.bbox.size
            o = obstacle(detection.bbox.center, type_of(label), (size.x, size.y, size.z),
                         confidence=best.score if best is not None else 0.0)
            name = getattr(detection, 'tracking_id', '') if getattr(detection, 'is_tracking', False) else ''
            tracked = tracked and bool(name)
            if name:
                o.id = self.numbers.setdefault(name, len(self.numbers) + 1)
            obstacles.append(o)
        return obstacles if tracked else self._number_all(message, obstacles)

    @staticmethod
    def _derived(message):
        obstacles = []
        for source in message.objects:
            dimensions = list(source.shape.dimensions)
            size = tuple(dimensions) if source.shape.type == 1 and len(dimensions) == 3 else (0.0, 0.0, 0.0)  # a box
            o = obstacle(source.pose, DERIVED.get(source.classification, PerceptionObstacle.UNKNOWN), size, source.id,
                         source.classification_certainty / 255.0)
            o.velocity.x, o.velocity.y = source.twist.linear.x, source.twist.linear.y
            o.acceleration.x, o.acceleration.y = source.accel.linear.x, source.accel.linear.y
            obstacles.append(o)
        return obstacles

    def _autoware(self, message):
        obstacles = []
        for source in message.objects:
            d = source.dimensions
            o = obstacle(source.pose, type_of(source.label), (d.x, d.y, d.z), source.id, source.score)
            # Its trackers give the speed along the box.
            v = source.velocity.linear.x
            o.velocity.x, o.velocity.y = v * math.cos(o.theta), v * math.sin(o.theta)
            obstacles.append(o)
        ids = [o.id for o in obstacles]
        return obstacles if len(set(ids)) == len(ids) else self._number_all(message, obstacles)

    def _poses(self, message):
        return self._number_all(message, [obstacle(pose, PerceptionObstacle.UNKNOWN_MOVABLE) for pose in message.poses])
