// whole/show_program_test.cpp  --show: pictures of a render that goes on, and the page in a browser
#include <thread>

#include "show/show.h"
#include "text/browser.h"
#include "text/png.h"
#include "whole/process.h"

namespace {

// Waits until this holds, for a minute at most.
template <class Holds>
bool soon(Holds holds) {
    for (int i = 0; i < 600 && !holds(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return holds();
}

}  // namespace

TEST_CASE("--show changes no bit of the pictures, and leaves a page that says done") {
    const Place place(good);
    const std::string options = "--size 64x48 --spp 64 --replications 2 --stats a.json ";
    place.render(options + "-o a.pfm -o a.png");
    CHECK(place.files() == 4);
    const Outcome o = place.render(options + "-o b.pfm -o b.png --show");
    INFO(o.err);
    CHECK(place.same("b.pfm", "a.pfm"));
    CHECK(place.same("b.png", "a.png"));
    CHECK(contains(o.err, "open b.html in a browser\n"));
    CHECK(place.read("b.html") == show_page);
    const std::string told = place.read("b.html.js");
    INFO(told);
    CHECK(contains(told, "\"done\", true, \"file.scene: 64 samples per pixel, "));
    CHECK(place.files() == 8);
    place.render("--show --quiet --spp 1 --view depth");  // a page for the default name
    CHECK(place.has("out/file-depth.html"));
    CHECK(place.render("--show --quiet --spp 1 --view depth").err == "");  // again
}

TEST_CASE("pictures are there while it renders; Ctrl-C leaves a page that says so") {
    const Place place(good);
    Process process(place,
                    "penumbra --show --time 1000 -o a.png -o a.pfm --stats a.json file.scene");
    const bool shown = soon([&] {
        return place.has("a.html.js") && contains(place.read("a.html.js"), "\"rendering\", true, ");
    });
    CHECK(shown);
    CHECK(decode_png(place.read("a.png")).width == 8);
    CHECK_FALSE(place.has("a.pfm"));
    CHECK_FALSE(place.has("a.json"));
    process.interrupt();
    const Outcome o = process.finish();
    INFO(o.err);
    CHECK(o.status == 130);
    CHECK(place.has("a.pfm"));
    const std::string told = place.read("a.html.js");
    CHECK(contains(told, "\"stopped\", true, "));
    CHECK(told.ends_with(" (interrupted)\");\n"));
}

TEST_CASE("--show without a PNG, or in the place of another page, is refused before the render") {
    const Place place(good);
    place.write("b.html", "<p>mine");
    expect_refusal(place, "penumbra --show -o a.pfm file.scene", "--show: needs -o FILE.png\n");
    expect_refusal(place, "penumbra --show -o b.png file.scene",
                   "b.html: --show would replace a page that is not its own\n");
}

TEST_CASE("in a browser the page shows what it is told, and asks again") {
    if (browser().empty()) return;
    const Folder folder;
    const std::string page = "a #1's.html";  // a name that addresses do not have as it is
    folder.write(page, std::string(show_page));
    Image image(2, 1);
    write_image(folder / "a #1's.png", image, 1);
    // What it is told changes each time that it asks.
    folder.write(
        page + ".js",
        "globalThis.n = (globalThis.n ?? 0) + 1;\n"
        "if (n === 3) document.body.dataset.before = document.querySelector('h1').className;\n"
        "now(n, n < 3 ? 'rendering' : 'done', n > 1, n < 3 ? 'soon' : '<i>3</i> & \"4\"');\n");
    const std::string dom = browse(folder, "--dump-dom", "a%20%231%27s.html");
    INFO(dom);
    for (const char* part : {"<h1 class=\"done\">done, ", "<p>&lt;i&gt;3&lt;/i&gt; &amp; \"4\"</p>",
                             "a%20%231%27s.png?", "data-before=\"rendering\""}) {
        INFO(part);
        CHECK(contains(dom, part));
    }
    CHECK_FALSE(contains(dom, "hidden=\"\""));
}
