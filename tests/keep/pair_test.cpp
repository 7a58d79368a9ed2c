// keep/pair_test.cpp  two images in a page, operated in a browser by mouse, finger and keys
#include "keep/pair.h"

#include "text/browser.h"
#include "text/image_file.h"

namespace {

// Every pixel and channel has another value.
Image sample_image(float off) {
    Image image(8, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            image.at(x, y) = {0.1f * float(x) + off, 0.2f * float(y), 0.3f + off * float(x + y)};
    return image;
}

const Image reference = sample_image(0), image = sample_image(0.25f);
const std::string page = html_of({image, reference, "</script> & \"it\"", "truth", {3, 1}});

std::map<std::string, std::string> driven(const std::string& pairs, const std::string& script) {
    const Folder folder;
    folder.write("page.html", "<!doctype html><html><head></head><body>" + pairs +
                                  std::string(pair_viewer) + driven_by(script));
    auto seen = seen_in(browse(folder, "--dump-dom", "page.html"));
    CHECK(seen["error"] == "");
    CHECK(seen["done"] == "1");
    return seen;
}

// A pixel as the browser shows it, where 2 % of the reference are white.
std::string bytes_of(const std::array<float, 3>& pixel, double stops = 0) {
    std::string words;
    for (float channel : pixel)
        words +=
            std::to_string(to_byte(std::exp2(stops) / white_of(reference) * double(channel))) + ",";
    return words + "255";
}

}  // namespace

TEST_CASE("a page has all bits of both images, the image is A, and any name is text") {
    CHECK(page.find(base64(image)) != page.npos);
    CHECK(page.find("</script>") == page.rfind("</script>"));
    if (browser().empty()) return;
    auto seen = driven(page, R"js(
say("floats", pair.source.images.map(image => [...image.pixels].join(" ")).join(" "));
say("names", $("name-a").textContent + "|" + $("name-b").textContent);
say("at", stage.dataset.at + " " + cells(0)[0] + cells(1)[0]);
say("red", cells(0)[1] + " " + cells(1)[1]);
for (const who of ["a", "b"]) say(who, drawn(who, 5, 2));
say("choices", $("a").parentElement.hidden);
)js");
    std::istringstream in(seen["floats"]);
    for (const Image& shown : {reference, image})
        for (const auto& pixel : shown.pixels)
            for (double x, channel = 0; channel < 3; ++channel)
                CHECK(((in >> x) && float(x) == pixel[size_t(channel)]));
    CHECK(seen["names"] == "A: &lt;/script&gt; &amp; &quot;it&quot;|B: truth");
    CHECK(seen["at"] == "3,1 AB");
    CHECK(seen["red"] == "0.550 0.300");
    CHECK(seen["a"] == bytes_of(image.at(5, 2)));
    CHECK(seen["b"] == bytes_of(reference.at(5, 2)));
    CHECK(seen["choices"] == "true");
}

TEST_CASE("a slider divides the images: by its control, and by dragging, but not by pointing") {
    if (browser().empty()) return;
    auto seen = driven(page, R"js(
const frames = [...stage.querySelectorAll(".frame")].map(f => f.getBoundingClientRect());
say("same", frames[0].left === frames[1].left && frames[0].width === frames[1].width);
const whose = x => document.elementFromPoint(frames[0].left + x * frames[0].width, frames[0].top + 9).closest(".frame").className[0];
const sides = () => [.1, .4, .6, .9].map(whose).join("");
say("half", sides() + stage.dataset.mode);
set("divide", 25); say("quarter", sides());
mouse(.8, .5); say("pointed", sides() + $("divide").value + " " + stage.dataset.at);
mouse(.8, .5, 1); say("dragged", sides() + Math.round($("divide").value));
set("mode", "side"); say("side", getComputedStyle($("divide")).display + sides());
set("mode", "error"); say("black", drawn("b", 0, 0)); say("map", drawn("a", 0, 0));
)js");
    CHECK(seen["same"] == "true");
    CHECK(seen["half"] == "aabbslide");
    CHECK(seen["quarter"] == "abbb");
    CHECK(seen["pointed"] == "abbb25 6,2");
    CHECK(seen["dragged"] == "aaab80");
    CHECK(seen["side"] == "noneaabb");
    CHECK(seen["black"] == bytes_of(reference.at(0, 0)));  // the reference is itself
    CHECK(seen["map"] != bytes_of(image.at(0, 0)));
}

TEST_CASE("keys go to the pair that has the focus") {
    if (browser().empty()) return;
    auto seen = driven(page + page, R"js(
const all = [...document.querySelectorAll("image-pair")], places = () => all.map(p => p.stage.dataset.at).join(" ");
key("ArrowRight"); say("first", places());
all[1].stage.dispatchEvent(new KeyboardEvent("keydown", { key: "e", bubbles: true, cancelable: true }));
say("stops", all.map(p => p.find("exposure").value).join(" "));
say("bright", all[1].find("image-a").getContext("2d").getImageData(1, 0, 1, 1).data);
)js");
    CHECK(seen["first"] == "4,1 3,1");
    CHECK(seen["stops"] == "0 0.5");
    CHECK(seen["bright"] == bytes_of(image.at(1, 0), 0.5));
}

TEST_CASE("white is what a fiftieth exceeds, six medians at most, and 1 where all is black") {
    Image flat(10, 10);
    flat.pixels.assign(100, {0.5f, 0.25f, 0});
    CHECK(white_of(flat) == 0.5);
    flat.pixels[7] = flat.pixels[70] = {0, 9, 0};
    CHECK(white_of(flat) == 3);
    flat.pixels.assign(100, {0, 0, 0});
    CHECK(white_of(flat) == 1);
}

TEST_CASE("base64 as in RFC 4648, section 10") {
    CHECK(base64("") == "");
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foo") == "Zm9v");
    CHECK(base64("foob") == "Zm9vYg==");
    CHECK(base64("fooba") == "Zm9vYmE=");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(base64("\xff\xfe\x80") == "//6A");
}
