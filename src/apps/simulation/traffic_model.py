"""Traffic on parallel lanes: drivers by the intelligent driver model (Treiber, Hennecke and Helbing 2000) who change
lanes by MOBIL (Kesting, Treiber and Helbing 2007), one who cuts in before the vehicle, one car that is parked on its
lane, pedestrians who cross, and a sensor that sees it all as sensors do. Lengths in [m], times in [s], angles in [rad]
counter-clockwise from x."""
import bisect
import json
import math
import random

CAR = (4.6, 1.9)  # length and width [m]
PEDESTRIAN = (0.6, 0.6)
STEP = 0.1  # [s]

# The intelligent driver model's and MOBIL's figures, as their authors give them.
MAX_ACCELERATION = 1.4  # [m/s^2]
COMFORTABLE_BRAKING = 2.0  # [m/s^2]
HEADWAY = 1.5  # [s]
STANDSTILL_GAP = 2.0  # [m]
SAFE_BRAKING = 4.0  # [m/s^2] that a change may cost the one behind
POLITENESS = 0.3
CHANGE_THRESHOLD = 0.2  # [m/s^2]
CHANGE_TIME = 4.0  # [s]
HARDEST_BRAKING = 8.0  # [m/s^2]
WALK = 1.3  # [m/s]
EGO_ROOM = 250.0  # [m] before the vehicle nobody changes onto its lane
EGO_REACH = 120.0  # [m] before the vehicle nobody holds it up


def idm(v, wanted, gap, closing):
    """Acceleration at speed v with so much gap to the leader (None: none) that is approached at `closing`."""
    acceleration = 1.0 - (v / wanted)**4
    if gap is not None:
        desired = STANDSTILL_GAP + max(
            0.0, v * HEADWAY + v * closing / (2.0 * math.sqrt(MAX_ACCELERATION * COMFORTABLE_BRAKING)))
        acceleration -= (desired / max(gap, 0.1))**2
    return max(-HARDEST_BRAKING, MAX_ACCELERATION * acceleration)


def smooth(u):
    """0 to 1 without a jump of rate."""
    u = min(1.0, max(0.0, u))
    return u * u * (3.0 - 2.0 * u)


class Road:
    """Lanes side by side, from left to right, told by one of them: s along it and l to its left."""

    def __init__(self, lines):
        self.lines = lines
        self.points = lines[len(lines) // 2]
        self.s = [0.0]
        for a, b in zip(self.points, self.points[1:]):
            self.s.append(self.s[-1] + math.hypot(b[0] - a[0], b[1] - a[1]))
        self.length = self.s[-1]
        self.lateral = [self._measure(line) for line in lines]

    def _measure(self, line):
        """(s, l) of a line's points, by rising s."""
        places = sorted(self.project(x, y) for x, y in line[::max(1, len(line) // 400)])
        return [s for s, _ in places], [l for _, l in places]

    def _segment(self, s):
        return min(len(self.points) - 2, max(0, bisect.bisect_right(self.s, s) - 1))

    def pose(self, s, l):
        """x, y and the road's direction there; straight on past the ends."""
        i = self._segment(s)
        (ax, ay), (bx, by) = self.points[i], self.points[i + 1]
        theta = math.atan2(by - ay, bx - ax)
        along = s - self.s[i]
        return (ax + along * math.cos(theta) - l * math.sin(theta), ay + along * math.sin(theta) + l * math.cos(theta),
                theta)

    def project(self, x, y):
        """(s, l) of a place."""
        best = None
        for i in range(len(self.points) - 1):
            (ax, ay), (bx, by) = self.points[i], self.points[i + 1]
            dx, dy = bx - ax, by - ay
            square = dx * dx + dy * dy
            if square == 0.0:
                continue
            u = min(1.0, max(0.0, ((x - ax) * dx + (y - ay) * dy) / square))
            ex, ey = x - ax - u * dx, y - ay - u * dy
            distance = ex * ex + ey * ey
            if best is None or distance < best[0]:
                best = (distance, self.s[i] + u * math.sqrt(square), (dx * ey - dy * ex) / math.sqrt(square))
        return best[1], best[2]

    def offset(self, lane, s):
        """[m] of a lane's middle to the left of the road's line."""
        places, offsets = self.lateral[lane]
        i = min(len(places) - 1, bisect.bisect_left(places, s))
        return offsets[i]


class Car:
    """On a lane, or on the way from one to the next."""

    def __init__(self, name, lane, s, v, wanted):
        self.name, self.lane, self.s, self.v, self.wanted = name, lane, s, v, wanted
        self.kind, self.size = 'VEHICLE', CAR
        self.left_lane, self.changed = lane, CHANGE_TIME
        self.acceleration = 0.0
        self.patience = 0.0  # [s] until it looks for another lane again

    def lateral(self, road):
        here, there = road.offset(self.left_lane, self.s), road.offset(self.lane, self.s)
        return here + smooth(self.changed / CHANGE_TIME) * (there - here)

    def changes(self):
        return self.changed < CHANGE_TIME

    def change(self, lane):
        self.left_lane, self.lane, self.changed = self.lane, lane, 0.0

    def lanes(self):
        return {self.lane, self.left_lane} if self.changes() else {self.lane}


class Pedestrian:
    """Waits at the right side of the road and crosses where there is time to."""

    def __init__(self, name, s):
        self.name, self.s, self.kind, self.size = name, s, 'PEDESTRIAN', PEDESTRIAN
        self.way = 0.0  # [m] walked
        self.walks = False


class Traffic:
    """All road users but the vehicle, which is told by `ego`: (s, l, v) or None."""

    def __init__(self, road, cars=14, pedestrians=2, speed=13.0, seed=1):
        self.road, self.random = road, random.Random(seed)
        self.time = 0.0
        lanes = len(road.lines)
        self.cars, taken = [], {lane: [] for lane in range(lanes)}
        for i in range(cars):
            lane = i % lanes
            s = 45.0 + 32.0 * (i // lanes) + self.random.uniform(-6.0, 6.0)
            wanted = speed * self.random.uniform(0.75, 1.15)
            taken[lane].append(s)
            self.cars.append(Car('car %d' % i, lane, s, wanted, wanted))
        self.parked = None
        if cars and lanes > 1:
            self.parked = Car('parked', lanes - 1, min(0.6 * road.length, 350.0), 0.0, 0.1)
            self.cars.append(self.parked)
            # It starts beside the vehicle's lane, a little ahead, and comes over.
            self.cutter = Car('cutter', 0, 12.0, speed, 1.05 * speed)
            self.cars.append(self.cutter)
        else:
            self.cutter = None
        width = abs(road.offset(0, 0.0) - road.offset(lanes - 1, 0.0))
        self.cross = width + 8.0  # [m] from kerb to kerb
        self.pedestrians = [Pedestrian('pedestrian %d' % i, 90.0 + 120.0 * i) for i in range(pedestrians)]

    def _others(self, lane, ego):
        """(s, v, length, car) of all that are on a lane."""
        for car in self.cars:
            if lane in car.lanes():
                yield car.s, car.v, car.size[0], car
        if ego and abs(ego[1] - self.road.offset(lane, ego[0])) < 1.6:
            yield ego[0], ego[2], CAR[0], None
        for pedestrian in self.pedestrians:
            l = self.lateral_of(pedestrian)
            if pedestrian.walks and abs(l - self.road.offset(lane, pedestrian.s)) < 2.5:
                yield pedestrian.s, 0.0, PEDESTRIAN[0], None

    def _neighbours(self, lane, s, ego, me=None):
        """The nearest ahead and behind on a lane, each (gap, v, car) or None."""
        ahead = behind = None
        for other_s, v, length, car in self._others(lane, ego):
            if car is me and me is not None:
                continue
            gap = abs(other_s - s) - 0.5 * (length + CAR[0])
            if other_s >= s and (ahead is None or gap < ahead[0]):
                ahead = (gap, v, car)
            elif other_s < s and (behind is None or gap < behind[0]):
                behind = (gap, v, car)
        return ahead, behind

    @staticmethod
    def _acceleration(v, wanted, ahead):
        return idm(v, wanted, ahead[0] if ahead else None, v - ahead[1] if ahead else 0.0)

    def _think_of_changing(self, car, ego):
        """MOBIL: a change that is safe for the one behind and worth it for all."""
        here = self._neighbours(car.lane, car.s, ego, car)
        now = self._acceleration(car.v, car.wanted, here[0])
        best = None
        for lane in (car.lane - 1, car.lane + 1):
            if not 0 <= lane < len(self.road.lines):
                continue
            ahead, behind = self._neighbours(lane, car.s, ego, car)
            if (ahead and ahead[0] < STANDSTILL_GAP) or (behind and behind[0] < STANDSTILL_GAP):
                continue
            # The vehicle does not brake for others: nobody but the one that cuts in changes onto its lane before it.
            if ego and 0.0 < car.s - ego[0] < EGO_ROOM and abs(ego[1] - self.road.offset(lane, ego[0])) < 1.6:
                continue
            gain = self._acceleration(car.v, car.wanted, ahead) - now
            if behind:
                wanted = behind[2].wanted if behind[2] else max(1.0, 1.2 * behind[1])
                before = idm(behind[1], wanted, None, 0.0)
                after = idm(behind[1], wanted, behind[0], behind[1] - car.v)
                if after < -SAFE_BRAKING:
                    continue
                gain += POLITENESS * (after - before)
            if gain > CHANGE_THRESHOLD and (best is None or gain > best[0]):
                best = (gain, lane)
        return best[1] if best else None

    def _haste(self, car, ego):
        """[m/s] that one before the vehicle drives at least: the vehicle follows its line whoever is there."""
        if ego is None or car is self.parked or not 0.0 < car.s - ego[0] < EGO_REACH:
            return 0.0
        near = min(abs(ego[1] - self.road.offset(lane, ego[0])) for lane in car.lanes())
        return 1.2 * ego[2] + 1.0 if near < 1.6 else 0.0

    def _cut_in(self, ego):
        car = self.cutter
        if car is None or ego is None or car.changes() or car.lane != 0:
            return
        lane = min(range(len(self.road.lines)), key=lambda k: abs(self.road.offset(k, ego[0]) - ego[1]))
        if lane == 1 and 8.0 < car.s - ego[0] < 30.0 and self.time > 4.0:
            car.change(1)

    def step(self, ego=None):
        """On by STEP."""
        for car in self.cars:
            leaders = [self._neighbours(lane, car.s, ego, car)[0] for lane in car.lanes()]
            wanted = max(car.wanted, self._haste(car, ego))
            car.acceleration = min(self._acceleration(car.v, wanted, ahead) for ahead in leaders)
        for car in self.cars:
            if car is self.parked or car.changes() or car is self.cutter:
                continue
            car.patience -= STEP
            if car.patience <= 0.0:
                car.patience = self.random.uniform(0.5, 1.5)
                lane = self._think_of_changing(car, ego)
                if lane is not None:
                    car.change(lane)
                    car.patience = 6.0
        self._cut_in(ego)
        for car in self.cars:
            if car is self.parked:
                continue
            v = max(0.0, car.v + STEP * car.acceleration)
            car.s += 0.5 * STEP * (car.v + v)
            car.v = v
            car.changed += STEP
        self.cars = [car for car in self.cars if car.s < self.road.length - 5.0]
        for pedestrian in self.pedestrians:
            self._walk(pedestrian, ego)
        self.time += STEP

    def _walk(self, pedestrian, ego):
        """Who has begun goes on; who waits begins when nobody comes within the time that it takes."""
        if not pedestrian.walks and pedestrian.way == 0.0:
            comers = [(car.s, car.v) for car in self.cars] + ([(ego[0], ego[2])] if ego else [])
            free = all(not 0.0 < pedestrian.s - s < 5.0 + v * (self.cross / WALK) for s, v in comers)
            hurry = self.time > 8.0 and all(
                not 0.0 < pedestrian.s - s < 10.0 + v * v / (2.0 * COMFORTABLE_BRAKING) + v for s, v in comers)
            pedestrian.walks = self.time > 2.0 and (free or hurry) and not (
                ego and 0.0 < pedestrian.s - ego[0] < EGO_REACH + ego[2] * (self.cross / WALK))
        if pedestrian.walks:
            pedestrian.way += STEP * WALK
            pedestrian.walks = pedestrian.way < self.cross

    def lateral_of(self, pedestrian):
        return self.road.offset(len(self.road.lines) - 1, pedestrian.s) - 4.0 + pedestrian.way

    def users(self):
        """(name, kind, x, y, heading, vx, vy, length, width) of all."""
        for car in self.cars:
            l = car.lateral(self.road)
            x, y, theta = self.road.pose(car.s, l)
            if car.changes():
                u = car.changed / CHANGE_TIME
                rate = 6.0 * u * (1.0 - u) / CHANGE_TIME * (
                    self.road.offset(car.lane, car.s) - self.road.offset(car.left_lane, car.s))
                theta += math.atan2(rate, max(car.v, 1.0))
            yield car.name, car.kind, x, y, theta, car.v * math.cos(theta), car.v * math.sin(theta), CAR[0], CAR[1]
        for pedestrian in self.pedestrians:
            x, y, theta = self.road.pose(pedestrian.s, self.lateral_of(pedestrian))
            theta += math.pi / 2.0
            v = WALK if pedestrian.walks else 0.0
            yield (pedestrian.name, pedestrian.kind, x, y, theta, v * math.cos(theta), v * math.sin(theta),
                   PEDESTRIAN[0], PEDESTRIAN[1])


class Sensor:
    """Sees what is within its range, with noise, misses some, and now and then mixes up two ids."""

    def __init__(self, reach=100.0, noise=0.15, dropouts=0.03, swap_period=25.0, seed=1):
        self.reach, self.noise, self.dropouts, self.swap_period = reach, noise, dropouts, swap_period
        self.random = random.Random(seed)
        self.ids = {}
        self.since_swap = 0.0

    def see(self, users, x, y):
        """[(id, kind, x, y, heading, length, width)] as seen from a place; to be called every STEP."""
        near = [user for user in users if math.hypot(user[2] - x, user[3] - y) < self.reach]
        for user in near:
            self.ids.setdefault(user[0], len(self.ids) + 1)
        self.since_swap += STEP
        if self.swap_period and self.since_swap >= self.swap_period and len(near) > 1:
            self.since_swap = 0.0
            a, b = self.random.sample([user[0] for user in near], 2)
            self.ids[a], self.ids[b] = self.ids[b], self.ids[a]
        seen = []
        for name, kind, ux, uy, heading, _, _, length, width in near:
            dx, dy = self.random.gauss(0.0, self.noise), self.random.gauss(0.0, self.noise)
            if self.random.random() >= self.dropouts:
                seen.append((self.ids[name], kind, ux + dx, uy + dy, heading + self.random.gauss(0.0, 0.02), length, width))
        return seen


def read_line(path):
    """Points of a .smoothed file."""
    with open(path) as stream:
        points = [(float(row['x']), float(row['y'])) for row in map(json.loads, filter(str.strip, stream))]
    if len(points) < 2:
        raise ValueError('%s: fewer than two points' % path)
    return points


def straight_lines(lanes, length, spacing=3.5):
    """For scenes without a road: from left to right."""
    return [[(float(x), -spacing * lane) for x in range(0, int(length) + 1, 2)] for lane in range(lanes)]
