"""Lines in the plane: distances to them, what is inside, and what closes around something."""

import math


def along(ring, step):
    """Points on a line, at most step apart."""
    for (ax, ay), (bx, by) in zip(ring, ring[1:]):
        count = math.ceil(math.hypot(bx - ax, by - ay) / step) or 1
        for i in range(count):
            yield ax + (bx - ax) * i / count, ay + (by - ay) * i / count


class NearestSegment:
    """Distances to segments, found by way of a grid of square bins."""

    def __init__(self, segments, bin_size):
        self.bin_size, self.bins = bin_size, {}
        for segment in segments:
            for x, y in {self.bin(p) for p in along(segment, bin_size / 2)} | {
                    self.bin(segment[1])}:
                for i in (-1, 0, 1):
                    for j in (-1, 0, 1):
                        self.bins.setdefault((x + i, y + j), []).append(segment)

    def bin(self, point):
        return int(point[0] // self.bin_size), int(point[1] // self.bin_size)

    def distance(self, point):
        """Infinite where it is more than a bin's size."""
        return min((self.to_segment(point, s) for s in self.bins.get(self.bin(point), ())),
                   default=math.inf)

    @staticmethod
    def to_segment(p, segment):
        (ax, ay), (bx, by) = segment
        dx, dy = bx - ax, by - ay
        length2 = dx * dx + dy * dy
        t = ((p[0] - ax) * dx + (p[1] - ay) * dy) / length2 if length2 else 0
        t = min(1, max(0, t))
        return math.hypot(p[0] - ax - t * dx, p[1] - ay - t * dy)


def is_inside(point, rings):
    x, y = point
    crossings = 0
    for ring in rings:
        for (ax, ay), (bx, by) in zip(ring, ring[1:]):
            crossings += (ay <= y) != (by <= y) and x < ax + (y - ay) * (bx - ax) / (by - ay)
    return crossings % 2 == 1


def has_cycle(lines):
    """Do the edges close around something? As many edges as vertices, or more, in one part."""
    part = {v: v for line in lines for v in line}

    def root(v):
        while part[v] != v:
            v = part[v]
        return v
    for a, b in lines:
        if root(a) == root(b):
            return True
        part[root(a)] = root(b)
    return False
