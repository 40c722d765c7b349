"""Draws glTF models with Blender's path tracer Cycles, lit and seen as penumbra does.

Run by `scripts/gallery --cycles`, inside Blender 3.4:
  blender -b -noaudio --factory-startup --python scripts/cycles_reference.py -- JOBS.json

JOBS.json is a list of jobs (see scripts/path_traced.py); places are in glTF's axes, y up. What is
the same as in penumbra by arrangement, not by physics: the floor is seen by the camera and through
glass, not in mirrors, and gives no light unless "floor_gives_light" is true; behind
the scene lies one colour, also through glass, and the environment is what mirrors show.
"""
import json
import math
import struct
import sys
import time

import bpy
import numpy
from mathutils import Matrix, Vector

# Blender 3.4's glTF importer uses this name, which numpy 1.24 has no more.
numpy.bool = bool


def blender_axes(v):
    """From y up to z up, as Blender's glTF importer turns models."""
    return Vector((v[0], -v[2], v[1]))


def set_camera(job):
    eye, right, up, ahead = (blender_axes(job["camera"][k])
                             for k in ("position", "right", "up", "direction"))
    data = bpy.data.cameras.new("reference")
    data.sensor_fit = "HORIZONTAL"
    if job["camera"]["orthographic"]:
        data.type = "ORTHO"
        data.ortho_scale = right.length
    else:
        data.angle = 2 * math.atan(right.length / 2 / ahead.length)
    data.clip_start, data.clip_end = 1e-4 * job["radius"], 1e5 * job["radius"]
    camera = bpy.data.objects.new("reference", data)
    axes = Matrix((right.normalized(), up.normalized(), -ahead.normalized())).transposed()
    camera.matrix_world = Matrix.Translation(eye) @ axes.to_4x4()
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def node(tree, kind, **settings):
    made = tree.nodes.new(kind)
    for name, value in settings.items():
        setattr(made, name, value)
    return made


def background_share(tree):
    """1 for rays from the camera and for what glass lets through, 0 for mirrored rays and light.

    A ray keeps 'camera' through what is merely transparent. What was mirrored and then refracted
    counts as mirrored. Never 1 where Cycles samples the environment as a light.
    """
    path = node(tree, "ShaderNodeLightPath")
    unmirrored = node(tree, "ShaderNodeMath", operation="LESS_THAN")
    tree.links.new(path.outputs["Glossy Depth"], unmirrored.inputs[0])
    unmirrored.inputs[1].default_value = 0.5
    through = node(tree, "ShaderNodeMath", operation="MULTIPLY")
    tree.links.new(path.outputs["Is Transmission Ray"], through.inputs[0])
    tree.links.new(unmirrored.outputs[0], through.inputs[1])
    either = node(tree, "ShaderNodeMath", operation="MAXIMUM")
    tree.links.new(path.outputs["Is Camera Ray"], either.inputs[0])
    tree.links.new(through.outputs[0], either.inputs[1])
    return either.outputs[0]


def set_world(job):
    world = bpy.data.worlds.new("reference")
    bpy.context.scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    place = node(tree, "ShaderNodeTexCoord")
    turned = node(tree, "ShaderNodeVectorRotate", rotation_type="Z_AXIS")
    image = bpy.data.images.load(job["environment"])
    image.colorspace_settings.name = "Linear"
    sky = node(tree, "ShaderNodeTexEnvironment", image=image, interpolation="Linear")
    seen = node(tree, "ShaderNodeBackground")
    light = node(tree, "ShaderNodeBackground")
    mix = node(tree, "ShaderNodeMixShader")
    # Blender's images have their middle in +x; the studio's stands where the camera looks.
    ahead = blender_axes(job["camera"]["direction"])
    turned.inputs["Angle"].default_value = -math.atan2(ahead.y, ahead.x)
    seen.inputs["Color"].default_value = (*job["background"], 1)
    tree.links.new(place.outputs["Generated"], turned.inputs["Vector"])
    tree.links.new(turned.outputs[0], sky.inputs["Vector"])
    tree.links.new(sky.outputs[0], light.inputs["Color"])
    tree.links.new(background_share(tree), mix.inputs[0])
    tree.links.new(light.outputs[0], mix.inputs[1])
    tree.links.new(seen.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], node(tree, "ShaderNodeOutputWorld").inputs[0])
    world.cycles.sampling_method = "MANUAL"
    world.cycles.sample_map_resolution = 1024


def carry(tree, source, target):
    """Gives the input `target` the link or else the value of the input `source`."""
    if source.is_linked:
        tree.links.new(source.links[0].from_socket, target)
    elif not source.hide_value:  # a normal that nothing is linked to is the surface's
        target.default_value = source.default_value


def twin(tree, principled):
    made = node(tree, "ShaderNodeBsdfPrincipled", distribution=principled.distribution)
    for source in principled.inputs:
        carry(tree, source, made.inputs[source.name])
    return made


def mixed(tree, share, first, second):
    """Of two shaders; `share` is an input to take the second one's part from, or an output."""
    mix = node(tree, "ShaderNodeMixShader")
    if share.is_output:
        tree.links.new(share, mix.inputs[0])
    else:
        carry(tree, share, mix.inputs[0])
    tree.links.new(first, mix.inputs[1])
    tree.links.new(second, mix.inputs[2])
    return mix.outputs[0]


def dimmed(tree, taken, shader):
    """A shader less the share `taken`."""
    nothing = node(tree, "ShaderNodeBsdfTransparent")
    nothing.inputs[0].default_value = (0, 0, 0, 1)
    return mixed(tree, taken, shader, nothing.outputs[0])


def unlink(tree, socket, value):
    for link in socket.links:
        tree.links.remove(link)
    socket.default_value = value


def under_the_mirror(tree, principled):
    """What a dielectric does with light that its surface lets in: Lambert's term or thin glass."""
    glass = principled.inputs["Transmission"]
    matte = node(tree, "ShaderNodeBsdfDiffuse")
    carry(tree, principled.inputs["Base Color"], matte.inputs["Color"])
    carry(tree, principled.inputs["Normal"], matte.inputs["Normal"])
    if not glass.is_linked and glass.default_value == 0:
        return matte.outputs[0]
    through = node(tree, "ShaderNodeBsdfRefraction", distribution="GGX")
    through.inputs["IOR"].default_value = 1
    for name, target in ("Base Color", "Color"), ("Normal", "Normal"), ("Roughness", "Roughness"):
        carry(tree, principled.inputs[name], through.inputs[target])
    return mixed(tree, glass, matte.outputs[0], through.outputs[0])


def base_layer(tree, principled):
    """glTF's base: mix(dielectric, metal, metallic), with Lambert's diffuse term.

    Blender's own has Burley's, which is up to 1.4 times as bright where light and view graze.
    """
    metallic = principled.inputs["Metallic"]
    shiny = twin(tree, principled)
    for name, value in ("Base Color", (0, 0, 0, 1)), ("Metallic", 0), ("Transmission", 0):
        unlink(tree, shiny.inputs[name], value)
    taken = node(tree, "ShaderNodeMath", operation="MULTIPLY")  # what the mirror takes: its F0
    carry(tree, principled.inputs["Specular"], taken.inputs[0])
    taken.inputs[1].default_value = 0.08
    both = node(tree, "ShaderNodeAddShader")
    tree.links.new(dimmed(tree, taken.outputs[0], under_the_mirror(tree, principled)),
                   both.inputs[0])
    tree.links.new(shiny.outputs[0], both.inputs[1])
    if not metallic.is_linked and metallic.default_value == 0:
        return both.outputs[0]
    metal = twin(tree, principled)
    unlink(tree, metal.inputs["Metallic"], 1)
    return mixed(tree, metallic, both.outputs[0], metal.outputs[0])


def coated(tree, principled, base):
    """glTF's coat: a layer of index 1.5. Blender 3.4 would give it a quarter of its strength."""
    strength = principled.inputs["Clearcoat"]
    if not strength.is_linked and strength.default_value == 0:
        return base
    coat = node(tree, "ShaderNodeBsdfGlossy", distribution="MULTI_GGX")
    coat.inputs["Color"].default_value = (1, 1, 1, 1)
    fresnel = node(tree, "ShaderNodeFresnel")
    fresnel.inputs["IOR"].default_value = 1.5
    carry(tree, principled.inputs["Clearcoat Roughness"], coat.inputs["Roughness"])
    carry(tree, principled.inputs["Clearcoat Normal"], coat.inputs["Normal"])
    carry(tree, principled.inputs["Clearcoat Normal"], fresnel.inputs["Normal"])
    share = node(tree, "ShaderNodeMath", operation="MULTIPLY")
    carry(tree, strength, share.inputs[0])
    tree.links.new(fresnel.outputs[0], share.inputs[1])
    return mixed(tree, share.outputs[0], base, coat.outputs[0])


def fewer_hairs(tree):
    """KHR_materials_sheen of roughness 0.8 in the mean over all directions.

    There the importer's velvet reflects 0.363 of a white sheen and glTF's Charlie term 0.223, which
    the base loses; the importer takes nothing from it.
    """
    for both in [n for n in tree.nodes if n.type == "ADD_SHADER"]:
        sources = [i.links[0].from_node for i in both.inputs if i.is_linked]
        for velvet in [n for n in sources if n.type == "BSDF_VELVET"]:
            sheen = velvet.inputs["Color"]
            if sheen.is_linked:
                continue
            strongest = max(sheen.default_value[:3])
            sheen.default_value = [0.223 / 0.363 * c for c in sheen.default_value[:3]] + [1]
            share = node(tree, "ShaderNodeValue").outputs[0]
            share.default_value = 0.223 * strongest
            base = [i for i in both.inputs if i.links[0].from_node != velvet][0]
            tree.links.new(dimmed(tree, share, base.links[0].from_socket), base)


def as_gltf_means(material, solid):
    """Rewires what the importer made of a material where Blender 3.4 means something else."""
    tree = material.node_tree
    for principled in [n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"]:
        principled.distribution = "MULTI_GGX"  # rough metals lose no light
        users = [link.to_socket for link in principled.outputs[0].links]
        plain = twin(tree, principled)
        unlink(tree, plain.inputs["Alpha"], 1)
        unlink(tree, plain.inputs["Clearcoat"], 0)
        # Glass without a volume is a thin sheet; Blender would refract as a solid.
        shader = plain.outputs[0] if solid else base_layer(tree, plain)
        shader = coated(tree, principled, shader)
        alpha = principled.inputs["Alpha"]
        if alpha.is_linked or alpha.default_value != 1:
            clear = node(tree, "ShaderNodeBsdfTransparent")
            shader = mixed(tree, alpha, clear.outputs[0], shader)
        for user in users:
            tree.links.new(shader, user)
    fewer_hairs(tree)


def solid_glass(path):
    """Names of the materials that glass fills."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] == b"glTF":
        data = data[20:20 + struct.unpack_from("<I", data, 12)[0]]
    return {m.get("name") for m in json.loads(data).get("materials", [])
            if {"KHR_materials_transmission", "KHR_materials_volume"} <= m.get("extensions", {}).keys()}


def read_without_animations():
    """The pose of the nodes, not the first instant of an animation, which the importer would set."""
    from io_scene_gltf2.io.imp.gltf2_io_gltf import glTFImporter
    read = glTFImporter.read

    def reads(importer):
        read(importer)
        importer.data.animations = []
    glTFImporter.read = reads


def set_floor(job):
    if job["floor"] is None:
        return
    size = 300 * job["radius"]
    corners = [(-size, -size, 0), (size, -size, 0), (size, size, 0), (-size, size, 0)]
    mesh = bpy.data.meshes.new("floor")
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new("floor")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    matte = node(tree, "ShaderNodeBsdfDiffuse")
    matte.inputs["Color"].default_value = (job["albedo"],) * 3 + (1,)
    tree.links.new(matte.outputs[0], node(tree, "ShaderNodeOutputMaterial").inputs[0])
    mesh.materials.append(material)
    floor = bpy.data.objects.new("floor", mesh)
    floor.location = blender_axes((job["camera"]["position"][0], job["floor"],
                                   job["camera"]["position"][2]))
    floor.visible_glossy = False
    floor.visible_shadow = floor.visible_diffuse = job["floor_gives_light"]
    bpy.context.collection.objects.link(floor)


def load(job):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=job["model"])
    for thing in list(bpy.context.scene.objects):
        if thing.type == "CAMERA":
            bpy.data.objects.remove(thing)
    if job["rewire"]:
        solid = solid_glass(job["model"])
        for material in bpy.data.materials:
            if material.use_nodes:
                as_gltf_means(material, material.name in solid)


def set_rendering(job):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.filepath = job["output"]
    scene.view_settings.view_transform = "Standard"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = job["samples"]
    cycles.seed = 0
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 12
    cycles.diffuse_bounces = job["diffuse_bounces"]
    cycles.transparent_max_bounces = 32
    scene.render.use_persistent_data = False


def main():
    with open(sys.argv[sys.argv.index("--") + 1], encoding="utf-8") as file:
        jobs = json.load(file)
    read_without_animations()
    for job in jobs:
        start = time.monotonic()
        load(job)
        set_camera(job)
        set_world(job)
        set_floor(job)
        set_rendering(job)
        bpy.ops.render.render(write_still=True)
        print(f"cycles_reference: {job['name']}: {time.monotonic() - start:.1f} s", flush=True)


main()
