// whole/from_blender_test.cpp  scenes/from_blender.py: a Blender file and a scene written by hand
#include "course/python.h"
#include "text/scene_file.h"
#include "whole/process.h"
#include "world/geometry.h"

namespace {

// Things on a floor; z is up, and the camera looks along +y.
constexpr const char* make_room = R"py(
import bpy, math, sys
bpy.ops.wm.read_factory_settings(use_empty=True)
scene, mesh = bpy.context.scene, bpy.ops.mesh

def material(name, shader, **values):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    tree = made.node_tree
    node = tree.nodes.new(shader)
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    for key, value in values.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return made

def shape(name, material, scale=(1, 1, 1)):
    made = bpy.context.object
    made.name, made.scale = name, scale
    if material: made.data.materials.append(material)

def lamp(name, kind, place, turn=(0, 0, 0), **values):
    data = bpy.data.lights.new(name, kind)
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler = place, turn
    for key, value in values.items(): setattr(data, key, value)
    scene.collection.objects.link(made)
    return made

principled = "ShaderNodeBsdfPrincipled"
mesh.primitive_cube_add(size=2, location=(-3, 0, 1))
shape("a cube", material("red paint", principled, Base_Color=(1, 0.25, 0, 1),
                         Roughness=0.5, IOR=1.5), (-1, 1, 1))
mesh.primitive_uv_sphere_add(radius=1, segments=8, ring_count=4, location=(3, 0, 1))
shape("b ball", material("clear glass", "ShaderNodeBsdfGlass", IOR=1.5))
mesh.primitive_cube_add(size=2, location=(0, 4, 1))
shape("c mirror", material("mirror", principled, Metallic=1, Roughness=0, IOR=1.5,
                           Base_Color=(0.75, 0.5, 0.25, 1)))
mesh.primitive_plane_add(size=20)
shape("d floor", None)
bpy.context.object.data.materials.append(None)
mesh.primitive_cube_add(size=1, location=(0, 0, 0.5))
shape("e glow", material("glow", "ShaderNodeEmission", Color=(1, 0.5, 0, 1), Strength=2))
mesh.primitive_plane_add(size=2, location=(0, -4, 1))
shape("f plate", None)
mesh.primitive_cube_add(size=1)
shape("g hidden", None)
bpy.context.object.hide_render = True

lamp("Lamp #1", "POINT", (1, 2, 3), energy=100, color=(1, 0.5, 0.25), shadow_soft_size=0.25)
lamp("key light", "AREA", (0, 1, 4), (0, math.pi / 2, 0), energy=80, shape="RECTANGLE", size=1,
     size_y=2)
lamp("key_light", "SUN", (5, 5, 5), (0, math.pi / 2, 0), energy=3, angle=0.1)
lamp('a 5" spot', "SPOT", (-1, 2, 3), energy=10, shadow_soft_size=0.5)
lamp("a dark lamp", "POINT", (0, 0, 9)).hide_render = True

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.location, camera.rotation_euler = (1, -10, 2), (math.pi / 2, 0, 0)
camera.data.sensor_width, camera.data.lens = 36, 18
scene.collection.objects.link(camera)
scene.camera, render = camera, scene.render
render.resolution_x, render.resolution_y, render.resolution_percentage = 40, 20, 50
)py";

constexpr const char* make_high = R"py(
import bpy, sys
sys.argv[-1] = "high"
bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 20, 40
)py";

// What the script makes of the room, but for the glass ball.
constexpr const char* by_hand = R"(
size 20 10
camera 1 2 10  1 2 9  53.130102354
diffuse red_paint .96 .24 0
diffuse mirror 0 0 0
diffuse no_material .8 .8 .8
light glow 2 1 0
light "Lamp #1"  40.5284735 20.2642367 10.1321184
light "key light"  10 10 10
light key_light  382.2902 382.2902 382.2902
light "a 5 spot"  1.01321184 1.01321184 1.01321184
sphere 1 3 -2  .25  "Lamp #1"
quad 0 4.5 0  0 0 -2  0 -1 0  "key light"
sphere 10000 0 0  499.791693  key_light
sphere -1 3 -2  .5  "a 5 spot"
box 2 2 2  0  -4 0 -1  red_paint
box 2 2 2  0  -1 0 -5  mirror
quad -10 0 -10  0 0 20  20 0 0  no_material
quad -1 1 3  0 0 2  2 0 0  no_material
box 1 1 1  0  -.5 0 -.5  glow
)";

bool blender_to_be_had() {
    if (std::system("command -v blender >/dev/null") == 0) return true;
    MESSAGE("no blender on this machine (Debian: apt-get install blender): not tested");
    return false;
}

// The triangles of a material: their number, area, volume if they are closed and face outwards, and
// mean.
struct Sum {
    int count = 0;
    double area = 0, volume = 0;
    vec3 mean;
};
Sum sum_of(const NamedScene& s, const std::string& material) {
    Sum sum;
    for (size_t i = 0; i < s.shapes.size(); ++i) {
        const Shape& t = s.shapes[i];
        if (s.names[s.material_of[i]] != material) continue;
        const real area = length(area_vector(t)) / 2;
        sum.count += 1;
        sum.area += double(area);
        sum.volume += double(dot(t.a, cross(t.b, t.c))) / 6;
        sum.mean += (t.a + t.b + t.c) / 3 * area;
    }
    sum.mean = sum.mean / real(sum.area);
    return sum;
}

// By the names of their materials.
std::map<std::string, Light> lights_of(const NamedScene& s) {
    std::map<std::string, Light> lights;
    for (size_t i = 0; i < s.shapes.size(); ++i)
        if (s.light_of[i] != no_light)
            lights.insert_or_assign(s.names[s.material_of[i]], s.lights[size_t(s.light_of[i])]);
    return lights;
}

// Blender computes in float.
void check_near(vec3 a, vec3 b) { CHECK(double(length(a - b)) <= 2e-5 * (1 + double(length(b)))); }

void check_same(const Camera& a, const Camera& b) {
    check_near(a.eye, b.eye);
    check_near(a.forward, b.forward);
    check_near(a.right, b.right);
    CHECK(double(a.tan_half) == doctest::Approx(double(b.tan_half)).epsilon(1e-6));
}

void check_same(const Light& a, const Light& b) {
    CHECK(a.kind.index() == b.kind.index());
    CHECK(double(a.radius) == doctest::Approx(double(b.radius)).epsilon(1e-6));
    CHECK(a.twosided == b.twosided);
    REQUIRE(corners_of(a).size() == corners_of(b).size());
    for (size_t k = 0; k < corners_of(a).size(); ++k)
        check_near(corners_of(a)[k], corners_of(b)[k]);
    check_near(a.L, b.L);
}

}  // namespace

TEST_CASE("a Blender file as a scene: meshes, materials, camera and lamps") {
    if (!blender_to_be_had()) return;
    const Folder folder;
    folder.write("room.py", make_room);
    folder.write("high.py", make_high);
    folder.write("hand.scene", by_hand);
    const std::string script =
        " --python '" + fs::absolute("scenes/from_blender.py").string() + "'";
    const Printed printed =
        output_of("cd '" + folder.path.string() +
                  "' && blender -b --factory-startup --python-exit-code 1 --python room.py" +
                  script + " --python high.py" + script + " -- 'wide room'");
    INFO(printed.text);
    REQUIRE(printed.status == 0);
    CHECK(missing(printed.text, "from_blender: left out: the cone of a 5 spot") == "");

    CHECK(folder.read("wide room.mtl") ==
          "newmtl clear_glass\nNi 1.5\nKd 1 1 1\nKs 0 0 0\nNs 4999.5\nKe 0 0 0\nillum 7\n"
          "newmtl glow\nNi 1\nKd 0 0 0\nKs 0 0 0\nNs 0\nKe 2 1 0\nillum 2\n"
          "newmtl mirror\nNi 1.5\nKd 0 0 0\nKs 0.75 0.5 0.25\nNs 4999.5\nKe 0 0 0\nillum 3\n"
          "newmtl no_material\nNi 1\nKd 0.800000012 0.800000012 0.800000012\nKs 0 0 0\nNs 0\n"
          "Ke 0 0 0\nillum 2\n"
          "newmtl red_paint\nNi 1.5\nKd 0.96 0.24 0\nKs 0.04 0.04 0.04\nNs 7.5\nKe 0 0 0\n"
          "illum 2\n");

    const NamedScene wide = read_scene(folder / "wide room.scene").scene,
                     hand = read_scene(folder / "hand.scene").scene;
    CHECK(wide.size.width == hand.size.width);
    CHECK(wide.size.height == hand.size.height);
    check_same(wide.camera, hand.camera);
    for (const char* material : {"red_paint", "mirror", "no_material", "glow"}) {
        INFO(material);
        const Sum a = sum_of(wide, material), b = sum_of(hand, material);
        CHECK(a.count == b.count);
        CHECK(a.area == doctest::Approx(b.area).epsilon(1e-6));
        CHECK(a.volume == doctest::Approx(b.volume).epsilon(1e-6));
        check_near(a.mean, b.mean);
    }
    CHECK(sum_of(wide, "clear_glass").count == 8 * 2 * 3);
    check_near(sum_of(wide, "clear_glass").mean, {3, 1, 0});
    const auto lights = lights_of(wide), expected = lights_of(hand);
    CHECK(lights.size() == expected.size());
    for (const auto& [name, light] : expected) {
        INFO(name);
        REQUIRE(lights.contains(name));
        if (name != "glow") check_same(lights.at(name), light);
    }
    expect_success(folder, Words{"penumbra", "--spp", "2", "-o", "wide.png", "wide room.scene"});

    // The lens covers 36 mm of the longer side: 90 degrees.
    Camera high = hand.camera;
    high.tan_half = 1;
    check_same(read_scene(folder / "high.scene").scene.camera, high);
}
