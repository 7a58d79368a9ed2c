# from_blender.py  writes NAME.scene, NAME.obj and NAME.mtl: what Penumbra shows of a Blender file
#   blender -b FILE.blend --python-exit-code 1 --python scenes/from_blender.py -- out/NAME
import bpy, math, os, sys

out, scene = os.path.abspath(sys.argv[-1]), bpy.context.scene
numbers = lambda some: " ".join(f"{x:.9g}" for x in some)
at = lambda v: numbers((v[0], v[2], 0 - v[1]))  # y is up
columns = lambda thing: (column.xyz for column in thing.matrix_world.col)  # axes and place
warn = lambda what: print("from_blender: left out:", what, file=sys.stderr)

def mtl(material):
    node = material.use_nodes and material.node_tree.get_output_node("CYCLES")
    for link in node.inputs["Surface"].links if node else []: node = link.from_node
    kind, sockets = (node.type, node.inputs) if node else ("", [])
    if any(s.is_linked for s in sockets): warn(f"textures or mixed shaders of {material.name}")
    def value(name, default):  # some names are longer in Blender 4
        return next((s.default_value for s in sockets if s.name.startswith(name)), default)
    colour = value("Base Color", value("Color", material.diffuse_color))[:3]
    glow, strength = value("Emission", colour)[:3], value("Emission Strength", value("Strength", 0))
    metal, rough = value("Metallic", kind == "BSDF_GLOSSY"), value("Roughness", 1)
    gloss = 0.08 * value("Specular", 0)  # reflectance at normal incidence
    ns = (max(rough, 0.1) ** -4 - 1) / 2  # GGX's about the normal is four times that
    glass, mirror = value("Transmission", kind == "BSDF_GLASS") > 0.5, metal > 0.5 and rough < 0.05
    return (f"newmtl {material.name.replace(' ', '_')}\nNi {value('IOR', 1):.9g}\n"
            f"Kd {numbers(c * (1 - metal) * (1 - gloss) * (kind != 'EMISSION') for c in colour)}\n"
            f"Ks {numbers(c * metal + (1 - metal) * gloss for c in colour)}\nNs {ns:.9g}\n"
            f"Ke {numbers(c * strength for c in glow)}\nillum {7 if glass else 2 + mirror}\n")

# Cycles makes of P watts the radiance P / A: A is four times a flat area, (2 pi r)^2 for a sphere.
def lamp(name, data, x, y, z, place):
    if data.type == "AREA":
        u, v = x * data.size, y * (data.size if data.shape in ("SQUARE", "DISK") else data.size_y)
        A, shape = 4 * u.cross(v).length, f"quad {at(place - (u + v) / 2)}  {at(v)}  {at(u)}"
    elif data.type == "SUN":  # 10 km away; its P is watts per area
        sine = math.sin(max(data.angle, 0.001) / 2)
        A, shape = math.pi * sine ** 2, f"sphere {at(z * 1e4)}  {1e4 * sine:.9g}"
    else:
        r = max(data.shadow_soft_size, 0.001)
        A, shape = (2 * math.pi * r) ** 2, f"sphere {at(place)}  {r:.9g}"
    if data.type == "SPOT": warn(f"the cone of {name}")
    return f'light "{name}"  {numbers(c * data.energy / A for c in data.color)}\n{shape} "{name}"\n'

plain, render, camera = bpy.data.materials.new("no_material"), scene.render, scene.camera
for it in bpy.data.objects:
    if not getattr(it.data, "materials", [plain]): it.data.materials.append(plain)
    for slot in it.material_slots: slot.material = slot.material or plain
bpy.ops.wm.obj_export(filepath=out + ".obj", export_eval_mode="DAG_EVAL_RENDER")
open(out + ".mtl", "w").writelines(map(mtl, bpy.data.materials))
if scene.world: warn("the light of the world")
x, y, z, eye = columns(camera or sys.exit("from_blender: no camera"))
target = [e - b + 1e-5 * u for e, b, u in zip(eye, z, y)]  # even straight down, a little up
if abs(x.z) > 0.001 or camera.data.type != "PERSP": warn("the camera's roll or projection")
(_, top, near), (_, bottom, _) = camera.data.view_frame(scene=scene)[:2]
fov = 2 * math.degrees(math.atan2((top - bottom) / 2, -near))
size = [n * render.resolution_percentage // 100 for n in (render.resolution_x, render.resolution_y)]
with open(out + ".scene", "w") as file:
    file.write(f"size {numbers(size)}\ncamera {at(eye)}  {at(target)}  {fov:.9g}\n"
               f'mesh "{os.path.basename(out)}.obj"  1  0 0 0\n')
    file.writelines(lamp(it.name.replace('"', ""), it.data, *columns(it)) for it in
                    bpy.context.view_layer.objects if it.type == "LIGHT" and not it.hide_render)
