// web/web.cpp  2  the renderer in a browser: a scene as text, passes of a film, and single paths
//
// A page has an instance for each of its workers.  One that keeps the film is its desk: workers add
// samples to blocks of their own films, the page copies the sums of these blocks into the desk's.
// A sample depends on its pixel and index alone, and the program's plan says how many there are:
// the picture has the same bits as the program's.
#ifdef __wasm_relaxed_simd__
#include <wasm_simd128.h>
// WebAssembly has no fma.  This instruction is one where the processor has it; elsewhere it may
// round twice: the page tests it, and takes the module that has fma in software (figure.js).
extern "C" inline double fma(double a, double b, double c) {
    return wasm_f64x2_extract_lane(
        wasm_f64x2_relaxed_madd(wasm_f64x2_splat(a), wasm_f64x2_splat(b), wasm_f64x2_splat(c)), 0);
}
extern "C" inline float fmaf(float a, float b, float c) {
    return wasm_f32x4_extract_lane(
        wasm_f32x4_relaxed_madd(wasm_f32x4_splat(a), wasm_f32x4_splat(b), wasm_f32x4_splat(c)), 0);
}
#endif

// That of this folder comes first: it declares what the system lacks.
#include "text/files.h"

#include "app/plan.h"
#include "replay/replay.h"

#define EXPORT(name) extern "C" [[clang::export_name(#name)]]
#define IMPORT(name) extern "C" [[clang::import_module("page"), clang::import_name(#name)]]

using namespace penumbra;
IMPORT(fail) void page_fail(const char* text, size_t size);      // the instance ends
IMPORT(answer) void page_answer(const char* text, size_t size);  // a text that a function returns

static std::string reading;  // what is read: it comes before an error's message

[[noreturn]] static void end_instance(const std::string& why) {
    page_fail(why.data(), why.size());
    __builtin_trap();
}

// -fignore-exceptions leaves out every `catch`; a `throw` of a std::exception calls these.
extern "C" {
void* __cxa_allocate_exception(size_t size) noexcept { return std::malloc(size); }
[[noreturn]] void __cxa_throw(void* thrown, void*, void* (*)(void*)) {
    end_instance(reading + static_cast<std::exception*>(thrown)->what());
}
}

namespace {

// ---- The figure of this instance ----------------------------------------------------------------

Options options;
ParsedScene parsed;
SamplerSettings settings;
std::optional<LightRecorder> recorder;
Plan plan;
Film film;
Image picture;

NamedScene& scene() { return parsed.scene; }

// The statements of a scene, as parse_scene reads them.
ParsedScene read_text(const std::string& text, const std::string& name) {
    SceneReader reader(std::filesystem::path(name).parent_path());
    read_lines(text, name, [&](std::string_view line, uint32_t number) {
        reading = name + ":" + std::to_string(number) + ": ";
        if (const Words words = words_before(line, '#'); !words.empty())
            reader.statement(words, number);
    });
    reading.clear();
    return reader.finish(name);
}

// Options in the words of the command line: those that change samples.
void read_options(const Words& words) {
    options = {};
    OptionTable table = without(option_table(options), {"-o", "--stats", "--time", "--error",
                                                        "--keep", "--rows", "--pixel", "--sample"});
    for (size_t i = 0; i < words.size(); ++i) {
        Option& option = row(table, words[i]);
        const bool has_value = !option.value.empty();
        if (has_value && i + 1 == words.size()) throw UserError(words[i] + ": needs a value");
        reading = words[i] + ": ";
        option.set(has_value ? words[++i] : "");
        reading.clear();
    }
}

rgb radiance(const PixelSample& which, Tally& tally) {
    const Start at = start(scene(), settings, which);
    const auto& of = options.view.of;
    if (of) return of({scene(), at, meet(scene(), at.ray), far_of(scene())});
    return Li(scene(), options.technique, at.ray, at.sampler, recorder->visitor(tally));
}

std::string taken_from(char* text, size_t size) {
    const std::string copy(text, size);
    std::free(text);
    return copy;
}

// ---- JSON ---------------------------------------------------------------------------------------

void answer(const std::string& text) { page_answer(text.data(), text.size()); }

std::string numbers(vec3 v) { return json::numbers({double(v.x), double(v.y), double(v.z)}); }

// An object whose members may be numbers and vectors.
struct Object : json::Object {
    void vectors(std::initializer_list<std::pair<const char*, vec3>> members) {
        for (const auto& [key, v] : members) add(key, numbers(v));
    }
    void scalars(std::initializer_list<std::pair<const char*, double>> members) {
        for (const auto& [key, x] : members) add(key, json::number(x));
    }
};

template <class Item, class Text>
std::string list(const std::vector<Item>& items, Text text) {
    std::string all;
    for (const Item& item : items) all += (all.empty() ? "" : ",") + text(item);
    return "[" + all + "]";
}

// Outlines for views of a scene: corners of flat shapes, or a centre and a radius.
std::string outline(const Shape& shape) {
    return ask(shape, [&](auto kind) {
        const auto corners = kind.corners(shape);
        if (corners.empty())
            return "[" + numbers(shape.a) + "," + json::number(double(shape.r)) + "]";
        return list(std::vector<vec3>(corners.begin(), corners.end()), numbers);
    });
}

std::string light_sample(const Vertex& x, const DirectLight& d) {
    Object o;
    o.add("kind", json::string(name_of(*d.light)));
    o.add("occluded", json::truth(d.occluded));
    o.vectors({{"at", d.sample.at.p}, {"wi", d.sample.wi}, {"Le", d.sample.L}, {"L", d.L}});
    o.vectors({{"f", eval(*x.material, x.wo, x.local.to_local(d.sample.wi))}});
    o.scalars({{"chosen", d.pdf / d.sample.pdf},
               {"cosine", d.cosine},
               {"pdf", d.pdf},
               {"weight", d.weight}});
    return o.text();
}

// One vertex: every number of the rendering equation there.
std::string vertex(const PathState& path, const VertexEvents& e) {
    Object o;
    o.scalars({{"k", path.k}});
    o.vectors({{"from", path.from}, {"direction", path.ray.d}, {"throughput", path.beta}});
    if (e.end != End::no) o.add("end", json::string(in_words(e.end)));
    if (!e.met) return o.text();
    const uint32_t shape = e.vertex.hit.id;
    o.add("material", json::string(scene().names[scene().material_of[shape]]));
    o.add("line", json::string(where(scene(), shape)));
    o.scalars({{"distance", e.vertex.hit.t}});
    o.vectors({{"p", e.vertex.at.p}, {"n", e.vertex.at.n}});
    if (e.vertex.material->emits()) {
        o.vectors({{"emission", e.Le}});
        o.scalars({{"weight", e.weight}});
    }
    if (e.direct.light) o.add("light", light_sample(e.vertex, e.direct));
    if (e.direct.unlit != Unlit::no) o.add("unlit", json::string(in_words(e.direct.unlit)));
    if (!(e.scattered.pdf > 0)) return o.text();
    o.vectors({{"wi", e.wi}, {"f", e.scattered.f}});
    o.scalars({{"cosine", std::abs(e.scattered.wi.z)}, {"pdf", e.scattered.pdf}});
    if (e.end == End::no) o.vectors({{"next", e.next.beta}});
    return o.text();
}

}  // namespace

// ---- Exports ------------------------------------------------------------------------------------

// 1: fma rounds once, (1 + e)(1 - e) - 1 = -e^2; else 0.
EXPORT(rounds_once) int rounds_once() {
    const volatile real e = ulp, a = 1 + 2 * e, b = 1 - 2 * e;
    return std::fma(real(a), real(b), real(-1)) == -4 * e * e;
}

// Memory for a text; who takes the text frees it.
EXPORT(room) char* room(size_t size) { return static_cast<char*>(std::malloc(size)); }

// A file that the scene may name.
EXPORT(give) void give(char* name, size_t name_size, char* bytes, size_t size) {
    std::string& file = files_of_page[plain_name(taken_from(name, name_size))];
    file = taken_from(bytes, size);
}

// Reads a scene's text under its name, with options as words; answers what the page must know.
EXPORT(load)
void load(char* text, size_t text_size, char* name, size_t name_size, char* words,
          size_t words_size) {
    const std::string called = taken_from(name, name_size);
    read_options(words_before(taken_from(words, words_size), '\0'));
    options.scene = called;
    parsed = with_options(read_text(taken_from(text, text_size), called), options);
    const NamedScene& s = scene();
    settings = sampler_settings(options.sampler, options.seed, s.depth);
    recorder.reset();
    if (!options.view.of) recorder.emplace(s, options.technique, 0, s.size.height, s.line_of_light);
    plan = plan_of(options, s, recorder ? &*recorder : nullptr);
    if (bytes_of(s.size, plan.replications) > 1e9)
        throw UserError("--size: a film of more than 1 GB");
    film = make_film(s.size, plan.replications, plan.is_adaptive);
    film.near = plan.near;
    Object o;
    o.scalars({{"width", s.size.width}, {"height", s.size.height}, {"exposure", s.exposure}});
    o.scalars({{"replications", plan.replications}, {"samples", plan.samples}});  // of weight 1
    o.scalars({{"block", film.block_size()}, {"blocks", film.blocks()}});
    o.add("warnings", list(parsed.warnings, json::string));
    const Camera& c = s.camera;
    o.vectors({{"eye", c.eye}, {"right", c.right}, {"up", c.up}, {"forward", c.forward}});
    o.scalars({{"tan_half", c.tan_half}});
    constexpr size_t max_outlines = 4000;
    o.add("shapes",
          list(s.shapes.size() > max_outlines ? std::vector<Shape>() : s.shapes, outline));
    answer(o.text());
}

// Adds samples to blocks first, first + step ... until each replication of weight 1 has n.
EXPORT(add) void add(size_t first, size_t step, double n) {
    Tally tally;
    tally.near.resize(film.near.size());
    for (size_t block = first; block < film.blocks(); block += step)
        add_samples(film, block, uint64_t(n), radiance, tally);
    for (size_t g = 0; g < film.near.size(); ++g) film.near[g].add(tally.near[g]);
    if (tally.bad == 0) return;
    const PixelSample& at = tally.first_bad;
    end_instance("a sample is not finite: --pixel " + std::to_string(at.x) + "," +
                 std::to_string(at.y) + " --sample " + std::to_string(at.i) + "," +
                 std::to_string(at.replication));
}

// All blocks have n: workers have added them, the page has copied their sums here.
EXPORT(took) void took(double n) { film.samples_done.assign(film.blocks(), uint64_t(n)); }

// Where the page reads and writes a film: sums of all replications, deviations of the pilot.
EXPORT(sums) double* sums() { return film.sum[0].data(); }
EXPORT(deviations) float* deviations() { return film.pilot_deviation.data(); }

// Near misses: the page moves their sums from workers to the desk.
EXPORT(near) NearMisses* near() { return film.near.data(); }
EXPORT(near_size) size_t near_size() { return film.near.size() * sizeof(NearMisses); }
EXPORT(add_near) void add_near(char* bytes, size_t size) {
    std::vector<NearMisses> more(film.near.size());
    std::memcpy(more.data(), taken_from(bytes, size).data(), std::min(size, near_size()));
    for (size_t g = 0; g < more.size(); ++g) film.near[g].add(more[g]);
}

// Samples of the pilot, after which weights are chosen; 0: they are, or need not be.
EXPORT(pilot) double pilot() { return film.is_pilot ? double(pilot_samples) : 0; }
EXPORT(choose) void choose() { choose_weights(film, plan.noisy); }

// Linear RGB, the top row first.
EXPORT(image) const float* image() {
    picture = image_of(film);
    return picture.pixels[0].data();
}

// Answers samples per pixel; d_rel, its standard error, and why it may be far too small.
EXPORT(error) void error() {
    const ImageError e = error_of(film);
    Object o;
    o.scalars({{"spp", film.samples_per_pixel()}});
    o.scalars({{"d_rel", e.d_rel()}, {"standard_error", e.standard_error()}});
    auto missed_light = [&] { return LightRecorder::why_unknown(film, e); };
    o.add("doubt", json::string(in_words(doubt_of(film, e, plan.may_miss_light), missed_light)));
    answer(o.text());
}

// Answers the path of a sample: its vertices, and what --pixel prints of it.
EXPORT(path) void path(int x, int y, double i, uint32_t set) {
    if (x < 0 || y < 0 || x >= film.size.width || y >= film.size.height)
        throw UserError("--pixel: outside the image");
    const Start at = start(scene(), settings, {x, y, uint64_t(i), set});
    char* printed = nullptr;
    size_t size = 0;
    std::FILE* out = open_memstream(&printed, &size);
    const PathLog log(scene(), out);
    log.film(at);
    std::vector<std::string> vertices;
    End why = End::no;
    const rgb L = Li(scene(), options.technique, at.ray, at.sampler,
                     [&](const PathState& path, const VertexEvents& e) {
                         log(path, e);
                         vertices.push_back(vertex(path, e));
                         why = e.end;
                     });
    log.end(in_words(why), L);
    std::fclose(out);
    Object o;
    o.vectors({{"L", L}});
    o.add("vertices", list(vertices, [](const std::string& text) { return text; }));
    o.add("printed", json::string(taken_from(printed, size)));
    answer(o.text());
}
