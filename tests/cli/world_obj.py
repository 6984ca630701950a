"""Meshes that terrane export writes, as longitudes, latitudes and heights."""

import math

MAJOR_M, FLATTENING = 6378137.0, 1 / 298.257223563
ECCENTRICITY2 = FLATTENING * (2 - FLATTENING)


def radius_across_m(latitude):
    return MAJOR_M / math.sqrt(1 - ECCENTRICITY2 * math.sin(latitude) ** 2)


class EastNorthUp:
    """Metres about a place on WGS84 as degrees and heights over the ellipsoid."""

    def __init__(self, longitude_deg, latitude_deg):
        self.lon, self.lat = math.radians(longitude_deg), math.radians(latitude_deg)
        n = radius_across_m(self.lat)
        self.from_axis = n * math.cos(self.lat)
        self.from_equator = n * (1 - ECCENTRICITY2) * math.sin(self.lat)

    def __call__(self, east, north, up):
        # Earth-centred, with the first axis through the origin's meridian
        x = self.from_axis - math.sin(self.lat) * north + math.cos(self.lat) * up
        z = self.from_equator + math.cos(self.lat) * north + math.sin(self.lat) * up
        across = math.hypot(x, east)
        latitude = self.lat
        for _ in range(6):
            n = radius_across_m(latitude)
            latitude = math.atan2(z + ECCENTRICITY2 * n * math.sin(latitude), across)
        height = (across * math.cos(latitude) + z * math.sin(latitude) -
                  MAJOR_M * math.sqrt(1 - ECCENTRICITY2 * math.sin(latitude) ** 2))
        return (math.degrees(self.lon + math.atan2(east, x)), math.degrees(latitude), height)


def read_world_obj(file):
    """Vertices as (longitude, latitude, height), and triangles."""
    vertices, triangles, to_degrees = [], [], None
    for text in file.read_text().splitlines():
        words = text.split()
        if words[0] == "#" and "longitude" in words:
            to_degrees = EastNorthUp(float(words[words.index("longitude") + 1]),
                                     float(words[words.index("latitude") + 1]))
        elif words[0] == "v":
            vertices.append(to_degrees(*map(float, words[1:])))
        elif words[0] == "f":
            triangles.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:]))
    return vertices, triangles
