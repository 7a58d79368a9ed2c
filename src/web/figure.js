// web/figure.js  4  <live-figure>: a picture that renders itself, its error, and the paths of its pixels
//
// <live-figure scene="cornell" technique="--light nee" against="--light none" samples="256">STILL PICTURE</live-figure>
//   scene       a name of penumbra.scenes, or none: its text is set as figure.text
//   technique   options of build/penumbra; against: those of a second picture, beside a slider
//   samples     per pixel, then it stops; size: WIDTHxHEIGHT; pixel: X,Y: the path of this pixel is open
// Nothing is loaded before the figure is seen.  Where WebAssembly or JavaScript is missing, the still picture stays.
"use strict";

// ---- The module, unpacked once ------------------------------------------------------------------

// The first of the modules that this browser accepts, and whose fma rounds once on this processor.
const renderer_module = (() => {
    let made;
    const choose = async () => {
        for (const [name, packed] of Object.entries(penumbra.modules)) {
            const bytes = Uint8Array.from(atob(packed), letter => letter.charCodeAt(0));
            const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
            const code = await new Response(plain).arrayBuffer();
            if (!WebAssembly.validate(code)) continue;
            const module = await WebAssembly.compile(code);
            if (!(await Renderer.of(module)).calls.rounds_once()) continue;
            penumbra.chosen = name;
            return module;
        }
        throw Error("this browser runs no WebAssembly of 128-bit vectors");
    };
    return () => made ??= choose();
})();

// ---- Workers, which all figures share -----------------------------------------------------------

// The program of a worker.  It has an instance for each picture, which an error ends.
function work() {
    const renderers = new Map();
    let module;
    const acts = {
        start: message => { module = message.module; },
        load: async ({ id, scene }) => {
            const renderer = await Renderer.of(module);
            renderer.load(scene);
            renderers.set(id, renderer);
        },
        add: ({ id, n, first, step }) => {
            const begin = performance.now(), renderer = renderers.get(id);
            renderer.add(n, first, step);
            return { ...renderer.packed(first, step), seconds: (performance.now() - begin) / 1000 };
        },
        choose: ({ id, deviations }) => {
            renderers.get(id).deviations.set(deviations);
            renderers.get(id).choose();
        },
        drop: ({ id }) => { renderers.delete(id); },
    };
    onmessage = async ({ data }) => {
        try {
            postMessage({ call: data.call, result: await acts[data.act](data) });
        } catch (error) {
            renderers.delete(data.id);
            postMessage({ call: data.call, error: error.message });
        }
    };
}

const workers = {
    all: [],
    waiting: new Map(),
    calls: 0,
    async start() {
        if (this.all.length) return;
        const module = await renderer_module();
        if (this.all.length) return;
        const source = URL.createObjectURL(new Blob([`"use strict";${Renderer};(${work})()`], { type: "text/javascript" }));
        for (let k = 0; k < Math.min(64, navigator.hardwareConcurrency || 2); ++k) {
            const worker = new Worker(source);
            worker.onmessage = ({ data: { call, result, error } }) => {
                const { resolve, reject } = this.waiting.get(call);
                this.waiting.delete(call);
                error === undefined ? resolve(result) : reject(Error(error));
            };
            this.all.push(worker);
        }
        await this.ask({ act: "start", module });
    },
    // Sends a message to all workers, with the blocks of each, and waits for all results.
    ask(message) {
        return Promise.all(this.all.map((worker, first) => new Promise((resolve, reject) => {
            const call = ++this.calls;
            this.waiting.set(call, { resolve, reject });
            worker.postMessage({ ...message, call, first, step: this.all.length });
        })));
    },
};

// ---- One picture --------------------------------------------------------------------------------

// Its desk, an instance in the page, has the whole film; workers add samples to their blocks.
class Side {
    static ids = 0;
    id = ++Side.ids;
    seconds = 0;     // of all workers together
    curve = [];      // [samples per pixel, d_rel, true error], by passes
    error = null;

    constructor(options) { this.options = options; }

    async load(scene) {
        this.scene = { ...scene, options: this.options };
        this.desk = await Renderer.of(await renderer_module());
        this.info = this.desk.load(this.scene);  // an error is told before any worker begins
        this.limit = this.info.samples;
        await workers.ask({ act: "load", id: this.id, scene: this.scene });
    }

    get is_done() { return !this.desk.is_pilot && this.desk.n >= this.limit; }
    get samples() { return this.error?.spp ?? 0; }

    // The picture does not depend on where passes end; those of the pilot end at every sample.
    async pass(reference) {
        const { desk, id } = this;
        const quick = this.last ? Math.floor(0.2 / this.last.seconds * this.last.samples) : 1;
        const n = desk.is_pilot ? desk.n + 1 : Math.min(this.limit, desk.n + Math.max(1, Math.min(quick, desk.n + 1)));
        const begin = performance.now(), before = desk.n;
        const taken = await workers.ask({ act: "add", id, n });
        if (this.is_dropped) return;
        for (const part of taken) {
            desk.put(part);
            this.seconds += part.seconds;
        }
        desk.took(n);
        this.last = desk.is_pilot ? null : { seconds: (performance.now() - begin) / 1000, samples: n - before };
        this.error = desk.error;
        this.image = desk.image.slice();
        if (desk.is_pilot_done) {
            const deviations = desk.deviations.slice();
            await workers.ask({ act: "choose", id, deviations });
            if (!this.is_dropped) desk.choose();
        }
        if (this.samples > (this.curve.at(-1)?.[0] ?? 0) * 1.05)
            this.curve.push([this.samples, this.error.d_rel, reference && true_error(this.image, reference)]);
    }

    drop() {
        this.is_dropped = true;
        if (workers.all.length) workers.ask({ act: "drop", id: this.id });
    }
}

// |f - F| / |F|
function true_error(image, reference) {
    let difference = 0, norm = 0;
    for (let i = 0; i < image.length; ++i) {
        difference += (image[i] - reference[i]) ** 2;
        norm += reference[i] ** 2;
    }
    return Math.sqrt(difference / norm);
}

// ---- Words and elements -------------------------------------------------------------------------

function make(tag, attributes = {}, ...children) {
    const is_svg = /^(svg|g|path|circle|line|text|rect|polyline|title)$/.test(tag);
    const element = is_svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
    for (const [name, value] of Object.entries(attributes))
        if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
        else if (value === true) element.setAttribute(name, "");
        else if (value !== false && value !== undefined) element.setAttribute(name, value);
    element.append(...children.flat().filter(child => child !== null && child !== undefined));
    return element;
}
const digits = x => !Number.isFinite(x) ? "–" : x !== 0 && (Math.abs(x) >= 1e5 || Math.abs(x) < 1e-3) ? x.toExponential(2) : String(+x.toPrecision(4));
const percent = x => Number.isFinite(x) ? `${+(100 * x).toPrecision(3)} %` : "not known";
// A number with all its digits under the mouse; a colour as one number if it is grey.
function number(x) {
    const list = Array.isArray(x) ? x : [x], is_grey = list.every(value => value === list[0]);
    const text = is_grey && list.length ? digits(list[0]) : `(${list.map(digits).join(", ")})`;
    return make("span", { class: "number", title: list.join(" ") }, text);
}

const style = `
:host { display: block; color-scheme: light dark; font: 1rem/1.45 system-ui, sans-serif; margin: 1rem 0;
  --soft: light-dark(#59636e, #9da7b3); --line: light-dark(#d1d9e0, #3d444d); --card: light-dark(#f6f8fa, #1b2027);
  --a: light-dark(#0b57b7, #6cb0ff); --b: light-dark(#b34700, #ffa657); --lit: light-dark(#1a7f37, #56d364); --dark: light-dark(#c1121f, #ff7b72); }
* { box-sizing: border-box; } [hidden] { display: none !important; }
.stage { position: relative; touch-action: pan-y; cursor: crosshair; line-height: 0; background: #000; outline-offset: 2px; }
.stage canvas { width: 100%; height: auto; image-rendering: pixelated; display: block; }
.stage canvas + canvas { position: absolute; inset: 0; }
.stage svg { position: absolute; inset: 0; width: 100%; height: 100%; pointer-events: none; overflow: hidden; }
.divide { width: 100%; margin: .3rem 0; }
.row { display: flex; flex-wrap: wrap; gap: .4rem .8rem; align-items: center; margin: .4rem 0; }
.row label { display: inline-flex; gap: .4rem; align-items: center; }
button, select, input { font: inherit; min-height: 2.2rem; } input[type=number] { width: 4.6rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; } .scroll { overflow-x: auto; }
td, th { text-align: left; padding: .1rem .9rem .1rem 0; font-weight: 400; white-space: nowrap; } th { color: var(--soft); }
.a { color: var(--a); } .b { color: var(--b); } code { font: .9em ui-monospace, monospace; }
.problem { border-left: .25rem solid var(--dark); padding: .3rem .7rem; background: var(--card); overflow-wrap: anywhere; }
.plot { width: 100%; max-width: 26rem; height: auto; display: block; } .plot text, .view text { font-size: 11px; fill: var(--soft); stroke: none; }
.path { border: 1px solid var(--line); border-radius: .4rem; padding: .6rem .8rem; margin: .5rem 0; }
.views { display: grid; grid-template-columns: repeat(auto-fit, minmax(14rem, 1fr)); gap: .6rem; }
.view { width: 100%; height: 16rem; background: var(--card); display: block; }
.room { fill: none; stroke: var(--soft); stroke-width: 1; opacity: .35; } .ray { fill: none; stroke: var(--a); stroke-width: 2; }
.over .ray { stroke: #6cb0ff; } .shadow { stroke-width: 1.5; stroke-dasharray: 4 3; } .visible { stroke: var(--lit); } .occluded { stroke: var(--dark); }
.over .visible { stroke: #56d364; } .over .occluded { stroke: #ff7b72; } .point { fill: var(--a); stroke: #fff; } .here { fill: #ffd33d; stroke: #000; }
.equation { margin: .4rem 0; padding: 0; list-style: none; } .equation li { padding: .15rem 0; overflow-wrap: anywhere; }
.number { font-variant-numeric: tabular-nums; border-bottom: 1px dotted var(--line); } .soft { color: var(--soft); } h4 { margin: .3rem 0; font-size: 1rem; }
`;

// ---- The plot of errors -------------------------------------------------------------------------

// Error over samples per pixel, both logarithmic; dashes: the true error.
function plot_of(sides) {
    const points = sides.flatMap(side => side.curve.flatMap(([n, ...errors]) => errors.filter(e => e > 0 && Number.isFinite(e)).map(e => [n, e])));
    if (!points.length) return make("svg", { class: "plot", viewBox: "0 0 400 10" });
    const [w, h, left, right, bottom, top] = [400, 220, 52, 18, 34, 8];
    const ends = values => { const lo = Math.floor(Math.log10(Math.min(...values))), hi = Math.ceil(Math.log10(Math.max(...values)) + 1e-9); return [lo, Math.max(hi, lo + 1)]; };
    const [x0, x1] = ends(points.map(p => p[0])), [y0, y1] = ends(points.map(p => p[1]));
    const X = n => left + (w - left - right) * (Math.log10(n) - x0) / (x1 - x0), Y = e => h - bottom - (h - bottom - top) * (Math.log10(e) - y0) / (y1 - y0);
    const svg = make("svg", { class: "plot", viewBox: `0 0 ${w} ${h}`, role: "img", "aria-label": "error over samples per pixel" });
    const grid = (x, y, xx, yy) => make("line", { x1: x, y1: y, x2: xx, y2: yy, stroke: "var(--line)" });
    for (let k = x0; k <= x1; ++k)
        svg.append(grid(X(10 ** k), top, X(10 ** k), h - bottom), make("text", { x: X(10 ** k), y: h - bottom + 14, "text-anchor": "middle" }, digits(10 ** k)));
    for (let k = y0; k <= y1; ++k)
        svg.append(grid(left, Y(10 ** k), w - right, Y(10 ** k)), make("text", { x: left - 5, y: Y(10 ** k) + 4, "text-anchor": "end" }, `${digits(100 * 10 ** k)} %`));
    svg.append(make("text", { x: (w + left) / 2, y: h - 4, "text-anchor": "middle" }, "samples per pixel; error: relative RMSE"));
    sides.forEach((side, k) => [1, 2].forEach(of => {
        const known = side.curve.filter(row => row[of] > 0 && Number.isFinite(row[of]));
        svg.append(make("polyline", { points: known.map(row => `${X(row[0])},${Y(row[of])}`).join(" "), fill: "none",
            stroke: k ? "var(--b)" : "var(--a)", "stroke-width": 2, "stroke-dasharray": of === 2 ? "5 4" : "none" }));
        if (of === 1) for (const row of known) svg.append(make("circle", { cx: X(row[0]), cy: Y(row[1]), r: 2.5, fill: k ? "var(--b)" : "var(--a)" }));
    }));
    return svg;
}

// ---- A path -------------------------------------------------------------------------------------

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => a.map((x, k) => x - b[k]);
const times = (a, b) => a.map((x, k) => x * (Array.isArray(b) ? b[k] : b));

// Pixels of a point, or null behind the camera.
function projected({ camera: [eye, right, up, forward], tan_half, width, height }, p) {
    const d = minus(p, eye), z = dot(d, forward), pixel = 2 * tan_half / height;
    return z > 0 ? [width / 2 + dot(d, right) / z / pixel, height / 2 - dot(d, up) / z / pixel] : null;
}

// Rays, shadow rays and vertices, where `place` puts a point, or returns null.
function drawn_path(path, current, place, scale = 1) {
    const group = make("g"), line = (a, b, of) => a && b && group.append(make("line", { x1: a[0], y1: a[1], x2: b[0], y2: b[1], class: of, "vector-effect": "non-scaling-stroke" }));
    for (const v of path.vertices) {
        const to = v.p ?? v.from.map((x, k) => x + v.direction[k] * path.reach);
        line(place(v.from), place(to), "ray");
        if (v.light) line(place(v.p), place(v.light.at), `shadow ${v.light.occluded ? "occluded" : "visible"}`);
    }
    for (const v of path.vertices.filter(v => v.p)) {
        const at = place(v.p), is_here = v.k === current;
        if (at) group.append(make("circle", { cx: at[0], cy: at[1], r: (is_here ? 5 : 3.5) * scale, class: is_here ? "here" : "point", "stroke-width": scale }));
    }
    return group;
}

// The scene along one axis, with the path; `across` and `down` are the axes of the view.
function side_view(info, path, current, words, across, down, signs) {
    const flat = p => [signs[0] * p[across], signs[1] * p[down]];
    const extent = points => [0, 1].map(k => [Math.min(...points.map(p => p[k])), Math.max(...points.map(p => p[k]))]);
    const size = ([x, y]) => Math.hypot(x[1] - x[0], y[1] - y[0]);
    const own = path.vertices.flatMap(v => [v.from, v.p, v.light?.at]).filter(Boolean).map(flat);
    const corners = info.shapes.flatMap(s => s.length === 2 ? [minus(s[0], [s[1], s[1], s[1]]), times(minus(s[0], [-s[1], -s[1], -s[1]]), 1)] : s).map(flat);
    let box = extent(own);
    const whole = corners.length ? extent([...corners, ...own]) : box;
    if (size(whole) < 4 * size(box)) box = whole;
    const margin = 0.06 * size(box) || 1, w = box[0][1] - box[0][0] + 2 * margin, h = box[1][1] - box[1][0] + 2 * margin;
    const zoom = Math.min(320 / w, 240 / h), place = p => { const f = flat(p); return [(f[0] - box[0][0] + margin) * zoom, (f[1] - box[1][0] + margin) * zoom]; };
    const outlines = info.shapes.map(s => s.length === 2
        ? (c => `M${c[0] - s[1] * zoom},${c[1]}a${s[1] * zoom},${s[1] * zoom} 0 1 0 ${2 * s[1] * zoom},0a${s[1] * zoom},${s[1] * zoom} 0 1 0 ${-2 * s[1] * zoom},0`)(place(s[0]))
        : `M${s.map(p => place(p).map(x => x.toFixed(1)).join(",")).join("L")}Z`).join("");
    return make("figure", { style: "margin:0" }, make("svg", { class: "view", viewBox: `0 0 ${(w * zoom).toFixed(1)} ${(h * zoom).toFixed(1)}`, role: "img", "aria-label": `the path ${words}` },
        make("path", { class: "room", d: outlines }), drawn_path(path, current, place)), make("figcaption", { class: "soft" }, words));
}

// The rendering equation at a vertex, term by term, with its numbers.
function equation(v, path) {
    const item = (...children) => make("li", {}, ...children), list = make("ul", { class: "equation" });
    list.append(item("throughput β = ", number(v.throughput)));
    if (!v.p) return list.append(item("The ray leaves the scene: nothing is added."), item("L so far = ", number(v.L))), list;
    list.append(item("point p = ", number(v.p), ", normal n = ", number(v.n)));
    if (v.emission) list.append(item(make("b", {}, "emitted: "), "β w Lₑ, with Lₑ = ", number(v.emission), ", MIS weight w = ", number(v.weight),
        ": adds ", number(times(times(v.throughput, v.emission), v.weight))));
    const l = v.light;
    if (l) list.append(item(make("b", { class: "soft" }, "light sample: "), `${l.kind} light, chosen with probability `, number(l.chosen), ", ", make("b", { style: `color:var(--${l.occluded ? "dark" : "lit"})` }, l.occluded ? "occluded" : "visible"),
        ": f L cos / p · w, with f = ", number(l.f), ", L = ", number(l.Le), ", cos = ", number(l.cosine), ", p = ", number(l.pdf), " /sr, MIS weight w = ", number(l.weight),
        ", reflects ", number(l.L), ": adds β times this, ", number(times(v.throughput, l.L))));
    if (v.unlit) list.append(item(make("b", { class: "soft" }, "no light sample: "), v.unlit));
    if (v.pdf) list.append(item(make("b", { class: "soft" }, "next direction: "), "β f |cos| / p, with f = ", number(v.f), ", |cos| = ", number(v.cosine), ", p = ", number(v.pdf), " /sr",
        ...(v.next ? [": β becomes ", number(v.next)] : [])));
    if (v.next && v.pdf) {
        const plain = times(times(v.throughput, v.f), v.cosine / v.pdf), most = k => Math.max(...k);
        if (most(v.next) > most(plain) * 1.000001) list.append(item("It survived Russian roulette with probability ", number(most(plain) / most(v.next)), ", and is divided by this."));
    }
    list.append(item("L so far = ", number(v.L)));
    if (v.end) list.append(item(make("b", {}, "The path ends: "), v.end, "; L = ", number(path.L)));
    return list;
}

// ---- The element --------------------------------------------------------------------------------

class LiveFigure extends HTMLElement {
    static observedAttributes = ["scene", "technique", "against", "samples", "size"];
    sides = [];
    stops = 0;       // exposure, in powers of two
    cursor = null;   // the pixel whose path is shown
    sample = 0;
    half = 0;
    vertex = 0;
    is_running = false;
    is_seen = false;

    connectedCallback() {
        if (!this.shadowRoot) this.build();
        this.observer = new IntersectionObserver(entries => {
            this.is_seen = entries.at(-1).isIntersecting;
            if (!this.is_seen) return;
            if (this.sides.length || this.is_loading) this.run(); else this.reload();
        });
        this.observer.observe(this);
    }
    disconnectedCallback() {
        this.observer.disconnect();
        this.is_seen = false;
        for (const side of this.sides) side.drop();
        this.sides = [];
    }
    attributeChangedCallback() { if (this.is_seen) this.reload(); }

    // The text that is rendered; a page may set another.
    get text() { return this.own_text ?? penumbra.scenes[this.getAttribute("scene")]; }
    set text(text) { this.own_text = text; if (this.is_seen) this.reload(); }
    get name() { return this.own_text === undefined ? `scenes/${this.getAttribute("scene")}.scene` : "scenes/this.scene"; }

    // ---- Loading and rendering ----

    async reload() {
        const turn = this.turn = (this.turn ?? 0) + 1;
        this.is_loading = true;
        const words = [this.getAttribute("technique") ?? ""];
        if (this.hasAttribute("against")) words.push(this.getAttribute("against"));
        const common = ["samples", "size"].filter(name => this.getAttribute(name)).map(name => `${name === "samples" ? "--spp" : "--size"} ${this.getAttribute(name)} `).join("");
        const sides = words.map(options => new Side(common + options));
        try {
            await workers.start();
            if (turn !== this.turn) return;
            const reach = { name: this.name, text: this.text ?? `# no scene ${this.getAttribute("scene")}`, files: penumbra.files };
            for (const side of sides) await side.load(reach);
            if (turn !== this.turn) return sides.forEach(side => side.drop());
            if (sides[1] && sides[0].desk.pixels !== sides[1].desk.pixels) throw Error("A and B are of different size");
        } catch (error) {
            sides.forEach(side => side.desk && side.drop());
            if (turn === this.turn) this.tell(error.message);
            return;
        } finally {
            if (turn === this.turn) this.is_loading = false;
        }
        for (const side of this.sides) side.drop();
        this.sides = sides;
        this.is_paused = false;
        this.tell(null);
        const { width, height } = sides[0].info;
        for (const canvas of this.canvases) [canvas.width, canvas.height] = [width, height];
        this.overlay.setAttribute("viewBox", `0 0 ${width} ${height}`);
        this.shadowRoot.querySelectorAll("[data-two]").forEach(part => { part.hidden = sides.length < 2; });
        if (this.cursor && (this.cursor[0] >= width || this.cursor[1] >= height)) this.close_path();
        this.wanted_pixel ??= this.getAttribute("pixel");
        if (this.wanted_pixel) { this.open_path(...this.wanted_pixel.split(",").map(Number)); this.wanted_pixel = ""; } else if (this.cursor) this.show_path();
        this.run();
    }

    // Next is the side that is behind, in samples or in time.
    get next_side() {
        const [a, b] = this.sides;
        if (!b) return a && !a.is_done ? a : null;
        if (this.mode.value === "samples") return a.is_done || (!b.is_done && b.samples < a.samples) ? (b.is_done ? null : b) : a;
        if (a.is_done && b.seconds >= a.seconds) return null;
        b.limit = Infinity;
        return a.is_done || b.seconds < a.seconds ? b : a;
    }

    async run() {
        if (this.is_running) return;
        this.is_running = true;
        try {
            for (let side; this.is_seen && !this.is_paused && (side = this.next_side);) {
                await side.pass(penumbra.references?.[this.getAttribute("scene")]);
                if (!this.sides.includes(side)) continue;
                this.show(side);
            }
        } catch (error) {
            this.tell(error.message);
            for (const side of this.sides) side.drop();
            this.sides = [];
        }
        this.is_running = false;
        this.show_state();
    }

    // Resolves when no sample is missing; for pages and tests.
    async finished() {
        while (this.is_loading || this.is_running || (!this.message.textContent && !this.is_paused && (!this.sides.length || this.next_side)))
            await new Promise(resolve => setTimeout(resolve, 20));
    }

    // ---- What is shown ----

    build() {
        const root = this.attachShadow({ mode: "open" });
        this.still = make("slot");
        this.canvases = [0, 1].map(k => make("canvas", k ? { "data-two": true } : {}));
        this.overlay = make("svg", { class: "over", preserveAspectRatio: "none" });
        this.stage = make("div", { class: "stage", tabindex: 0, role: "application", hidden: true, onclick: event => this.click(event), onkeydown: event => this.key(event),
            "aria-label": "picture; arrows choose a pixel and show its path, Escape closes it, plus and minus change the exposure" }, this.canvases, this.overlay);
        this.divide = make("input", { type: "range", class: "divide", min: 0, max: 1000, value: 500, "data-two": true, "aria-label": "A on the left, B on the right", oninput: () => this.show_divide() });
        this.mode = make("select", { "aria-label": "A and B have", onchange: () => this.run() }, make("option", { value: "samples" }, "equal samples"), make("option", { value: "time" }, "equal time"));
        this.toggle = make("button", { type: "button", onclick: () => this.start_or_stop() }, "Pause");
        this.exposure = make("input", { type: "number", step: 0.5, value: 0, oninput: () => this.set_stops(+this.exposure.value) });
        this.numbers = make("div", { class: "scroll" });
        this.plot = make("div");
        this.message = make("p", { class: "problem", role: "alert", hidden: true });
        this.path_box = make("section", { class: "path", hidden: true, "aria-live": "polite" });
        this.controls = make("div", { hidden: true }, this.divide, make("div", { class: "row" }, this.toggle, make("label", {}, "Exposure, stops", this.exposure),
            make("label", { "data-two": true }, "A and B have", this.mode)), this.numbers, make("details", { open: true }, make("summary", {}, "Error over samples"), this.plot));
        root.append(make("style", {}, style), this.still, this.message, this.stage, this.controls, this.path_box);
    }

    tell(problem) {
        this.message.hidden = !problem;
        this.message.textContent = problem ?? "";
        if (problem) this.dispatchEvent(new CustomEvent("problem", { detail: problem }));
        else this.dispatchEvent(new CustomEvent("loaded", { detail: this.sides.flatMap(side => side.info.warnings) }));
    }

    show(side) {
        const k = this.sides.indexOf(side), { width, height, exposure } = side.info;
        const shown = new ImageData(width, height), factor = exposure * 2 ** this.stops;
        for (let i = 0; i < width * height; ++i) {
            for (let c = 0; c < 3; ++c) shown.data[4 * i + c] = srgb(factor * side.image[3 * i + c]);
            shown.data[4 * i + 3] = 255;
        }
        this.canvases[k].getContext("2d").putImageData(shown, 0, 0);
        this.still.hidden = true;
        this.stage.hidden = this.controls.hidden = false;
        this.show_divide();
        this.show_state();
    }
    show_state() {
        const row = (side, k) => make("tr", {}, make("th", { class: k ? "b" : "a", scope: "row" }, this.sides[1] ? "AB"[k] : "●"),
            ...[digits(side.samples), side.seconds.toPrecision(3) + " s", percent(side.error?.d_rel) + (side.error?.standard_error >= 0 ? ` ± ${percent(side.error.standard_error)}` : "") + (side.error?.is_doubted ? " (uncertain)" : ""),
                ...(side.curve.at(-1)?.[2] === undefined ? [] : [percent(side.curve.at(-1)[2])])].map(text => make("td", {}, text)), make("td", {}, make("code", {}, side.options || "default technique")));
        const has_truth = this.sides.some(side => side.curve.at(-1)?.[2] !== undefined);
        if (this.sides.length) this.numbers.replaceChildren(make("table", {}, make("tr", {}, ...["", "samples per pixel", "work", "error", ...(has_truth ? ["true error"] : []), ""].map(word => make("th", { scope: "col" }, word))), this.sides.map(row)));
        this.plot.replaceChildren(plot_of(this.sides));
        this.toggle.textContent = this.is_paused ? "Continue" : this.sides.length && !this.next_side ? "4 times the samples" : "Pause";
    }
    show_divide() {
        if (this.sides[1]) this.canvases[1].style.clipPath = `inset(0 0 0 ${this.divide.value / 10}%)`;
    }
    set_stops(stops) {
        this.stops = stops;
        this.exposure.value = stops;
        for (const side of this.sides) if (side.image) this.show(side);
    }
    start_or_stop() {
        if (this.is_paused || this.next_side) this.is_paused = !this.is_paused;
        else for (const side of this.sides) side.limit = side.desk.n * 4;
        this.show_state();
        this.run();
    }

    // ---- Pixels and paths ----

    click(event) {
        const box = this.stage.getBoundingClientRect(), { width, height } = this.sides[0]?.info ?? {};
        if (!width) return;
        const at = [(event.clientX - box.left) / box.width * width, (event.clientY - box.top) / box.height * height];
        this.sample = 0;
        this.open_path(...[width, height].map((size, k) => Math.max(0, Math.min(size - 1, Math.floor(at[k])))));
    }
    key(event) {
        const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1], Enter: [0, 0] }[event.key];
        if (!this.sides[0] || event.ctrlKey || event.altKey || event.metaKey) return;
        const { width, height } = this.sides[0].info, size = [width, height], from = this.cursor ?? [width >> 1, height >> 1];
        if (step) this.open_path(...from.map((x, k) => Math.max(0, Math.min(size[k] - 1, x + step[k] * (event.shiftKey ? 10 : 1)))));
        else if (event.key === "Escape") this.close_path();
        else if ("+=-".includes(event.key)) this.set_stops(this.stops + (event.key === "-" ? -0.5 : 0.5));
        else return;
        event.preventDefault();
    }
    close_path() {
        this.cursor = null;
        this.path_box.hidden = true;
        this.overlay.replaceChildren();
        this.dispatchEvent(new CustomEvent("pixel"));
    }
    open_path(x, y) {
        this.cursor = [x, y];
        this.vertex = 0;
        this.show_path();
        this.dispatchEvent(new CustomEvent("pixel"));
    }
    // The path belongs to the side that is seen at its pixel.
    get side_of_path() {
        const { width } = this.sides[0].info;
        return this.sides[1] && 1000 * (this.cursor[0] + 0.5) / width > this.divide.value ? this.sides[1] : this.sides[0];
    }
    show_path() {
        const side = this.side_of_path, { info, desk } = side, [x, y] = this.cursor;
        let path;
        try {
            path = desk.path(x, y, this.sample, this.half);
        } catch (error) {
            return this.tell(error.message);
        }
        this.path = path;
        path.reach = 2 * Math.max(1e-9, ...path.vertices.map(v => Math.hypot(...minus(v.p ?? v.from, info.camera[0])))) ;
        const vertices = path.vertices, k = this.vertex = Math.min(this.vertex, vertices.length - 1), v = vertices[k];
        const button = (words, label, act, is_off) => make("button", { type: "button", "aria-label": label, disabled: is_off, onclick: () => { act(); this.show_path(); this.focus_button(label); } }, words);
        const pixel = make("rect", { x: x - 0.5, y: y - 0.5, width: 2, height: 2, fill: "none", stroke: "#ffd33d", "stroke-width": 2, "vector-effect": "non-scaling-stroke" });
        this.overlay.replaceChildren(drawn_path({ ...path, vertices: vertices.slice(1) }, k, p => projected(info, p), info.width / 640), pixel);
        this.path_box.hidden = false;
        this.path_box.replaceChildren(
            make("div", { class: "row" }, make("b", {}, `Path of pixel ${x},${y}${this.sides[1] ? ` in ${side === this.sides[0] ? "A" : "B"}` : ""}`),
                make("span", {}, button("◀", "sample before", () => { --this.sample; }, this.sample === 0), ` sample ${this.sample} `, button("▶", "next sample", () => { ++this.sample; })),
                make("span", {}, button(`half ${this.half}`, "other half", () => { this.half = (this.half + 1) % Math.max(1, info.replications); })),
                make("button", { type: "button", "aria-label": "close the path", onclick: () => { this.close_path(); this.stage.focus(); } }, "✕")),
            make("div", { class: "views" }, side_view(info, path, k, "from above", 0, 2, [1, 1]), side_view(info, path, k, "from the side", 2, 1, [-1, -1])),
            make("p", { class: "soft" }, "L(x, ωₒ) = Lₑ(x, ωₒ) + ∫ f(x, ωₒ, ωᵢ) L(y, −ωᵢ) |cos θ| dωᵢ, estimated by one direction and one light sample at each vertex."),
            make("div", { class: "row" }, button("◀", "vertex before", () => { --this.vertex; }, k === 0), make("h4", {}, `Vertex ${k} of ${vertices.length - 1}`),
                button("▶", "next vertex", () => { ++this.vertex; }, k === vertices.length - 1), make("span", {}, v.p ? `${v.material}, ${v.line}, at distance ${digits(v.distance)}` : "")),
            equation(v, path),
            make("details", {}, make("summary", {}, make("code", {}, `--pixel ${x},${y} --sample ${this.sample},${this.half}`)), make("pre", { class: "scroll" }, path.printed)));
    }
    focus_button(label) {
        const same = [...this.path_box.querySelectorAll("button")].find(button => button.getAttribute("aria-label") === label);
        (same?.disabled ? this.path_box.querySelector("button:not([disabled])") : same)?.focus();
    }
}

// The byte of linear radiance, as the program's PNG has it up to rounding: IEC 61966-2-1.
function srgb(x) {
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.min(1, x) ** (1 / 2.4) - 0.055);
}

// Without WebAssembly the element has no life: its still picture stays.
if (typeof WebAssembly === "object" && typeof DecompressionStream === "function") customElements.define("live-figure", LiveFigure);
