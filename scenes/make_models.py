#!/usr/bin/env python3
"""Makes the models of this folder: models/chess.obj and models/desk.glb with their textures.

Needs nothing but Python 3. The same bytes come out every time; they are kept in the repository, so
this need be run only after a change.
"""

import math
import os

from modelling import (catmull_rom, extrude, gear, lathe, merge, rounded_box, rotation,
                       smooth, transformed, translation)
from model_files import Gltf, Obj, png

HERE = os.path.dirname(os.path.abspath(__file__))
MODELS = os.path.join(HERE, "models")


# ---- chess.obj: one unit is one square of the board --------------------------------------------

FOOT = [(0.0, 0.0), (0.40, 0.0), (0.42, 0.03), (0.42, 0.10), (0.39, 0.14), (0.36, 0.15),
        (0.36, 0.19), (0.33, 0.23)]


def pawn():
    neck = catmull_rom([(0.33, 0.23), (0.24, 0.32), (0.17, 0.48), (0.14, 0.68)], 4)
    ball = [(0.20 * math.cos(a), 0.93 + 0.20 * math.sin(a))
            for a in (math.radians(-60 + 15 * i) for i in range(11))]
    return lathe(FOOT + neck[1:] + [(0.22, 0.70), (0.23, 0.73), (0.19, 0.76), (0.11, 0.76)]
                 + ball[1:-1] + [(0.0, 1.13)], 28)


def rook():
    body = catmull_rom([(0.33, 0.23), (0.27, 0.36), (0.24, 0.60), (0.25, 0.88)], 4)
    tower = lathe(FOOT + body[1:] + [(0.31, 0.92), (0.31, 0.97), (0.34, 0.99), (0.34, 1.10),
                                     (0.22, 1.10), (0.22, 1.06), (0.0, 1.06)], 36)
    merlons = []
    for i in range(5):  # not six: no view of it is its own mirror image
        first, last = math.radians(72 * i + 11), math.radians(72 * i + 61)
        steps = [first + (last - first) * k / 6 for k in range(7)]
        outline = ([(0.335 * math.cos(a), 0.335 * math.sin(a)) for a in steps]
                   + [(0.225 * math.cos(a), 0.225 * math.sin(a)) for a in reversed(steps)])
        block = extrude(outline, [(0.0, 0.0), (0.19, 0.0), (0.205, 0.015)])
        merlons.append(transformed(block, translation(0, 1.085, 0) @ rotation("x", -90)))
    return merge([tower] + merlons)


def knight():
    outline = catmull_rom([
        (0.28, 0.40), (0.29, 0.58), (0.21, 0.74), (0.12, 0.90), (0.19, 0.97), (0.36, 0.90),
        (0.47, 0.87), (0.54, 0.93), (0.53, 1.03), (0.43, 1.13), (0.30, 1.24), (0.21, 1.38),
        (0.18, 1.43), (0.135, 1.58), (0.03, 1.50), (-0.12, 1.42), (-0.26, 1.27), (-0.34, 1.06),
        (-0.36, 0.84), (-0.33, 0.62), (-0.30, 0.40)], 2)
    half = [(0.0, 0.0), (0.06, 0.002), (0.11, 0.010), (0.145, 0.022), (0.165, 0.038)]
    head = extrude(outline, [(-z, inset) for z, inset in reversed(half)] + half[1:])
    foot = lathe(FOOT + [(0.32, 0.30), (0.35, 0.34), (0.35, 0.40), (0.31, 0.43), (0.0, 0.43)], 36)
    eye = lathe([(0.045 * math.cos(math.radians(a)), 0.045 * math.sin(math.radians(a)))
                 for a in range(-90, 91, 30)], 12)
    eyes = [transformed(eye, translation(0.24, 1.20, z)) for z in (-0.165, 0.165)]
    return merge([foot, head] + eyes)


def king():
    body = catmull_rom([(0.33, 0.23), (0.25, 0.40), (0.18, 0.70), (0.16, 1.10)], 5)
    head = catmull_rom([(0.19, 1.28), (0.22, 1.40), (0.27, 1.56), (0.24, 1.62)], 3)
    column = lathe(FOOT + body[1:] + [(0.27, 1.13), (0.27, 1.17), (0.20, 1.20), (0.22, 1.24)]
                   + head + [(0.10, 1.68), (0.05, 1.72), (0.0, 1.72)], 36)
    cross = extrude([(-0.05, 0.0), (0.05, 0.0), (0.04, 0.10), (0.13, 0.09), (0.13, 0.19),
                     (0.04, 0.18), (0.05, 0.28), (-0.05, 0.28), (-0.04, 0.18), (-0.13, 0.19),
                     (-0.13, 0.09), (-0.04, 0.10)],
                    [(-0.045, 0.012), (-0.033, 0.0), (0.033, 0.0), (0.045, 0.012)])
    return merge([column, transformed(cross, translation(0, 1.69, 0))])


def laid_down(mesh, height):
    """The mesh on its side, its lowest point at `height`."""
    lying = transformed(mesh, rotation("z", -84.5))
    lowest = min(p[1] for p in lying.points())
    return transformed(lying, translation(0, height - lowest, 0))


def make_chess():
    board = rounded_box((8.8, 0.4, 8.8), 0.06)
    for polygon in board.polygons:  # the picture lies on the top, the sides take its border
        for corner in polygon:
            x, _, z = corner.position
            corner.texcoord = (0.5 + x / 8.8, 0.5 - z / 8.8)
    with open(os.path.join(MODELS, "board.png"), "wb") as file:
        file.write(png(264, 264, board_texel))
    obj = Obj(os.path.join(MODELS, "chess.obj"), "Chess pieces on a board, one unit a square.")
    obj.material("board", Kd=(1, 1, 1), Ka=(0.1, 0.1, 0.1), Ks=(0.12, 0.12, 0.12), Ns=30,
                 map_Kd="board.png")
    obj.material("boxwood", Kd=(0.78, 0.55, 0.28), Ka=(0.1, 0.1, 0.1), Ks=(0.35, 0.35, 0.35), Ns=60)
    obj.material("ebony", Kd=(0.09, 0.055, 0.045), Ka=(0.1, 0.1, 0.1), Ks=(0.5, 0.5, 0.5), Ns=90)
    top = 0.012  # a hair's breadth above the board, so that no two surfaces coincide
    place = lambda x, z, turn: translation(x, top, z) @ rotation("y", turn)
    obj.group("board", "board", transformed(smooth(board, 40), translation(0, -0.2, 0)), texcoords=True)
    obj.group("knight", "boxwood", transformed(smooth(knight(), 33), place(-0.5, 0.5, 8)))
    obj.group("rook", "ebony", transformed(smooth(rook(), 33), place(0.5, -1.5, 15)))
    obj.group("pawn", "boxwood", transformed(smooth(pawn(), 33), place(-2.5, 1.5, 0)))
    obj.group("pawn_2", "ebony", transformed(smooth(pawn(), 33), place(-1.5, -2.5, 0)))
    fallen = laid_down(smooth(king(), 33), top)
    obj.group("king", "ebony", transformed(fallen, translation(0.62, 0, 1.75) @ rotation("y", 37)))
    obj.write()


def grain(x, y, seed):
    """Wood grain in [0, 1]: growth rings of a plank, sines bent by slower sines."""
    bend = 0.9 * math.sin(0.031 * y + seed) + 0.4 * math.sin(0.083 * y + 2.1 * seed)
    ring = 0.5 + 0.5 * math.sin(0.55 * x + 2.5 * bend + 1.7 * math.sin(0.05 * x + seed))
    fibre = 0.5 + 0.5 * math.sin(2.9 * x + 0.7 * math.sin(0.21 * y + 3 * seed))
    return 0.75 * ring + 0.25 * fibre


def mixed(a, b, t):
    return tuple(round(p + (q - p) * t) for p, q in zip(a, b))


def board_texel(x, y):
    """8 x 8 squares of 30 texels and a border of 12; the far left square is light."""
    column, row = (x - 12) // 30, (y - 12) // 30
    if not (0 <= column < 8 and 0 <= row < 8):
        if 9 <= x < 255 and 9 <= y < 255 and not (10 <= x < 254 and 10 <= y < 254):
            return (200, 160, 96)  # an inlaid line
        return mixed((62, 32, 18), (84, 46, 26), grain(y, x, 5.3))
    seed = 1.7 * column + 2.9 * row
    if (column + row) % 2 == 0:
        return mixed((206, 164, 108), (228, 192, 140), grain(x, y, seed))
    return mixed((96, 54, 32), (128, 76, 46), grain(y, x, seed))


# ---- desk.glb: metres ---------------------------------------------------------------------------

def arm():
    rod = lathe([(0.0, 0.0), (0.006, 0.0), (0.006, 0.22), (0.0, 0.22)], 20)
    joint = transformed(lathe([(0.0, -0.013), (0.012, -0.013), (0.014, -0.011), (0.014, 0.011),
                               (0.012, 0.013), (0.0, 0.013)], 24), rotation("x", 90))
    return merge([rod, joint])


def lamp_foot():
    return lathe(catmull_rom([(0.0, 0.0), (0.085, 0.0)], 1) + [(0.09, 0.004), (0.09, 0.012)]
                 + catmull_rom([(0.088, 0.016), (0.05, 0.024), (0.016, 0.030), (0.012, 0.05)], 4)
                 + [(0.0, 0.05)], 48)


SHADE = [(0.018, -0.030), (0.022, 0.0), (0.030, 0.018), (0.050, 0.045), (0.066, 0.080),
         (0.075, 0.120)]


def shade():
    return lathe([(0.0, -0.036), (0.014, -0.036)] + catmull_rom(SHADE, 4) + [(0.073, 0.1205)], 48)


def reflector():
    inner = [(r - 0.002, y) for r, y in catmull_rom(SHADE[1:], 4)]
    return lathe([(0.0, -0.002)] + inner[:-1] + [(0.073, 0.1204)], 48)


def bulb():
    return lathe([(0.0, 0.0), (0.012, 0.0), (0.012, 0.02)]
                 + [(0.026 * math.cos(math.radians(a)), 0.046 + 0.026 * math.sin(math.radians(a)))
                    for a in range(-60, 90, 15)] + [(0.0, 0.072)], 24)


def vase():
    outer = catmull_rom([(0.030, 0.0), (0.045, 0.030), (0.048, 0.065), (0.030, 0.105),
                         (0.019, 0.130), (0.028, 0.155)], 3)
    mesh = lathe([(0.0, 0.0)] + outer + [(0.025, 0.1555), (0.016, 0.130), (0.0, 0.128)], 32)
    for polygon in mesh.polygons:
        for corner in polygon:
            corner.color = glaze(corner.position)
    return mesh


def glaze(position):
    """A glaze that runs from the rim in eight tongues; few distinct colours, in linear RGB."""
    x, y, z = position
    tongue = 0.085 + 0.02 * math.cos(3 * math.atan2(z, x)) + 0.012 * math.sin(5 * math.atan2(z, x))
    t = min(max((y - tongue + 0.03) / 0.05, 0), 1)
    t = round(t * 12) / 12
    return tuple(a + (b - a) * t for a, b in zip((0.80, 0.74, 0.62), (0.02, 0.16, 0.30)))


GLYPHS = {  # strokes on a grid of 4 x 6, y up
    "P": [[(0, 0), (0, 6), (2.2, 6), (3.4, 5.7), (4, 4.6), (3.4, 3.5), (2.2, 3.1), (0, 3.1)]],
    "E": [[(4, 0), (0, 0), (0, 6), (4, 6)], [(0, 3.1), (3, 3.1)]],
    "N": [[(0, 0), (0, 6), (4, 0), (4, 6)]],
    "U": [[(0, 6), (0, 1.8), (0.6, 0.5), (2, 0), (3.4, 0.5), (4, 1.8), (4, 6)]],
    "M": [[(0, 0), (0, 6), (2, 2.4), (4, 6), (4, 0)]],
    "R": [[(0, 0), (0, 6), (2.2, 6), (3.4, 5.7), (4, 4.6), (3.4, 3.5), (2.2, 3.1), (0, 3.1)],
          [(2.0, 3.1), (4, 0)]],
}
CELL = 96  # texels a side of the block takes
FACES = "PENUMR"
INKS = [(178, 44, 38), (32, 84, 140), (40, 116, 62), (206, 130, 22), (104, 52, 130), (26, 118, 124)]


def distance_to_strokes(strokes, x, y):
    best = 1e9
    for stroke in strokes:
        for (ax, ay), (bx, by) in zip(stroke, stroke[1:]):
            dx, dy = bx - ax, by - ay
            t = min(max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), 0), 1)
            best = min(best, math.hypot(x - ax - t * dx, y - ay - t * dy))
    return best


def letter_texel(x, y):
    """Six letters in cells of 3 columns and 2 rows, each with a frame of its colour, on maple."""
    index = x // CELL + 3 * (y // CELL)
    ink, s, t = INKS[index], x % CELL + 0.5, y % CELL + 0.5
    edge = min(s, t, CELL - s, CELL - t)
    wood = mixed((214, 178, 126), (232, 202, 154), grain(s, t, 1.3 * index))
    unit = CELL / 11.0  # of the glyph's grid
    far = distance_to_strokes(GLYPHS[FACES[index]], s / unit - 3.5, 8.5 - t / unit)
    frame = min(max(2.5 - abs(edge - 13.0), 0), 1)
    letter = min(max((0.55 - far) * unit + 0.5, 0), 1)
    return mixed(wood, ink, max(frame, letter))


def block():
    mesh = rounded_box((0.05, 0.05, 0.05), 0.004)
    for index, polygon in enumerate(mesh.polygons):
        face = index * 6 // len(mesh.polygons)
        for corner in polygon:
            u, v = corner.texcoord
            corner.texcoord = ((face % 3 + 0.02 + 0.96 * u) / 3, (1 - face // 3 + 0.02 + 0.96 * v) / 2)
    return mesh


TEETH = 20
PITCH_RADIUS = 0.042


def add_gears(gltf, table, meshing_angle):
    """Two helical gears in mesh: the second is the mirror image of the first, as it has to be."""
    mesh = gltf.mesh("Gear", "Brass", smooth(gear(TEETH, PITCH_RADIUS, 0.018, math.radians(9)), 30))
    group = gltf.node("Gears", parent=table, translation=(0.066, 0.0007, 0.113))
    turn = meshing_angle - 180 / TEETH
    gltf.node("GearLeft", parent=group, mesh=mesh, turn=("y", turn))
    x, z = math.cos(math.radians(meshing_angle)), -math.sin(math.radians(meshing_angle))
    gltf.node("GearRight", parent=group, mesh=mesh, turn=("y", meshing_angle), scale=(-1, 1, 1),
              translation=(2.02 * PITCH_RADIUS * x, 0, 2.02 * PITCH_RADIUS * z))


def add_lamp(gltf, table):
    foot = gltf.mesh("LampFoot", "Enamel", smooth(lamp_foot(), 35))
    rod = gltf.mesh("Arm", "Steel", smooth(arm(), 35))
    head = [gltf.mesh("Shade", "Enamel", smooth(shade(), 35)),
            gltf.mesh("Reflector", "Reflector", smooth(reflector(), 35)),
            gltf.mesh("Bulb", "Bulb", smooth(bulb(), 35))]
    lamp = gltf.node("Lamp", parent=table, mesh=foot, translation=(-0.13, 0.0007, -0.03),
                     turn=("y", -24))
    lower = gltf.node("LowerArm", parent=lamp, mesh=rod, translation=(0, 0.050, 0), turn=("z", 24))
    upper = gltf.node("UpperArm", parent=lower, mesh=rod, translation=(0, 0.22, 0), turn=("z", -88))
    joint = gltf.node("Head", parent=upper, translation=(0, 0.225, 0), turn=("z", -80))
    for mesh in head:
        gltf.node(gltf.document["meshes"][mesh]["name"], parent=joint, mesh=mesh)
    return joint


def add_blocks(gltf, table):
    mesh = gltf.mesh("Block", "Letters", smooth(block(), 40))
    gltf.node("BlockP", parent=table, mesh=mesh, translation=(-0.055, 0.0257, 0.12), turn=("y", 22))
    gltf.node("BlockE", parent=table, mesh=mesh, translation=(0.012, 0.0257, 0.062), turn=("y", -68))
    gltf.node("BlockN", parent=table, mesh=mesh, translation=(-0.018, 0.0765, 0.092),
              turn=("y", -171))


def make_desk():
    gltf = Gltf(os.path.join(MODELS, "desk.glb"))
    gltf.material("Enamel", (0.02, 0.13, 0.12), metallic=0.0, roughness=0.35,
                  double_sided=True)
    gltf.material("Steel", (0.62, 0.62, 0.64), metallic=1.0, roughness=0.3)
    gltf.material("Brass", (0.80, 0.53, 0.20), metallic=1.0, roughness=0.35)
    gltf.material("Glaze", (1, 1, 1), metallic=0.0, roughness=0.25)
    gltf.material("Reflector", (0.9, 0.88, 0.8), metallic=0.0, roughness=0.6,
                  emission=(0.55, 0.42, 0.22), double_sided=True)
    gltf.material("Bulb", (1, 1, 1), metallic=0.0, roughness=0.5, emission=(1, 0.93, 0.75))
    gltf.material("Letters", (1, 1, 1), metallic=0.0, roughness=0.5,
                  texture=png(3 * CELL, 2 * CELL, letter_texel))
    table = gltf.node("Desk")
    head = add_lamp(gltf, table)
    add_blocks(gltf, table)
    add_gears(gltf, table, -20)
    gltf.node("Vase", parent=table, translation=(0.14, 0.0007, -0.02), turn=("y", 35),
              mesh=gltf.mesh("Vase", "Glaze", smooth(vase(), 40), texcoords=False, colors=True))
    gltf.camera("Camera", eye=(0.13, 0.27, 0.78), target=(0.005, 0.160, 0.02), yfov=34)
    gltf.write()
    matrix = gltf.world_matrix(head)
    print("lamp: light at", matrix.apply((0, 0.092, 0)), "axis", matrix.direction((0, 1, 0)))


if __name__ == "__main__":
    os.makedirs(MODELS, exist_ok=True)
    make_chess()
    make_desk()
