# labs/cycles.py  3  renders a room with Cycles inside Blender, for peers.cpp
#
#   blender -b --python-exit-code 1 --python cycles.py -- ROOM.json SEED OUT
#
# Writes OUT.pfm, and OUT.seconds with the CPU seconds of the samples: those of a render with
# SPP + 1 samples less those of a render with one.  The difference excludes start-up and loading.
import array, json, sys, time

import bpy
from mathutils import Matrix

room_file, seed, out = sys.argv[sys.argv.index("--") + 1:]
room = json.load(open(room_file))
scale = 0.01  # Blender's unit is the metre, and it clips distant objects

bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene


# A diffuse material, f = albedo / pi, or an emitter with radiance on the normal's side only.
def material(albedo, radiance):
    made = bpy.data.materials.new("m")
    made.use_nodes = True
    nodes, join = made.node_tree.nodes, made.node_tree.links.new
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    if not any(radiance):
        diffuse = nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = (*albedo, 1)
        diffuse.inputs["Roughness"].default_value = 0
        join(diffuse.outputs[0], output.inputs["Surface"])
        return made
    side, mix = nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeMixShader")
    front, back = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeEmission")
    largest = max(radiance)
    front.inputs["Color"].default_value = (*[c / largest for c in radiance], 1)
    front.inputs["Strength"].default_value = largest
    back.inputs["Strength"].default_value = 0
    join(side.outputs["Backfacing"], mix.inputs[0])
    join(front.outputs[0], mix.inputs[1])
    join(back.outputs[0], mix.inputs[2])
    join(mix.outputs[0], output.inputs["Surface"])
    return made


def build():
    mesh = bpy.data.meshes.new("room")
    corners = [[c * scale for c in p] for face in room["faces"] for p in face["corners"]]
    mesh.from_pydata(corners, [], [tuple(range(i, i + 3)) for i in range(0, len(corners), 3)])
    for m in room["materials"]:
        mesh.materials.append(material(m["albedo"], m["radiance"]))
    for polygon, face in zip(mesh.polygons, room["faces"]):
        polygon.material_index = face["material"]
    scene.collection.objects.link(bpy.data.objects.new("room", mesh))

    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.lens_unit, camera.angle = "HORIZONTAL", "FOV", room["angle"]
    camera.clip_start, camera.clip_end = 0.001, 1000
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(scene.camera)
    eye, right, up, back = room["eye"], room["right"], room["up"], room["back"]
    rows = [[right[i], up[i], back[i], eye[i] * scale] for i in range(3)]
    scene.camera.matrix_world = Matrix(rows + [[0, 0, 0, 1]])

    scene.world = bpy.data.worlds.new("black")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0


# Sets up plain path tracing: box pixels, every light sampled.  Turns off denoising, adaptive
# sampling, clamping and blurring.
def settle():
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device, cycles.seed = "CYCLES", "CPU", int(seed)
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    bounces = room["depth"] - 1  # penumbra counts the light sample at the last vertex, too
    cycles.max_bounces = cycles.diffuse_bounces = bounces
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.blur_glossy = cycles.light_sampling_threshold = cycles.time_limit = 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1
    render.resolution_x, render.resolution_y = room["size"]
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", 1
    settings = render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    render.filepath, render.use_file_extension = out + ".exr", False


# CPU seconds of a render with this many samples.
def run(samples, keep=False):
    scene.cycles.samples = samples
    start = time.process_time()
    bpy.ops.render.render(write_still=keep)
    return time.process_time() - start


def write_pfm():
    image = bpy.data.images.load(out + ".exr")
    (w, h), n, numbers = image.size, image.channels, list(image.pixels[:])
    rgb = array.array("f", [numbers[i * n + c] for i in range(w * h) for c in range(3)])
    with open(out + ".pfm", "wb") as pfm:
        pfm.write(b"PF\n%d %d\n-1.0\n" % (w, h) + rgb.tobytes())


build()
settle()
run(1)  # loads and compiles what later runs reuse
one, all_and_one = run(1), run(room["samples"] + 1)
with open(out + ".seconds", "w") as seconds:
    seconds.write("%.6f\n" % (all_and_one - one))
run(room["samples"], keep=True)
write_pfm()
