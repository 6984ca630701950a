"""An image of the synthetic caldera as from the air, for the viewer's imagery look."""

import math

SIZE = 512
EXTENT_M = 5120
CENTRE = EXTENT_M / 2


def colour_at(x, y):
    """A lake with a shore, woods around it, and fields beyond; r, g, b of 0 to 255."""
    r = math.hypot(x - CENTRE, y - CENTRE)
    grain = math.sin(x / 37 + 2 * math.sin(y / 61)) * math.sin(y / 41 + 2 * math.sin(x / 53))
    if r < 820:
        return 38, 84 + 6 * grain, 116 + 8 * grain
    if r < 880:
        return 214, 200, 160
    if r < 1900 + 150 * grain:
        return 58 + 14 * grain, 92 + 20 * grain, 48 + 10 * grain
    column, row = int(x // 320), int(y // 240)
    shade = (7 * column + 13 * row + column * row) % 5
    furrow = 6 * math.sin((x if shade % 2 else y) / 9)
    return (148 + 16 * shade + furrow, 150 + 7 * shade + furrow, 84 + 8 * shade + furrow)


def write_image(path):
    """Writes a PPM and, beside it, its place: a pixel is 10 m, rows go south from y = 0."""
    cell_m = EXTENT_M / SIZE
    pixels = bytearray()
    for row in range(SIZE):
        for column in range(SIZE):
            rgb = colour_at((column + 0.5) * cell_m, (row + 0.5) * cell_m)
            pixels += bytes(min(255, max(0, round(value))) for value in rgb)
    path.write_bytes(b"P6\n%d %d\n255\n" % (SIZE, SIZE) + pixels)
    place = [cell_m, 0, 0, -cell_m, cell_m / 2, -cell_m / 2]
    path.with_suffix(".wld").write_text("".join(f"{value}\n" for value in place))
