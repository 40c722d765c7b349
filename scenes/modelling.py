"""Polygon modelling for make_models.py: lathes, extrusions, gears, rounded boxes, creased normals."""

import math


class Corner:
    """A corner of a polygon: what a vertex is there."""

    def __init__(self, position, texcoord=(0.0, 0.0)):
        self.position, self.texcoord = position, texcoord
        self.normal, self.color = None, (1.0, 1.0, 1.0)


class Mesh:
    """Polygons, counter-clockwise seen from outside; each a list of Corners."""

    def __init__(self, polygons):
        self.polygons = polygons

    def points(self):
        return [corner.position for polygon in self.polygons for corner in polygon]


class Matrix:
    """An affine transform of column vectors, 3 rows of 4."""

    def __init__(self, rows):
        self.rows = rows

    def __matmul__(self, other):
        full = other.rows + [[0, 0, 0, 1]]
        return Matrix([[sum(row[k] * full[k][c] for k in range(4)) for c in range(4)]
                       for row in self.rows])

    def apply(self, p):
        return tuple(r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3] for r in self.rows)

    def direction(self, d):
        """For rotations and their like only."""
        return tuple(r[0] * d[0] + r[1] * d[1] + r[2] * d[2] for r in self.rows)


def translation(x, y, z):
    return Matrix([[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z]])


def rotation(axis, degrees):
    """Right-handed, about a coordinate axis."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return Matrix({"x": [[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0]],
                   "y": [[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0]],
                   "z": [[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0]]}[axis])


def transformed(mesh, matrix):
    """A copy moved by a rotation and a translation."""
    polygons = []
    for polygon in mesh.polygons:
        polygons.append([])
        for corner in polygon:
            copy = Corner(matrix.apply(corner.position), corner.texcoord)
            copy.normal = corner.normal and matrix.direction(corner.normal)
            copy.color = corner.color
            polygons[-1].append(copy)
    return Mesh(polygons)


def merge(meshes):
    return Mesh([polygon for mesh in meshes for polygon in mesh.polygons])


def subtract(a, b):
    return tuple(p - q for p, q in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def unit(v):
    length = math.sqrt(dot(v, v))
    return tuple(p / length for p in v) if length > 0 else (0.0, 1.0, 0.0)


def area_vector(polygon):
    """Newell's sum: along the normal, twice the area long."""
    total = (0.0, 0.0, 0.0)
    origin = polygon[0].position
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        part = cross(subtract(a.position, origin), subtract(b.position, origin))
        total = tuple(p + q for p, q in zip(total, part))
    return total


def smooth(mesh, crease):
    """Sets normals: at each corner the mean over the adjoining faces that bend less than `crease`."""
    limit = math.cos(math.radians(crease))
    key = lambda p: tuple(round(c * 1e6) for c in p)
    faces = {}
    for polygon in mesh.polygons:
        area = area_vector(polygon)
        for corner in polygon:
            faces.setdefault(key(corner.position), []).append((area, unit(area)))
    for polygon in mesh.polygons:
        own = unit(area_vector(polygon))
        for corner in polygon:
            near = [area for area, normal in faces[key(corner.position)] if dot(normal, own) > limit]
            corner.normal = unit(tuple(sum(parts) for parts in zip(*near)))
    return mesh


def catmull_rom(points, steps):
    """The curve through `points`, `steps` segments between two of them; the ends included."""
    result = []
    for i in range(len(points) - 1):
        p0, p3 = points[max(i - 1, 0)], points[min(i + 2, len(points) - 1)]
        p1, p2 = points[i], points[i + 1]
        for k in range(steps):
            t = k / steps
            result.append(tuple(
                0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t
                       + (3 * b - a - 3 * c + d) * t ** 3) for a, b, c, d in zip(p0, p1, p2, p3)))
    return result + [points[-1]]


def polygon_of(corners):
    """Without repeated points; None where fewer than three are left."""
    kept = [c for i, c in enumerate(corners)
            if max(map(abs, subtract(c.position, corners[i - 1].position))) > 1e-7]
    return kept if len(kept) > 2 else None


def quads(rings, closed=True):
    """Quadrilaterals between neighbouring rings of Corners, outside to the right of the way up."""
    polygons = []
    for j, (low, high) in enumerate(zip(rings, rings[1:])):
        count = len(low)
        for i in range(count if closed else count - 1):
            k = (i + 1) % count
            corners = [Corner(p, t) for p, t in (
                (low[i], (i / count, j / (len(rings) - 1))),
                (low[k], ((i + 1) / count, j / (len(rings) - 1))),
                (high[k], ((i + 1) / count, (j + 1) / (len(rings) - 1))),
                (high[i], (i / count, (j + 1) / (len(rings) - 1))))]
            polygon = polygon_of(corners)
            if polygon:
                polygons.append(polygon)
    return polygons


def lathe(profile, segments):
    """The solid that (radius, height) points, bottom first, make when turned about the y axis."""
    angles = [2 * math.pi * i / segments for i in range(segments)]
    rings = [[(r * math.cos(a), y, -r * math.sin(a)) for a in angles] for r, y in profile]
    return Mesh(quads(rings))


def inset_outline(outline, distance):
    """The counter-clockwise outline moved inwards along the mean normals of its sides."""
    result = []
    for i, (x, y) in enumerate(outline):
        (px, py), (nx, ny) = outline[i - 1], outline[(i + 1) % len(outline)]
        a, b = unit((py - y, x - px)), unit((y - ny, nx - x))
        mean = unit((a[0] + b[0], a[1] + b[1]))
        result.append((x + distance * mean[0], y + distance * mean[1]))
    return result


def extrude(outline, layers):
    """A counter-clockwise outline in x and y as a solid: (z, inset) layers, and flat ends."""
    rings = [[(x, y, z) for x, y in inset_outline(outline, inset)] for z, inset in layers]
    front = [Corner(p) for p in rings[-1]]
    back = [Corner(p) for p in reversed(rings[0])]
    return Mesh(quads(rings) + [front, back])


def gear(teeth, pitch_radius, thickness, twist):
    """A helical gear that lies on y = 0, with a bore and a sunken web; `twist` in radians."""
    tooth = 2.0 * pitch_radius / teeth
    outline = [(pitch_radius - tooth * 1.1, 0.16), (pitch_radius + tooth * 0.9, 0.33),
               (pitch_radius + tooth * 0.9, 0.67), (pitch_radius - tooth * 1.1, 0.84)]
    angles = [2 * math.pi * (i + f) / teeth for i in range(teeth) for _, f in outline]
    radii = [r for _ in range(teeth) for r, _ in outline]

    def ring(y, scale=None):
        turn = twist * (y / thickness - 0.5)
        return [((scale or r) * math.cos(a + turn), y, -(scale or r) * math.sin(a + turn))
                for a, r in zip(angles, radii)]

    r, t = pitch_radius, thickness
    side = [ring(t * k / 4) for k in range(5)]
    top = [ring(t, r * 0.76), ring(t * 0.68, r * 0.74), ring(t * 0.68, r * 0.38),
           ring(t, r * 0.36), ring(t, r * 0.18)]
    bottom = [ring(0, r * 0.18), ring(0, r * 0.76)]
    return Mesh(quads(bottom + side + top + bottom[:1]))


def rounded_box(size, radius):
    """A box with round edges, centred; each of its six faces (+z +x -z -x +y -y) in a row."""
    arc = [0.0, 0.42, 0.75, 1.0]
    polygons = []
    frames = [((1, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
              ((-1, 0, 0), (0, 1, 0), (0, 0, -1)), ((0, 0, 1), (0, 1, 0), (-1, 0, 0)),
              ((1, 0, 0), (0, 0, -1), (0, 1, 0)), ((1, 0, 0), (0, 0, 1), (0, -1, 0))]
    for right, up, out in frames:
        across, along, half = (abs(dot(axis, size)) / 2 for axis in (right, up, out))
        steps = lambda h: [-h + radius * a for a in arc] + [h - radius * a for a in reversed(arc)]
        grid = [[box_corner((right, up, out), (s, t, half), size, radius)
                 for s in steps(across)] for t in steps(along)]
        for row, (low, high) in enumerate(zip(grid, grid[1:])):
            for i in range(len(low) - 1):
                corners = [low[i], low[i + 1], high[i + 1], high[i]]
                polygons.append([Corner(p, t) for p, t in corners])
    return Mesh(polygons)


def box_corner(frame, local, size, radius):
    """The point of the rounded box nearest to a point of the sharp one, and its place on the face."""
    right, up, out = frame
    sharp = tuple(local[0] * r + local[1] * u + local[2] * o for r, u, o in zip(right, up, out))
    core = tuple(min(max(c, radius - s / 2), s / 2 - radius) for c, s in zip(sharp, size))
    away = unit(subtract(sharp, core))
    across, along = abs(dot(right, size)), abs(dot(up, size))
    point = tuple(c + radius * a for c, a in zip(core, away))
    return point, (local[0] / across + 0.5, local[1] / along + 0.5)
