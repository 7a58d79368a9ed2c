// labs/trade_page_test.cpp  the page in a browser: it shows the data by mouse and keys
#include "base/vec.h"
#include "labs/trade.h"
#include "text/browser.h"

using namespace trade;

namespace {

// ---- A small invented trade-off -----------------------------------------------------------------

// Every pixel, channel and image has another value; image 0 is a reference.
Image sample_image(int width, int height, int k) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float off = 0.01f * float(k * ((7 * x + 5 * y + 3 * k) % 11));
            image.at(x, y) = {0.05f + 0.06f * float(x) + off, 0.05f + 0.1f * float(y) - off / 2,
                              0.2f + off};
        }
    return image;
}

Choice choice(const std::string& command, std::vector<double> errors) {
    Choice c{{command, ""}};
    double spp = 4;
    for (double e : errors) c.points.push_back({spp, spp / 100, e}), spp *= 4;
    return c;
}

Study sample_study(const std::string& name, int width, int height) {
    Study s{name, 0.75, 0.004};
    s.choices = {choice("penumbra", {0.12, 0.06, 0.03}),
                 choice("penumbra --light nee", {0.1, 0.05, 0.02, 0.01}),
                 choice("penumbra-float <i>", {NAN, NAN, NAN})};
    for (int k = 0; k < 4; ++k)
        s.shots.push_back({text("shot %d", k), {1, 0.3, 0.01 * k}, sample_image(width, height, k)});
    s.shots[0] = {"the reference", {}, s.shots[0].image};
    s.shots[3].at.error = NAN;
    return s;
}

const std::vector<Study> sample = {sample_study("first", 12, 8), sample_study("second", 9, 7)};

// ---- A browser ----------------------------------------------------------------------------------

// The page of two small scenes, followed by a script, which waits for images.
void write_driven(const Folder& folder, const std::string& script, bool preview = false) {
    write_page(sample, "build/trade", preview, folder.path.string());
    folder.write("trade.html",
                 folder.read("trade.html") +
                     driven_by("while (!root.dataset.ready) await soon();\n"
                               "const choose = async name => { set(\"scene\", name); "
                               "do await soon(); while (root.dataset.ready !== name); };\n" +
                               script));
}

std::map<std::string, std::string> driven(const std::string& fragment, const std::string& script) {
    const Folder folder;
    write_driven(folder, script);
    auto seen = seen_in(browse(folder, "--dump-dom", "trade.html" + fragment));
    CHECK(seen["error"] == "");
    CHECK(seen["done"] == "1");
    return seen;
}

std::string bytes_of(const std::array<float, 3>& pixel, double exposure) {
    std::string words;
    for (float channel : pixel) words += std::to_string(to_byte(exposure * double(channel))) + ",";
    return words + "255";
}

double pixel_error(const Study& s, size_t k, int x, int y) {
    double sum = 0, norm = 0;
    for (const auto& pixel : s.shots[0].image.pixels)
        for (float channel : pixel) norm += std::pow(double(channel), 2);
    for (size_t c = 0; c < 3; ++c)
        sum += std::pow(double(s.shots[k].image.at(x, y)[c] - s.shots[0].image.at(x, y)[c]), 2);
    return std::sqrt(sum / norm * double(s.shots[0].image.pixels.size()));
}

}  // namespace

TEST_CASE("the page needs nothing but what lies beside it, and is short") {
    const std::string page = read_file("src/labs/trade.html");
    for (const char* outside : {"http", "//www", "@import", "url(", "fetch(", "import("}) {
        CHECK_MESSAGE(page.find(outside) == page.npos, outside);
        CHECK_MESSAGE(pair_viewer.find(outside) == pair_viewer.npos, outside);
    }
    CHECK(std::count(page.begin(), page.end(), '\n') <= 150);
    std::istringstream in(page);
    for (std::string line; std::getline(in, line);) CHECK_MESSAGE(line.size() <= 105, line);
}

TEST_CASE("answers are the measured ones, with their commands; what is not known is not ranked") {
    if (browser().empty()) return;
    auto seen = driven("", R"js(
const rows = (id, k) => [...$(id).querySelectorAll("table")[0].rows[k].cells]
    .map(c => c.textContent).join("|");
say("heads", rows("answers", 0));
say("answers", rows("answers", 1));
say("candidates", rows("candidates", 1));
say("preview", $("preview").hidden);
say("closed", $("scenes").textContent);
for (const details of document.querySelectorAll("details")) details.open = true;
await soon(300);
for (const k of [1, 2, 3]) say("rank" + k, rows("scenes", k));
say("command", document.querySelector("#scenes li").textContent);
say("curves", document.querySelector("#scenes img").src.match(/[^/]*$/));
say("bad", (document.body.innerText.match(/NaN|\bnan\b|null|undefined|Infinity/) || []).join());
say("markup", document.querySelectorAll("i").length);
)js");
    CHECK(seen["heads"] == "Scene|10 %|3 %|1 %|0.3 %");
    CHECK(seen["answers"] ==
          "first|0.04 s · 1.44×penumbra --light nee --spp 4|"
          "0.347 s · 1.85×penumbra --light nee --spp 35|"
          "2.56 s · –penumbra --light nee --spp 256|–");
    CHECK(seen["candidates"] == "penumbra --light nee|1|1|first");
    CHECK(seen["preview"] == "true");
    CHECK(seen["closed"] == "firstsecond");
    CHECK(seen["rank1"].starts_with("1|penumbra --light nee|0.04 s|0.347 s|2.56 s|–|256 "));
    CHECK(seen["rank2"] == "2|penumbra|0.0576 s|0.64 s|–|–|64 samples, 0.64 s: 3 %");
    CHECK(seen["rank3"] == "–|penumbra-float &lt;i&gt;|–|–|–|–|64 samples, 0.64 s: not known");
    CHECK(seen["command"] == "10 %: penumbra --light nee --spp 4 --size 12x8 scenes/first.scene");
    CHECK(seen["curves"] == "first.svg");
    CHECK(seen["bad"] == "");
    CHECK(seen["markup"] == "0");
}

TEST_CASE("a link leads to a scene, two images, a mode and a pixel; the values are that pixel's") {
    if (browser().empty()) return;
    auto seen = driven("#scene=second&a=1&b=3&mode=flip&at=5,2", R"js(
say("at", stage.dataset.at + " " + stage.dataset.mode);
say("chosen", ["scene", "a", "b"].map(id => $(id).selectedIndex));
for (const k of [0, 1, 2]) say("values" + k, cells(k).join(" "));
for (const who of ["a", "b"]) say(who, drawn(who, 5, 2)), say("corner" + who, drawn(who, 1, 6));
say("focus", document.activeElement.id);
say("names", $("name-a").textContent + "; " + $("image-b").ariaLabel);
)js");
    CHECK(seen["at"] == "5,2 flip");
    CHECK(seen["chosen"] == "1,1,3");
    CHECK(seen["focus"] == "compare");
    CHECK(seen["names"] == "A: shot 1: 0.3 s, error 1 %; B: shot 3: 0.3 s, error not known");
    const Study& s = sample[1];
    const size_t shown[] = {0, 1, 3};
    for (size_t k = 0; k < 3; ++k) {
        std::istringstream in(seen["values" + std::to_string(k)]);
        std::string name;
        double x[4] = {};
        in >> name >> x[0] >> x[1] >> x[2] >> x[3];
        for (size_t c = 0; c < 3; ++c)
            CHECK(x[c] ==
                  doctest::Approx(double(s.shots[shown[k]].image.at(5, 2)[c])).epsilon(0.006));
        CHECK(x[3] == doctest::Approx(100 * pixel_error(s, shown[k], 5, 2)).epsilon(0.006));
    }
    // The image is neither rotated nor mirrored.
    for (const auto& [who, k] : {std::pair{"a", 1}, {"b", 3}}) {
        CHECK(seen[who] == bytes_of(s.shots[size_t(k)].image.at(5, 2), 0.75));
        CHECK(seen[std::string("corner") + who] ==
              bytes_of(s.shots[size_t(k)].image.at(1, 6), 0.75));
    }
}

TEST_CASE("arrow keys move the examined pixel, no farther than the border") {
    if (browser().empty()) return;
    auto seen = driven("#scene=first&at=5,2", R"js(
key("ArrowRight"); say("right", stage.dataset.at);
key("ArrowDown"); say("down", stage.dataset.at);
key("ArrowLeft", true); say("left", stage.dataset.at);
key("ArrowUp"); say("up", stage.dataset.at);
key("ArrowDown", true); say("bottom", stage.dataset.at);
say("taken", !key("ArrowLeft"));
say("alone", key("a"));
await soon(1000);
say("live", $("live").textContent);
say("address", location.hash);
)js");
    CHECK(seen["right"] == "6,2");
    CHECK(seen["down"] == "6,3");
    CHECK(seen["left"] == "0,3");
    CHECK(seen["up"] == "0,2");
    CHECK(seen["bottom"] == "0,7");
    CHECK(seen["taken"] == "true");
    CHECK(seen["alone"] == "true");
    CHECK(seen["live"].starts_with("Pixel 0, 7: A is off by "));
    CHECK(seen["address"] ==
          "#scene=first&amp;at=0%2C7&amp;a=1&amp;b=2&amp;mode=slide&amp;exposure=0&amp;"
          "zoom=1");
}

TEST_CASE("the mouse picks a pixel; images flip by button and space bar") {
    if (browser().empty()) return;
    auto seen = driven("#scene=unheard-of&mode=flip", R"js(
say("mode", stage.dataset.mode);
const visible = () => ["a", "b"].map(who => getComputedStyle($("image-" + who)).visibility).join();
mouse(3.5 / 12, 6.5 / 8); say("at", stage.dataset.at);
set("mode", "flip"); say("one", visible());
$("flip").click(); await soon(); say("two", visible());
key(" "); await soon(); say("three", visible());
say("live", $("live").textContent);
)js");
    CHECK(seen["mode"] == "slide");  // unknown scene
    CHECK(seen["at"] == "3,6");
    CHECK(seen["one"] == "visible,hidden");
    CHECK(seen["two"] == "hidden,visible");
    CHECK(seen["three"] == "visible,hidden");
    CHECK(seen["live"].starts_with("Image A. "));
}

TEST_CASE("keys change mode, exposure and zoom, and ask for help; a mouse points into the zoom") {
    if (browser().empty()) return;
    auto seen = driven("#scene=first&a=1&b=2&at=2,1", R"js(
key("e"); key("e"); await soon(); say("bright", drawn("a", 5, 2));
key("E"); key("E"); key("E"); key("E"); await soon(); say("dark", drawn("a", 5, 2));
key("z"); key("z"); say("zoom", getComputedStyle(document.querySelector(".view")).transform);
mouse(9.5 / 12, 4.5 / 8); say("at", stage.dataset.at);
key("Z"); say("out", $("zoom").value);
key("m"); key("m"); key("m"); say("mode", stage.dataset.mode);
key("2"); say("two", stage.dataset.mode + stage.dataset.shown);
key("1"); say("one", stage.dataset.mode + stage.dataset.shown);
key("r"); key("2"); await soon(); say("reference", drawn("b", 5, 2));
key("r"); await soon(); say("again", drawn("b", 5, 2));
key("?"); say("help", $("help").open);
)js");
    CHECK(seen["bright"] == bytes_of(sample[0].shots[1].image.at(5, 2), 1.5));
    CHECK(seen["dark"] == bytes_of(sample[0].shots[1].image.at(5, 2), 0.375));
    CHECK(seen["zoom"] == "matrix(4, 0, 0, 4, 0, 0)");
    CHECK(seen["at"] == "9,4");
    CHECK(seen["out"] == "2");
    CHECK(seen["mode"] == "error");
    CHECK(seen["two"] + seen["one"] == "flipbflipa");
    CHECK(seen["reference"] == bytes_of(sample[0].shots[0].image.at(5, 2), 0.375));
    CHECK(seen["again"] == bytes_of(sample[0].shots[2].image.at(5, 2), 0.375));
    CHECK(seen["help"] == "true");
}

TEST_CASE("the wheel zooms about the pixel that it points at, and scrolls the page beyond") {
    if (browser().empty()) return;
    auto seen = driven("#scene=first&at=2,1", R"js(
const view = document.querySelector(".a .view"), frame = view.parentElement;
const box = frame.getBoundingClientRect();
const turn = (fx, fy, deltaY) => view.dispatchEvent(new WheelEvent("wheel", { deltaY,
    bubbles: true, cancelable: true, clientX: box.left + fx * box.width,
    clientY: box.top + fy * box.height }));
const seen_at = (fx, fy) => (view.dispatchEvent(new PointerEvent("pointermove", { bubbles: true,
    clientX: box.left + fx * box.width, clientY: box.top + fy * box.height })), stage.dataset.at);
say("taken", [!turn(.71, .31, 100), !turn(.71, .31, -200), !turn(.71, .31, -400)]);
say("zoom", $("zoom").value + " " + seen_at(.71, .31));
const before = seen_at(.2, .9);
turn(.2, .9, -100);
say("again", Math.round(100 * $("zoom").value) + " " + (seen_at(.2, .9) === before) + before);
say("out", [!turn(.2, .9, 9999), $("zoom").value]);
)js");
    CHECK(seen["taken"] == "false,true,true");
    CHECK(seen["zoom"] == "8 8,2");
    CHECK(seen["again"] == "1131 true7,3");
    CHECK(seen["out"] == "true,1");
}

TEST_CASE("error maps show each pixel's error, the worse the brighter; another scene has its own") {
    if (browser().empty()) return;
    auto seen = driven("#scene=first&a=0&b=2&mode=error&at=5,2", R"js(
say("map", drawn("b", 5, 2));
say("reference", drawn("a", 5, 2));
const light = e => colour_of(e).map((x, c) => [0.2126, 0.7152, 0.0722][c] *
    (Math.max(x, 0) / 255) ** 2.2).reduce((a, b) => a + b);
const steps = [...Array(17).keys()].map(k => light(10 ** (3 * k / 16 - 3)));
say("rising", steps.every((x, k) => k === 0 || x > steps[k - 1]));
say("ends", [0, 1e-3, NaN, 7].map(e => colour_of(e).map(Math.round)).join(" "));
await choose("second");
say("other", stage.dataset.at + " " + drawn("b", 4, 3));
location.hash = "#scene=second&a=99&b=-1&mode=magic&zoom=x&at=1e9";
await soon(300);
say("nonsense", stage.dataset.at + " " + stage.dataset.mode + " " + $("a").selectedIndex +
    $("b").selectedIndex);
)js");
    auto colour = [](const Study& s, int x, int y) {
        const double t = 1 + std::log10(pixel_error(s, 2, x, y)) / 3;
        const std::string grey = std::to_string(std::lround(255 * std::clamp(t, 0.0, 1.0))) + ",";
        return grey + grey + grey + "255";
    };
    CHECK(seen["map"] == colour(sample[0], 5, 2));
    CHECK(seen["reference"] == bytes_of(sample[0].shots[0].image.at(5, 2), 0.75));
    CHECK(seen["rising"] == "true");
    CHECK(seen["ends"] == "0,0,0 0,0,0 255,255,255 255,255,255");
    CHECK(seen["other"] == "4,3 " + colour(sample[1], 4, 3));
    CHECK(seen["nonsense"] == "8,0 error 30");
}

TEST_CASE(
    "on a telephone nothing is wider than the page but what can be scrolled; a preview says so") {
    if (browser().empty()) return;
    const Folder folder;
    write_driven(folder, "", true);
    folder.write("phone.html", R"html(<!doctype html><html><head></head><body>
<iframe id="phone" src="trade.html#scene=first" style="width: 380px; height: 800px"></iframe><script>
addEventListener("load", () => setTimeout(() => {
    const page = document.getElementById("phone").contentDocument, root = page.documentElement;
    const say = document.documentElement.dataset;
    say.wide = root.scrollWidth - root.clientWidth;
    say.inner = root.clientWidth <= 380;
    say.preview = !page.getElementById("preview").hidden;
    say.cut = [...page.querySelectorAll("body *")].filter(e => !e.closest(".scroll, svg, select") &&
        e.getBoundingClientRect().right > root.clientWidth + 1).map(e => e.tagName + e.id);
}, 1000));</script></body></html>)html");
    auto seen = seen_in(browse(folder, "--allow-file-access-from-files --dump-dom", "phone.html"));
    CHECK(seen["wide"] == "0");
    CHECK(seen["inner"] == "true");
    CHECK(seen["preview"] == "true");
    CHECK(seen["cut"] == "");
}
