// labs/trade_script.h  1  what moves on the page of a trade: two pictures compared pixel by pixel
#pragma once

// All state is in the controls, the pixel `at` and which picture is `shown`; show() follows it.
// A page can be asked for by #scene=cornell&a=1&b=2&mode=wipe&wipe=40&at=12,7.
inline constexpr const char* trade_script = R"js("use strict";
const root = document.documentElement, $ = id => document.getElementById(id);
addEventListener("error", event => { root.dataset.error = event.message; });

const stage = $("stage"), modes = [...document.getElementsByName("mode")];
const scenes = [...document.querySelectorAll(".scene")].filter(s => s.querySelector(".shot"));
let at = { x: 0, y: 0 }, shown = "a", soon = 0;
const scene = () => scenes[$("scene").selectedIndex];
const shots = () => [...scene().querySelectorAll(".shot")];  // the reference, then pictures
const shot = who => shots()[who === "r" ? 0 : $(who).selectedIndex];
const mode = () => modes.find(m => m.checked).value;
const width = () => +scene().dataset.width, height = () => +scene().dataset.height;
const within = (x, most) => Math.min(Math.max(Math.round(x) || 0, 0), most);
const picture = who => (mode() === "error" && shot(who).querySelector(".map")) ||
    shot(who).querySelector(".picture");

// ---- Values: three mantissas of 9 bits with signs, and an exponent (pack_pixel) ----
function stored(figure) {  // four letters of base64 are three bytes
    const first = 4 * (at.y * width() + at.x), group = Math.floor(first / 3);
    const bytes = atob(figure.dataset.values.slice(4 * group, 4 * group + 8));
    const word = [3, 2, 1, 0].reduce((w, k) => w << 8 | bytes.charCodeAt(first - 3 * group + k), 0);
    return [23, 14, 5].map(left => (word << left >> 23) * 2 ** ((word >>> 27) - 27));
}
// Of a picture its difference to the reference is stored, over the reference's quadratic mean.
const error = who => shot(who) === shot("r") ? 0 : Math.hypot(...stored(shot(who))) / Math.sqrt(3);
const value = who => stored(shot(who)).map((x, c) =>
    (x + (shot(who) === shot("r") ? 0 : stored(shot("r"))[c])) * scene().dataset.mean);
// Three digits of the largest channel, and as many decimals of all: more is not stored.
function digits(values, largest) {
    if (!(largest > 1e-5 && largest < 1e4)) return values.map(x => x.toExponential(2));
    const decimals = Math.max(2 - Math.floor(Math.log10(largest)), 0);
    return values.map(x => (+x.toFixed(decimals) || 0).toFixed(decimals));  // and no -0
}
const percent = x => +(100 * x).toPrecision(3) + " %";

// ---- What is shown ----
function fill() {  // the lists of a scene's pictures
    for (const who of ["a", "b"]) {
        $(who).replaceChildren(...shots().map(figure => new Option(figure.dataset.name)));
        $(who).selectedIndex = Math.min(who === "a" ? 1 : 2, shots().length - 1);
    }
    at = { x: width() >> 1, y: height() >> 1 };
}
function enlarge(who) {  // nine pixels by nine, at in their middle
    const pen = $("lens-" + who).getContext("2d"), size = pen.canvas.width, side = size / 9;
    pen.imageSmoothingEnabled = false;
    pen.clearRect(0, 0, size, size);
    pen.drawImage(picture(who), at.x - 4, at.y - 4, 9, 9, 0, 0, size, size);
    for (const [colour, out] of [["black", 1.5], ["white", 0.5]]) {
        pen.strokeStyle = colour;
        pen.strokeRect(4 * side - out, 4 * side - out, side + 2 * out, side + 2 * out);
    }
}
function tell() {
    for (const who of ["r", "a", "b"]) {
        const cells = $("row-" + who).querySelectorAll("td");
        digits(value(who), Math.max(...[...value("r"), ...value(who)].map(Math.abs)))
            .forEach((word, c) => { cells[c].textContent = word; });
        cells[3].textContent = who === "r" ? "–" : percent(error(who));
    }
    $("live").textContent = (mode() === "flip" ? `Picture ${shown.toUpperCase()}. ` : "") +
        `Pixel ${at.x}, ${at.y}: A is off by ${percent(error("a"))}, B by ${percent(error("b"))}.`;
}
function link() {  // what leads here again, in the address: once nothing moves, browsers limit it
    const fragment = new URLSearchParams({ scene: scene().dataset.name, a: $("a").selectedIndex,
        b: $("b").selectedIndex, mode: mode(), wipe: $("wipe").value, at: `${at.x},${at.y}` });
    clearTimeout(soon);
    soon = setTimeout(() => history.replaceState(null, "", "#" + fragment), 500);
}
function show() {
    Object.assign(stage.dataset, { mode: mode(), shown, at: `${at.x},${at.y}` });
    const variables = { x: at.x, y: at.y, w: width(), h: height(), wipe: $("wipe").value };
    for (const name in variables) stage.style.setProperty("--" + name, variables[name]);
    for (const who of ["a", "b"]) {
        const image = $("image-" + who);
        if (image.src !== picture(who).src) image.src = picture(who).src;
        image.alt = picture(who).alt;
        $("name-" + who).lastElementChild.textContent = shot(who).dataset.name;
    }
    for (const who of ["r", "a", "b"]) enlarge(who);
    for (const [name, most] of [["x", width() - 1], ["y", height() - 1]]) {
        $(name).max = most;
        if (+$(name).value !== at[name]) $(name).value = at[name];
    }
    for (const part of $("compare").querySelectorAll("[data-of]"))
        part.hidden = part.dataset.of !== mode();
    $("flip").textContent = `Flip to ${shown === "a" ? "B" : "A"}`;
    tell();
}

// ---- What is asked for ----
function move(x, y) {
    at = { x: within(x, width() - 1), y: within(y, height() - 1) };
    show();
    link();
}
function flip() {
    shown = shown === "a" ? "b" : "a";
    show();
}
function follow() {  // the address
    const asked = new URLSearchParams(location.hash.slice(1));
    const known = scenes.findIndex(s => s.dataset.name === asked.get("scene"));
    if (known < 0) return;
    $("scene").selectedIndex = known;
    fill();
    for (const who of ["a", "b"])
        if (asked.has(who)) $(who).selectedIndex = within(asked.get(who), shots().length - 1);
    for (const m of modes) if (m.value === asked.get("mode")) m.checked = true;
    if (asked.has("wipe")) $("wipe").value = asked.get("wipe");
    if (asked.has("at")) [at.x, at.y] = asked.get("at").split(",");
    at = { x: within(at.x, width() - 1), y: within(at.y, height() - 1) };
    show();
    $("compare").scrollIntoView();
    $("compare-title").focus({ preventScroll: true });
}
function point(event) {
    const frame = event.target.closest(".frame");
    if (!frame) return;
    const box = frame.getBoundingClientRect(), part = (event.clientX - box.left) / box.width;
    if (mode() === "wipe" && event.buttons) $("wipe").value = 100 * part;
    move(Math.floor(part * width()), Math.floor((event.clientY - box.top) / box.height * height()));
}
function press(event) {
    const arrow = ["ArrowLeft", "ArrowUp", "ArrowRight", "ArrowDown"].indexOf(event.key);
    const far = (event.shiftKey ? 10 : 1) * (arrow < 2 ? -1 : 1);
    if (arrow >= 0) move(at.x + (arrow % 2 ? 0 : far), at.y + (arrow % 2 ? far : 0));
    else if (mode() === "flip" && [" ", "Enter"].includes(event.key)) flip();
    else return;
    event.preventDefault();
}
addEventListener("load", () => {
    if (scenes.length === 0) return;
    $("scene").replaceChildren(...scenes.map(s => new Option(s.dataset.name)));
    root.classList.add("scripted");
    fill();
    show();
    follow();
    $("controls").addEventListener("input", event => {
        if (event.target === $("scene")) fill();
        move(...(event.target.type === "number" ? [$("x").value, $("y").value] : [at.x, at.y]));
    });
    $("flip").addEventListener("click", flip);
    stage.addEventListener("keydown", press);
    for (const kind of ["pointermove", "pointerdown"]) stage.addEventListener(kind, point);
    addEventListener("hashchange", follow);
    root.dataset.ready = "yes";
});
)js";
