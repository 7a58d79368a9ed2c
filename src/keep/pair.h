// keep/pair.h  2  <image-pair>: two images in a page, with a slider between them
//
// A page has `pair_viewer` once, behind its pairs: without a server, by mouse, finger and keys.
#pragma once
#include <algorithm>

#include "film/image.h"
#include "text/json.h"

namespace penumbra {

inline std::string base64(std::string_view bytes) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t word = 0;
        for (size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k)
            out += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    return out;
}

// The floats of an image, linear, three per pixel, from the top left one on.
inline std::string base64(const Image& image) {
    return base64({reinterpret_cast<const char*>(image.pixels.data()),
                   image.pixels.size() * sizeof image.pixels[0]});
}

// What is shown as white: the value that 2 % of all pixels exceed, or six times the median, for a
// window may fill more; 1 if all is black.
inline double white_of(const Image& image) {
    std::vector<float> brightest;
    for (const auto& pixel : image.pixels)
        brightest.push_back(std::max({pixel[0], pixel[1], pixel[2]}));
    std::sort(brightest.begin(), brightest.end());
    const size_t n = brightest.size();
    const float white = std::min(brightest[n * 98 / 100], 6 * brightest[n / 2]);
    return white > 0 ? double(white) : 1;
}

// A piece of a page: A is an image, B its reference, of the same size.
struct ImagePair {
    const Image &image, &reference;
    std::string name, name_of_reference;
    std::array<int, 2> at;  // the first pixel that is examined
};
inline std::string html_of(const ImagePair& p) {
    std::string data =
        "{\"width\": " + std::to_string(p.image.width) +
        ", \"height\": " + std::to_string(p.image.height) +
        ", \"exposure\": " + json::number(1 / white_of(p.reference)) + ", \"at\": [" +
        std::to_string(p.at[0]) + ", " + std::to_string(p.at[1]) +
        "], \"a\": 1, \"b\": 0, \"images\": [\n{\"name\": " + json::string(p.name_of_reference) +
        ", \"pixels\": \"" + base64(p.reference) + "\"},\n{\"name\": " + json::string(p.name) +
        ", \"pixels\": \"" + base64(p.image) + "\"}]}";
    for (size_t at = 0; (at = data.find('<', at)) != data.npos;) data.replace(at, 1, "\\u003c");
    return "<image-pair><script type=\"application/json\">" + data + "</script></image-pair>\n";
}

inline constexpr std::string_view pair_viewer = R"html(<style>
image-pair { display: block; }
image-pair * { box-sizing: border-box; } image-pair [hidden] { display: none !important; }
image-pair .controls { display: flex; flex-wrap: wrap; gap: .6rem 1rem; align-items: end; }
image-pair .controls label { display: flex; flex-direction: column; max-width: 100%; }
image-pair .controls .wide { flex: 1 1 22rem; }
image-pair :is(select, button, input) { font: inherit; max-width: 100%; min-height: 2.1rem; }
image-pair input[type=number] { width: 5rem; } image-pair input[type=range] { width: 100%; margin: 0; }
image-pair canvas { display: block; width: 100%; image-rendering: pixelated; }
image-pair .stage { display: grid; grid-template-columns: 1fr 1fr; gap: .3rem .8rem; margin: 1rem 0 .5rem; user-select: none; }
image-pair .stage p { grid-row: 1; align-self: end; margin: 0; overflow-wrap: anywhere; }
image-pair .stage .b { grid-column: 2; } image-pair .stage [data-part=divide] { grid-area: 3 / 1 / auto / -1; }
image-pair .frame { grid-row: 2; overflow: hidden; touch-action: pan-y; cursor: crosshair; }
image-pair .view { position: relative; transform: scale(var(--zoom)); transform-origin:
    calc(100% * (var(--x) + .5) / var(--w)) calc(100% * (var(--y) + .5) / var(--h)); }
image-pair .view b { position: absolute; pointer-events: none; outline: calc(1px / var(--zoom)) solid #fff;
    box-shadow: 0 0 0 calc(2px / var(--zoom)) #000;
    left: calc(100% * var(--at-x) / var(--w)); top: calc(100% * var(--at-y) / var(--h));
    width: calc(100% / var(--w)); height: calc(100% / var(--h)); }
image-pair .scroll { overflow-x: auto; } image-pair caption { white-space: nowrap; text-align: left; }
@media screen {
    image-pair .stage:is([data-mode=slide], [data-mode=flip]) .frame, image-pair .stage[data-mode=flip] > p { grid-column: 1 / -1; }
    image-pair [data-mode=slide] p.b { text-align: right; }
    image-pair [data-mode=slide] .b.frame { clip-path: inset(0 0 0 var(--divide)); }
    image-pair [data-mode=slide]::after { content: ""; grid-area: 2 / 1 / auto / -1; z-index: 1; width: 2px;
        margin-left: calc(var(--divide) - 1px); background: #fff; box-shadow: 0 0 0 1px #000; pointer-events: none; }
    image-pair [data-mode=flip][data-shown=a] .b, image-pair [data-mode=flip][data-shown=b] .a { visibility: hidden; }
}
@media screen and (max-width: 40rem) { image-pair :is([data-mode=side], [data-mode=error]) { display: block; } }
@media print { image-pair :is(.controls, input, .view b, [data-part=live], [data-part=values]) { display: none; } }
</style>
<script>
"use strict";
// ---- Words and elements ----
function make(tag, members, ...children) {
    const element = Object.assign(document.createElement(tag), members);
    element.append(...children);
    return element;
}
const digits = x => x >= 1000 ? x.toFixed(0) : String(+x.toPrecision(3));
const percent = x => x === null ? "not known" : digits(100 * x) + " %";
function table(caption, heads, rows) {
    const line = (cells, scope) => make("tr", {}, ...cells.map((cell, k) =>
        make(k && scope === "row" ? "td" : "th", { scope }, cell)));
    return make("table", {}, make("caption", {}, caption),
        make("thead", {}, line(heads, "col")),
        make("tbody", {}, ...rows.map(cells => line(cells, "row"))));
}
function floats_of(base64) {
    const letters = atob(base64), bytes = new Uint8Array(letters.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = letters.charCodeAt(i);
    return new Float32Array(bytes.buffer);
}
const clamp = (x, least, most) => Math.min(Math.max(x || 0, least), most);
const within = (x, least, most) => clamp(Math.round(x), least, most);

// ---- Colours ----
const srgb = x => 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.min(x, 1) ** (1 / 2.4) - 0.055);
function colour_of(error) {  // black for 0.1 %, white for 100 %
    const t = error < 1e-3 ? 0 : error < 1 ? 1 + Math.log10(error) / 3 : 1;
    return [255 * t, 255 * t, 255 * t];
}

// ---- The viewer: all state is in the controls, `at`, `centre` of the zoom and `shown` ----
const pair_parts = `<form class="controls" onsubmit="return false">
<label>Show A and B <select data-part="mode"><option value="slide">with a slider</option><option value="side">side by side</option>
<option value="flip">flipped</option><option value="error">as error maps</option></select></label>
<label>Exposure, stops <input type="number" data-part="exposure" value="0" step="0.5"></label>
<label>Zoom <input type="number" data-part="zoom" value="1" min="1" max="32" step="any"></label>
<button type="button" data-part="flip" data-of="flip">Flip</button>
<button type="button" data-part="ask">? Keys</button>
<label class="wide">Image A <select data-part="a"></select></label>
<label class="wide">Image B <select data-part="b"></select></label>
</form>
<div class="stage" data-part="stage" tabindex="0" role="application" aria-label="Images A and B">
<p class="a" data-part="name-a"></p>
<div class="a frame"><div class="view"><canvas data-part="image-a" role="img"></canvas><b></b></div></div>
<p class="b" data-part="name-b"></p>
<div class="b frame"><div class="view"><canvas data-part="image-b" role="img"></canvas><b></b></div></div>
<input type="range" data-part="divide" data-of="slide" min="0" max="100" step="0.1" value="50"
aria-label="A is to the left of this, B to the right">
</div>
<p data-of="error">Black is an error of at most 0.1 %, white one of at least 100 %.</p>
<p data-part="live" aria-live="polite"></p>
<div data-part="values" class="scroll"></div>
<dialog data-part="help"><p>Arrows move the pixel, with Shift by ten.<br>Space flips A and B.<br>
1, 2: show A, B, flipped.<br>r: B is the reference, or the image it was.<br>m: next mode.<br>
e, E: brighter, darker.<br>z, Z: zoom in, out.<br>?: this; Escape closes it.</p>
<p>The mouse points at pixels, its wheel zooms; drag to move the slider.</p></dialog>`;

class ImagePair extends HTMLElement {
    at = { x: 0, y: 0 };
    centre = this.at;
    shown = "a";
    other = 0;  // B before r
    find(name) { return this.querySelector(`[data-part="${name}"]`); }
    value(name) { return this.find(name).value; }
    get modes() { return this.find("mode").options; }

    connectedCallback() {
        if (this.find("stage")) return;
        const data = this.querySelector("script");
        this.append(document.createRange().createContextualFragment(pair_parts));
        const stage = this.stage = this.find("stage"), only = document.querySelectorAll("image-pair").length === 1;
        this.addEventListener("input", event => {
            if (event.target === this.find("zoom")) this.centre = this.at;
            this.tell();
        });
        this.find("flip").addEventListener("click", () => { this.keys[" "](), this.show(); });
        this.find("ask").addEventListener("click", this.keys["?"]);
        (only ? document : this).addEventListener("keydown", event => this.press(event));
        for (const kind of ["pointermove", "pointerdown"]) stage.addEventListener(kind, event => this.point(event));
        stage.addEventListener("wheel", event => this.wheel(event), { passive: false });
        if (!data) return;
        const source = JSON.parse(data.textContent);
        for (const image of source.images) image.pixels = floats_of(image.pixels);
        this.load(source);
    }

    // {width, height, exposure, images: [{name, pixels}], a, b, at}: pixels are linear, three floats each; image 0 is the
    // reference; a and b are numbers of images.
    load(source) {
        const { width, height, images, at = [width >> 1, height >> 1] } = this.source = source;
        this.norm = Math.sqrt(images[0].pixels.reduce((sum, x) => sum + x * x, 0) / (3 * width * height)) || 1;
        for (const who of ["a", "b"]) {
            this.find(who).replaceChildren(...images.map(image => new Option(image.name)));
            this.find(who).selectedIndex = source[who];
            this.find(who).parentElement.hidden = images.length < 3;
            this.find("image-" + who).dataset.drawn = "";
        }
        this.at = this.centre = { x: at[0], y: at[1] }, this.other = 0;
        this.show();
    }
    pixel(k, i) { return [...this.source.images[k].pixels.subarray(3 * i, 3 * i + 3)]; }
    error(k, i) {
        return Math.hypot(...this.pixel(k, i).map((x, c) =>
            x - this.source.images[0].pixels[3 * i + c])) / Math.sqrt(3) / this.norm;  // RMS over channels
    }
    draw(canvas, k, as_error) {
        const factor = this.source.exposure * 2 ** this.value("exposure"), { pixels } = this.source.images[k];
        const { width, height } = Object.assign(canvas, { width: this.source.width, height: this.source.height });
        const pen = canvas.getContext("2d"), image = pen.createImageData(width, height);
        for (let i = 0; i < width * height; ++i) {
            const map = as_error && k ? colour_of(this.error(k, i)) : null;
            for (let c = 0; c < 3; ++c) image.data[4 * i + c] = map ? map[c] : srgb(factor * pixels[3 * i + c]);
            image.data[4 * i + 3] = 255;
        }
        pen.putImageData(image, 0, 0);
    }
    zoom(factor = 1) { return clamp(this.value("zoom") * factor, 1, 32); }

    show() {
        const { source, at, centre, shown } = this, mode = this.value("mode"), i = at.y * source.width + at.x;
        Object.assign(this.stage.dataset, { mode, shown, at: `${at.x},${at.y}` });
        Object.entries({ x: centre.x, y: centre.y, "at-x": at.x, "at-y": at.y, w: source.width,
            h: source.height, zoom: this.zoom(), divide: this.value("divide") + "%" })
            .forEach(([name, x]) => this.stage.style.setProperty("--" + name, x));
        for (const part of this.querySelectorAll("[data-of]")) part.hidden = part.dataset.of !== mode;
        const A = this.find("a").selectedIndex, B = this.find("b").selectedIndex;
        for (const [name, k] of [["A", A], ["B", B]]) {
            const who = name.toLowerCase(), canvas = this.find("image-" + who);
            const drawn = [k, mode === "error", this.value("exposure")].join();
            if (canvas.dataset.drawn !== drawn) this.draw(canvas, k, mode === "error");
            canvas.dataset.drawn = drawn;
            canvas.ariaLabel = this.find("name-" + who).textContent = `${name}: ${source.images[k].name}`;
        }
        this.find("values").replaceChildren(table("Linear values of the pixel; its error over the RMS of the reference",
            ["", "red", "green", "blue", "error"], [...(A && B ? [["reference", 0]] : []), ["A", A], ["B", B]].map(([name, k]) =>
                [name, ...this.pixel(k, i).map(x => x.toPrecision(3)), percent(this.error(k, i))])));
        this.find("live").textContent = (mode === "flip" ? `Image ${shown.toUpperCase()}. ` : "") +
            `Pixel ${at.x}, ${at.y}: A is off by ${percent(this.error(A, i))}, B by ${percent(this.error(B, i))}.`;
    }
    tell() {
        this.show();
        this.dispatchEvent(new Event("view"));
    }
    // What an address may hold of the view.
    get state() {
        return { at: `${this.at.x},${this.at.y}`, a: this.find("a").selectedIndex, b: this.find("b").selectedIndex,
            mode: this.value("mode"), exposure: this.value("exposure"), zoom: this.value("zoom") };
    }
    set state(asked) {
        for (const who of ["a", "b"]) if (who in asked)
            this.find(who).selectedIndex = within(asked[who], 0, this.source.images.length - 1);
        for (const option of this.modes) if (option.value === asked.mode) option.selected = true;
        for (const id of ["exposure", "zoom"]) if (id in asked && isFinite(asked[id])) this.find(id).value = asked[id];
        this.move(...(asked.at ? asked.at.split(",") : [this.at.x, this.at.y]));
    }
    move(x, y, follows = true) {  // keys move the zoom's centre, the mouse does not
        this.at = { x: within(x, 0, this.source.width - 1), y: within(y, 0, this.source.height - 1) };
        if (follows) this.centre = this.at;
        this.tell();
    }
    point(event) {
        const frame = event.target.closest(".frame"), view = frame?.firstElementChild.getBoundingClientRect();
        if (!frame) return;
        const { left, width } = frame.getBoundingClientRect();
        if (event.buttons) this.find("divide").value = 100 * (event.clientX - left) / width;
        this.move(Math.floor((event.clientX - view.left) / view.width * this.source.width),
            Math.floor((event.clientY - view.top) / view.height * this.source.height), false);
    }
    wheel(event) {  // keeps the pixel that is pointed at where it is
        const box = event.target.closest(".frame")?.getBoundingClientRect(), was = this.zoom();
        const z = this.zoom(2 ** (-event.deltaY / 200)), { width, height } = this.source;
        if (!box || z === was) return;
        event.preventDefault();
        this.point(event);
        const origin = (p, share, n) =>
            z > 1 ? clamp(((p + .5) * z - share * n) / (z - 1) - .5, 0, n - 1) : p;
        this.centre = { x: origin(this.at.x, (event.clientX - box.left) / box.width, width),
            y: origin(this.at.y, (event.clientY - box.top) / box.height, height) };
        this.find("zoom").value = z;
        this.move(this.at.x, this.at.y, false);
    }
    keys = {
        " ": () => { this.shown = this.shown === "a" ? "b" : "a"; },
        1: () => { this.find("mode").value = "flip", this.shown = "a"; },
        2: () => { this.find("mode").value = "flip", this.shown = "b"; },
        r: () => { [this.find("b").selectedIndex, this.other] = [this.other, this.find("b").selectedIndex]; },
        m: () => { this.find("mode").selectedIndex = (this.find("mode").selectedIndex + 1) % this.modes.length; },
        e: () => { this.find("exposure").value = +this.value("exposure") + 0.5; },
        E: () => { this.find("exposure").value -= 0.5; },
        z: () => { this.find("zoom").value = this.zoom(2); },
        Z: () => { this.find("zoom").value = this.zoom(0.5); },
        "?": () => this.find("help").showModal(),
    };
    press(event) {
        if (event.target.closest("input, select, button, summary, dialog") || event.ctrlKey || event.altKey || event.metaKey) return;
        const arrow = ["ArrowLeft", "ArrowUp", "ArrowRight", "ArrowDown"].indexOf(event.key);
        const far = (event.shiftKey ? 10 : 1) * (arrow < 2 ? -1 : 1);
        if ((arrow >= 0 || event.key === " ") && event.target !== this.stage) return;  // these scroll
        if (arrow >= 0) this.move(this.at.x + (arrow % 2 ? 0 : far), this.at.y + (arrow % 2 ? far : 0));
        else if (this.keys[event.key]) this.keys[event.key](), this.move(this.at.x, this.at.y);
        else return;
        event.preventDefault();
    }
}
customElements.define("image-pair", ImagePair);
</script>
)html";

}  // namespace penumbra
