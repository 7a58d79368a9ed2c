// labs/trade_script_test.cpp  the page in a browser: its script compares pictures as it says
//
// A test adds a script of its own to the page, which uses it as a reader would and writes what it
// saw into attributes of the root; Chromium prints the page as it then is.
#include <cstdlib>

#include "base/folder.h"
#include "labs/lab.h"
#include "labs/trade_sample.h"

namespace {

std::string browser() {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
        if (std::system(text("command -v %s >/dev/null 2>&1", name).c_str()) == 0) return name;
    MESSAGE("no Chromium on this machine (Debian: apt-get install chromium): not tested");
    return "";
}

// The page of two small scenes, followed by a script that may use these.
std::string with_driver(const std::string& script) {
    constexpr const char* tools = R"js(
const say = (name, value) => document.documentElement.setAttribute("data-" + name, value);
const key = (key, shiftKey) => stage.dispatchEvent(
    new KeyboardEvent("keydown", { key, shiftKey, bubbles: true, cancelable: true }));
const choose = (id, change) => {
    change(document.getElementById(id));
    document.getElementById(id).dispatchEvent(new Event("input", { bubbles: true }));
};
const show = value => document.querySelector(`[name=mode][value=${value}]`).click();
const pixel = (id, x, y) => document.getElementById(id).getContext("2d").getImageData(x, y, 1, 1).data;
const cells = row => [...document.querySelectorAll(`#row-${row} td`)].map(c => c.textContent);
)js";
    std::string page = trade_page(sample_trade());
    const std::string driver = std::string("<script>{") + tools +
                               "addEventListener(\"load\", () => {\n" + script + "}); }</script>";
    return page.replace(page.find("</body>"), 0, driver);
}

// What a browser prints to stdout, or an empty string if it does not come to an end.
std::string browse(const Folder& folder, const std::string& flags, const std::string& address) {
    const std::string command = text(
        "timeout 120 %s --headless=new --no-sandbox --disable-gpu --hide-scrollbars "
        "--allow-file-access-from-files --virtual-time-budget=4000 --user-data-dir='%s' %s "
        "'file://%s' >'%s' 2>/dev/null",
        browser(), folder / "profile", flags, folder / address, folder / "out");
    return std::system(command.c_str()) == 0 ? folder.read("out") : "";
}

// The root's attributes after the script.
Element driven(const std::string& fragment, const std::string& script) {
    const Folder folder;
    folder.write("page.html", with_driver(script));
    const std::string dom = browse(folder, "--dump-dom", "page.html" + fragment);
    REQUIRE(!dom.empty());
    const Element root = Html(dom).all("html")[0];
    CHECK(root.of("data-error") == "");
    CHECK(root.of("data-ready") == "yes");
    return root;
}

// As the script writes numbers of three digits, joined by blanks.
bool near(const std::string& shown, const std::array<float, 3>& pixel) {
    std::istringstream in(shown);
    const double largest = double(*std::max_element(pixel.begin(), pixel.end()));
    for (float channel : pixel) {
        double x = NAN;
        in >> x;
        // Both the reference and the difference are rounded; so are the digits.
        if (!(std::abs(x - double(channel)) <= 0.01 * largest)) return false;
    }
    return true;
}

std::string bytes_of(const std::array<float, 3>& pixel, double exposure) {
    std::string words;
    for (float channel : pixel) words += std::to_string(to_byte(exposure * double(channel))) + ",";
    return words + "255";
}

}  // namespace

TEST_CASE(
    "a link leads to a scene, two pictures, a mode and a pixel; the values are that pixel's") {
    if (browser().empty()) return;
    const Element root = driven("#scene=second&a=1&b=3&mode=wipe&wipe=30&at=5,2", R"js(
say("at", stage.dataset.at);
say("mode", stage.dataset.mode);
say("chosen", ["scene", "a", "b"].map(id => document.getElementById(id).selectedIndex));
for (const row of ["r", "a", "b"]) {
    say("values-" + row, cells(row).slice(0, 3).join(" "));
    say("error-" + row, cells(row)[3]);
    say("lens-" + row, pixel("lens-" + row, 72, 72));
    say("corner-" + row, pixel("lens-" + row, 8, 136));
}
say("clip", getComputedStyle(document.querySelector(".frame.b")).clipPath);
say("focus", document.activeElement.id);
)js");
    CHECK(root.of("data-at") == "5,2");
    CHECK(root.of("data-mode") == "wipe");
    CHECK(root.of("data-chosen") == "1,1,3");
    CHECK(root.of("data-clip") == "inset(0px 0px 0px 30%)");
    CHECK(root.of("data-focus") == "compare-title");
    const TradeScene scene = sample_trade().scenes[1];
    const Image* shown[] = {&scene.reference, &scene.pictures[0].image, &scene.pictures[2].image};
    for (size_t k = 0; k < 3; ++k) {
        const std::string row(1, "rab"[k]);
        CHECK(near(root.of("data-values-" + row), shown[k]->at(5, 2)));
        CHECK(root.of("data-lens-" + row) == bytes_of(shown[k]->at(5, 2), scene.exposure));
        // Four pixels to the left and below: the picture is neither turned nor mirrored.
        CHECK(root.of("data-corner-" + row) == bytes_of(shown[k]->at(1, 6), scene.exposure));
        const double error = pixel_error(scene.reference.at(5, 2), shown[k]->at(5, 2),
                                         quadratic_mean(scene.reference));
        if (k > 0)
            CHECK(std::stod(root.of("data-error-" + row)) ==
                  doctest::Approx(100 * error).epsilon(0.01));
    }
}

TEST_CASE("values have as many decimals as are known, and none a minus before zero") {
    if (browser().empty()) return;
    const Element root = driven("#scene=first&a=0&b=3&at=8,2", R"js(
say("reference", cells("a").join(" "));
say("dark", cells("b").slice(0, 3).join(" "));
say("ends", [digits([1e-7, 0, -1], 1), digits([-1e-9, 20, 99], 99), digits([12345, 1, 0], 12345),
             digits([0, 0, 0], 0)].join(" "));
)js");
    const TradeScene scene = sample_trade().scenes[0];
    CHECK(root.of("data-reference").ends_with(" 0 %"));
    CHECK(near(root.of("data-dark"), scene.pictures[2].image.at(8, 2)));
    CHECK(root.of("data-dark").ends_with(" 0.000"));
    CHECK(root.of("data-ends") ==
          "0.00,0.00,-1.00 0.0,20.0,99.0 1.23e+4,1.00e+0,0.00e+0 0.00e+0,0.00e+0,0.00e+0");
}

TEST_CASE("arrow keys move the examined pixel, no farther than the border") {
    if (browser().empty()) return;
    const Element root = driven("#scene=first&at=5,2", R"js(
key("ArrowRight"); say("right", stage.dataset.at);
key("ArrowDown"); say("down", stage.dataset.at);
key("ArrowLeft", true); say("far-left", stage.dataset.at);
key("ArrowUp"); say("up", stage.dataset.at);
key("ArrowDown", true); say("far-down", stage.dataset.at);
say("box", document.getElementById("x").value + "," + document.getElementById("y").value);
say("live", document.getElementById("live").textContent);
say("taken", !key("ArrowLeft"));
say("left-alone", key("a"));
choose("x", x => { x.value = 99; }); say("typed", stage.dataset.at);
setTimeout(() => say("address", location.hash), 1000);
)js");
    CHECK(root.of("data-right") == "6,2");
    CHECK(root.of("data-down") == "6,3");
    CHECK(root.of("data-far-left") == "0,3");
    CHECK(root.of("data-up") == "0,2");
    CHECK(root.of("data-far-down") == "0,7");
    CHECK(root.of("data-box") == "0,7");
    CHECK(root.of("data-live").starts_with("Pixel 0, 7: A is off by "));
    CHECK(root.of("data-taken") == "true");
    CHECK(root.of("data-left-alone") == "true");
    CHECK(root.of("data-typed") == "11,7");
    CHECK(root.of("data-address") == "#scene=first&a=1&b=2&mode=side&wipe=50&at=11%2C7");
}

TEST_CASE("the mouse picks a pixel, wipes where it is pressed, and flips by a button") {
    if (browser().empty()) return;
    const Element root = driven("#scene=unheard-of&mode=flip&at=0,0", R"js(
say("mode", stage.dataset.mode);
const seen = id => getComputedStyle(document.getElementById(id)).visibility;
const point = (fx, fy, buttons) => {
    const frame = document.querySelector(".frame.a"), box = frame.getBoundingClientRect();
    frame.dispatchEvent(new PointerEvent("pointermove", { bubbles: true, buttons,
        clientX: box.left + fx * box.width, clientY: box.top + fy * box.height }));
};
point(3.5 / 12, 6.5 / 8, 0); say("at", stage.dataset.at);
say("before", document.getElementById("wipe").value);
show("wipe"); point(0.25, 0.5, 1); say("after", document.getElementById("wipe").value);
show("flip"); say("first", seen("image-a") + " " + seen("image-b"));
document.getElementById("flip").click(); say("second", seen("image-a") + " " + seen("image-b"));
say("button", document.getElementById("flip").textContent);
key(" "); say("third", seen("image-a") + " " + seen("image-b"));
say("live", document.getElementById("live").textContent);
)js");
    CHECK(root.of("data-mode") == "side");  // nobody knows that scene
    CHECK(root.of("data-at") == "3,6");
    CHECK(root.of("data-before") == "50");
    CHECK(root.of("data-after") == "25");
    CHECK(root.of("data-first") == "visible hidden");
    CHECK(root.of("data-second") == "hidden visible");
    CHECK(root.of("data-button") == "Flip to A");
    CHECK(root.of("data-third") == "visible hidden");
    CHECK(root.of("data-live").starts_with("Picture A. "));
}

TEST_CASE("error maps are shown, and another scene has its own pictures") {
    if (browser().empty()) return;
    const Element root = driven("#scene=first&a=0&b=2&mode=error&at=5,2", R"js(
const image = document.getElementById("image-b"), figures = document.querySelectorAll(".shot");
say("map", image.src === figures[2].querySelector(".map").src);
say("alt", image.alt);
say("reference", document.getElementById("image-a").src === figures[0].querySelector("img").src);
say("lens", pixel("lens-b", 72, 72));
choose("scene", list => { list.selectedIndex = 1; });
say("other", stage.dataset.at);
say("most", document.getElementById("x").max + "," + document.getElementById("y").max);
location.hash = "#scene=second&a=99&b=-1&mode=magic&wipe=x&at=1e9";
setTimeout(() => say("nonsense", stage.dataset.at + " " + stage.dataset.mode + " " +
    document.getElementById("a").selectedIndex + document.getElementById("b").selectedIndex), 100);
)js");
    CHECK(root.of("data-map") == "true");
    CHECK(root.of("data-alt").starts_with("error map of first by --sampler halton --light nee"));
    CHECK(root.of("data-reference") == "true");
    const TradeScene scene = sample_trade().scenes[0];
    const Byte3 colour = error_colours()[size_t(
        error_level(pixel_error(scene.reference.at(5, 2), scene.pictures[1].image.at(5, 2),
                                quadratic_mean(scene.reference))))];
    CHECK(root.of("data-lens") == text("%d,%d,%d,255", colour[0], colour[1], colour[2]));
    CHECK(root.of("data-other") == "4,3");
    CHECK(root.of("data-most") == "8,6");
    CHECK(root.of("data-nonsense") == "8,0 error 30");
}

TEST_CASE("on a telephone nothing is wider than the page but what can be scrolled") {
    if (browser().empty()) return;
    const Folder folder;
    folder.write("page.html", with_driver(""));
    folder.write("phone.html", R"html(<!doctype html><html><head></head><body>
<iframe id="phone" src="page.html#scene=first" style="width: 380px; height: 800px"></iframe><script>
addEventListener("load", () => {
    const page = document.getElementById("phone").contentDocument, root = page.documentElement;
    document.documentElement.dataset.wide = root.scrollWidth - root.clientWidth;
    document.documentElement.dataset.inner = root.clientWidth;
    document.documentElement.dataset.cut = [...page.querySelectorAll("main *")].filter(e =>
        !e.closest(".scroll, svg, select") && e.getBoundingClientRect().right > root.clientWidth + 1)
        .map(e => e.tagName + e.id + e.className);
});</script></body></html>)html");
    const Element root = Html(browse(folder, "--dump-dom", "phone.html")).all("html")[0];
    CHECK(root.of("data-wide") == "0");
    CHECK(std::stoi(root.of("data-inner")) <= 380);
    CHECK(root.of("data-cut") == "");
}

TEST_CASE("each mode draws another page, and a page without pictures has no viewer") {
    if (browser().empty()) return;
    const Folder folder;
    Trade bare = sample_trade();
    for (TradeScene& scene : bare.scenes) scene.pictures.clear();
    folder.write("bare.html", trade_page(bare));
    const Element compare = Html(browse(folder, "--dump-dom", "bare.html")).by_id("compare");
    CHECK(compare.of("class") == "scripted");
    std::string page = trade_page(sample_trade());
    page.replace(page.find("</style>"), 0, "main > :not(#compare), header { display: none }");
    folder.write("page.html", page);
    std::set<std::string> drawn;
    for (const char* mode : {"side", "flip", "wipe", "error"}) {
        browse(folder, text("--window-size=900,700 --screenshot='%s'", folder / "drawn.png"),
               text("page.html#scene=first&a=1&b=2&mode=%s", mode));
        REQUIRE(folder.has("drawn.png"));
        const std::string png = folder.read("drawn.png");
        CHECK(png.substr(16, 8) == big_endian(900) + big_endian(700));
        drawn.insert(png);
        fs::remove(folder.path / "drawn.png");
    }
    CHECK(drawn.size() == 4);
}
