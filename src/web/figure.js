// web/figure.js  4  <live-figure>: a picture that renders itself, its error, and the paths of its pixels
//
// <live-figure scene="cornell" technique="--light nee" against="--light none" samples="256">STILL PICTURE</live-figure>
//   scene       a name of penumbra.scenes, or none: its text is set as figure.text
//   technique   options of build/penumbra; against: those of a second picture, beside a slider
//   samples     per pixel, then it stops; size: WIDTHxHEIGHT; pixel: X,Y: the path of this pixel is open
// With figure.reference (a Float32Array, linear RGB) the true error is shown, too.
// Its slider is not that of keep/pair.h: pictures change while it is moved, and paths are drawn over them.
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
    const acts = {
        load: async ({ id, module, scene }) => {
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
    start() {
        if (this.all.length) return;
        const source = URL.createObjectURL(new Blob([`"use strict";${Renderer};(${work})()`], { type: "text/javascript" }));
        for (let k = 0; k < Math.min(64, navigator.hardwareConcurrency || 2); ++k) {
            const worker = new Worker(source);
            worker.onmessage = ({ data: { call, result, error } }) => {
                const { resolve, reject } = this.waiting.get(call);
                this.waiting.delete(call);
                error === undefined ? resolve(result) : reject(Error(error));
            };
            worker.onerror = ({ message }) => this.end(message || "a worker ended");
            this.all.push(worker);
        }
    },
    // Ends all workers, and what waits for them; a figure that is loaded later has new ones.
    end(why) {
        this.all.forEach(worker => worker.terminate());
        this.all = [];
        this.waiting.forEach(({ reject }) => reject(Error(why)));
        this.waiting.clear();
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
        const module = await renderer_module();
        this.desk = await Renderer.of(module);
        this.info = this.desk.load(this.scene);  // an error is told before any worker begins
        this.limit = this.info.samples;
        this.workers = workers.all;
        await workers.ask({ act: "load", id: this.id, module, scene: this.scene });
    }

    get most() { return this.is_timed ? Infinity : this.limit; }  // B may be told to take as long as A
    get is_done() { return !this.desk.is_pilot && this.desk.n >= this.most; }
    get samples() { return this.error?.spp ?? 0; }

    // The picture does not depend on where passes end; those of the pilot end at every sample.
    async pass(reference) {
        const { desk, id } = this;
        if (this.workers !== workers.all) throw Error("a worker ended");
        const quick = this.last ? Math.floor(0.2 / this.last.seconds * this.last.samples) : 1;
        const n = desk.is_pilot ? desk.n + 1 : Math.min(this.most, desk.n + Math.max(1, Math.min(quick, desk.n + 1)));
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
            this.curve.push([this.samples, this.error.d_rel, true_error(this.image, reference)]);
    }

    drop() {
        if (this.is_dropped) return;
        this.is_dropped = true;
        workers.ask({ act: "drop", id: this.id }).catch(() => {});  // they may end before
    }
}

// |f - F| / |F|, if there is a reference of this size.
function true_error(image, reference) {
    if (reference?.length !== image.length) return undefined;
    let difference = 0, norm = 0;
    for (let i = 0; i < image.length; ++i) {
        difference += (image[i] - reference[i]) ** 2;
        norm += reference[i] ** 2;
    }
    return Math.sqrt(difference / norm);
}

// ---- Words --------------------------------------------------------------------------------------

const digits = x => x === null ? "not finite" : x !== 0 && (Math.abs(x) >= 1e5 || Math.abs(x) < 1e-3) ? x.toExponential(2) : String(+x.toPrecision(4));
const percent = x => Number.isFinite(x) ? `${+(100 * x).toPrecision(3)} %` : "not known";

// html`...` escapes its values, except those that it has made itself; lists are joined.
class Html { constructor(text) { this.text = text; } }
const escaped = text => String(text).replace(/[&<>"]/g, letter => `&#${letter.charCodeAt(0)};`);
const word_of = value => value instanceof Html ? value.text : escaped(value ?? "");
const html = (parts, ...values) =>
    new Html(parts.map((part, k) => part + [values[k] ?? ""].flat().map(word_of).join("")).join(""));

// A number with all its digits under the mouse; a grey colour is one number.
function number(x) {
    const list = [x].flat(), is_grey = list.every(value => value === list[0]);
    const shown = is_grey ? digits(list[0]) : `(${list.map(digits).join(", ")})`;
    return html`<span class="number" title="${list.join(" ")}">${shown}</span>`;
}

const style = `
:host { display: block; color-scheme: light dark; font: 1rem/1.45 system-ui, sans-serif; margin: 1rem 0;
    --soft: light-dark(#59636e, #9da7b3); --line: light-dark(#d1d9e0, #3d444d); --card: light-dark(#f6f8fa, #1b2027);
    --a: light-dark(#0b57b7, #6cb0ff); --b: light-dark(#b34700, #ffa657);
    --visible: light-dark(#1a7f37, #56d364); --occluded: light-dark(#c1121f, #ff7b72); }
* { box-sizing: border-box; } [hidden] { display: none !important; }
.stage { position: relative; touch-action: pan-y; cursor: crosshair; line-height: 0; background: #000; outline-offset: 2px; }
.stage canvas { width: 100%; height: auto; image-rendering: pixelated; display: block; }
.stage canvas + canvas { position: absolute; inset: 0; } .divide { width: 100%; margin: .3rem 0; }
.stage svg { position: absolute; inset: 0; width: 100%; height: 100%; pointer-events: none; overflow: hidden;
    --a: #6cb0ff; --visible: #56d364; --occluded: #ff7b72; }
.row { display: flex; flex-wrap: wrap; gap: .4rem .8rem; align-items: center; margin: .4rem 0; }
.row label { display: inline-flex; gap: .4rem; align-items: center; }
button, select, input { font: inherit; min-height: 2.2rem; } input[type=number] { width: 4.6rem; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
td, th { text-align: left; padding: .1rem .9rem .1rem 0; font-weight: 400; white-space: nowrap; vertical-align: baseline; }
td.error { white-space: normal; min-width: 9rem; }
th, .soft { color: var(--soft); } .a { color: var(--a); } .b { color: var(--b); } code { font: .9em ui-monospace, monospace; }
.problem { border-left: .25rem solid var(--occluded); padding: .3rem .7rem; background: var(--card); overflow-wrap: anywhere; }
.plot { width: 100%; max-width: 26rem; height: auto; display: block; }
.plot text { font-size: 11px; fill: var(--soft); text-anchor: middle; }
.plot .left { text-anchor: end; } .plot line { stroke: var(--line); }
.plot polyline { fill: none; stroke: currentColor; stroke-width: 2; } .plot circle { fill: currentColor; }
.path { border: 1px solid var(--line); border-radius: .4rem; padding: .6rem .8rem; margin: .5rem 0; }
.views { display: grid; grid-template-columns: repeat(auto-fit, minmax(14rem, 1fr)); gap: .6rem; }
.views figure { margin: 0; } .views svg { width: 100%; height: 16rem; background: var(--card); display: block; }
line, .room, .pixel { fill: none; vector-effect: non-scaling-stroke; }
.room { stroke: var(--soft); opacity: .35; } .pixel { stroke: #ffd33d; stroke-width: 2; }
.ray { stroke: var(--a); stroke-width: 2; } .shadow { stroke-width: 1.5; stroke-dasharray: 4 3; }
.visible { stroke: var(--visible); color: var(--visible); } .occluded { stroke: var(--occluded); color: var(--occluded); }
.point { fill: var(--a); stroke: #fff; } .here { fill: #ffd33d; stroke: #000; }
.equation { margin: .4rem 0; padding: 0; list-style: none; } .equation li { padding: .15rem 0; overflow-wrap: anywhere; }
.number { font-variant-numeric: tabular-nums; border-bottom: 1px dotted var(--line); }
`;

// ---- The plot of errors -------------------------------------------------------------------------

// Error over samples per pixel, both logarithmic; dashes: the true error.
function plot_of(sides) {
    const is_known = error => error > 0 && Number.isFinite(error);
    const rows = sides.flatMap(side => side.curve), errors = rows.flatMap(row => row.slice(1)).filter(is_known);
    if (!errors.length) return html``;
    const decades = values => {
        const least = Math.floor(Math.log10(Math.min(...values))), most = Math.ceil(Math.log10(Math.max(...values)) + 1e-9);
        return Array.from({ length: Math.max(2, most - least + 1) }, (_, k) => 10 ** (least + k));
    };
    const across = decades(rows.map(row => row[0])), up = decades(errors);
    const part = (x, marks) => Math.log10(x / marks[0]) / Math.log10(marks.at(-1) / marks[0]);
    const X = n => (52 + 330 * part(n, across)).toFixed(1), Y = error => (186 - 178 * part(error, up)).toFixed(1);
    const curve = (side, k, of) => {
        const known = side.curve.filter(row => is_known(row[of]));
        return html`<g class="${"ab"[k]}"><polyline points="${known.map(row => `${X(row[0])},${Y(row[of])}`).join(" ")}"
            stroke-dasharray="${of === 2 ? "5 4" : "none"}"/>
            ${known.map(row => of === 1 ? html`<circle cx="${X(row[0])}" cy="${Y(row[1])}" r="2.5"/>` : "")}</g>`;
    };
    return html`<svg class="plot" viewBox="0 0 400 220" role="img" aria-label="error over samples per pixel">
        ${across.map(n => html`<line x1="${X(n)}" x2="${X(n)}" y1="8" y2="186"/><text x="${X(n)}" y="200">${digits(n)}</text>`)}
        ${up.map(e => html`<line x1="52" x2="382" y1="${Y(e)}" y2="${Y(e)}"/>
            <text class="left" x="47" y="${+Y(e) + 4}">${digits(100 * e)} %</text>`)}
        <text x="217" y="216">samples per pixel; error: relative RMSE</text>
        ${sides.map((side, k) => [1, 2].map(of => curve(side, k, of))).flat()}</svg>`;
}

// ---- A path -------------------------------------------------------------------------------------

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => a.map((x, k) => x - b[k]);
const times = (a, b) => a.map((x, k) => x * (Array.isArray(b) ? b[k] : b));

// Pixels of a point, or null behind the camera.
function projected({ eye, right, up, forward, tan_half, width, height }, p) {
    const d = minus(p, eye), z = dot(d, forward), pixel = 2 * tan_half / height;
    return z > 0 ? [width / 2 + dot(d, right) / z / pixel, height / 2 - dot(d, up) / z / pixel] : null;
}

// Rays, shadow rays and vertices, where `place` puts a point, or returns null.  A ray that leaves the scene is drawn
// as long as the path.
function drawn_path(vertices, current, place, size = 1) {
    const line = (from, to, name) => {
        const [a, b] = [place(from), place(to)];
        return a && b ? html`<line class="${name}" x1="${a[0]}" y1="${a[1]}" x2="${b[0]}" y2="${b[1]}"/>` : "";
    };
    const reach = Math.max(...vertices.map(v => v.distance ?? 0)) || 1;
    const rays = vertices.map(v => line(v.from, v.p ?? minus(v.from, times(v.direction, -reach)), "ray"));
    const shadows = vertices.filter(v => v.light)
        .map(v => line(v.p, v.light.at, `shadow ${v.light.occluded ? "occluded" : "visible"}`));
    const points = vertices.filter(v => v.p && place(v.p)).map(v => {
        const [x, y] = place(v.p), is_here = v.k === current;
        return html`<circle class="${is_here ? "here" : "point"}" cx="${x}" cy="${y}" r="${(is_here ? 5 : 3.5) * size}"
            stroke-width="${size}"/>`;
    });
    return html`${rays}${shadows}${points}`;
}

// The path and outlines of the scene, seen along one axis: the whole scene unless it is much larger than the path.
function side_view(info, vertices, current, words, across, down, sign) {
    const flat = p => [sign * p[across], (down === 1 ? -1 : 1) * p[down]];
    const box_of = points => [0, 1].map(k => [Math.min(...points.map(p => p[k])), Math.max(...points.map(p => p[k]))]);
    const size_of = ([x, y]) => Math.hypot(x[1] - x[0], y[1] - y[0]);
    const is_sphere = shape => shape.length === 2, extent = ([centre, r]) => [-r, r].map(x => centre.map(c => c + x));
    const own = vertices.flatMap(v => [v.from, v.p, v.light?.at]).filter(Boolean).map(flat);
    const corners = info.shapes.flatMap(shape => is_sphere(shape) ? extent(shape) : shape).map(flat);
    const path_box = box_of(own), scene_box = box_of([...corners, ...own]);
    const [x, y] = size_of(scene_box) < 4 * size_of(path_box) ? scene_box : path_box;
    const margin = 0.06 * size_of([x, y]) || 1, w = x[1] - x[0] + 2 * margin, h = y[1] - y[0] + 2 * margin;
    const zoom = Math.min(320 / w, 240 / h);
    const place = p => flat(p).map((at, k) => +((at - [x, y][k][0] + margin) * zoom).toFixed(2));
    const outline = shape => {
        if (!is_sphere(shape)) return `M${shape.map(place).join("L")}Z`;
        const [cx, cy] = place(shape[0]), r = shape[1] * zoom;
        return `M${cx - r},${cy}a${r},${r} 0 1 0 ${2 * r},0a${r},${r} 0 1 0 ${-2 * r},0`;
    };
    return html`<figure><svg viewBox="0 0 ${w * zoom} ${h * zoom}" role="img" aria-label="the path ${words}">
        <path class="room" d="${info.shapes.map(outline).join("")}"/>${drawn_path(vertices, current, place)}</svg>
        <figcaption class="soft">${words}</figcaption></figure>`;
}

// The rendering equation at a vertex, term by term, with its numbers.
function equation(v, path) {
    const lines = [html`throughput β = ${number(v.throughput)}`], n = number, l = v.light;
    const seen = l?.occluded ? "occluded" : "visible";
    if (!v.p) lines.push(html`The ray meets nothing: nothing is added.`);
    else lines.push(html`point p = ${n(v.p)}, normal n = ${n(v.n)}`);
    if (v.emission) lines.push(html`<b>emitted:</b> β Lₑ w, with Lₑ = ${n(v.emission)}, MIS weight w = ${n(v.weight)}:
        adds ${n(v.emitted)}`);
    if (l) lines.push(html`<b>light sample:</b> ${l.kind} light, chosen with probability ${n(l.chosen)},
        <b class="${seen}">${seen}</b>: β f L cos / p · w, with f = ${n(l.f)}, L = ${n(l.Le)}, cos = ${n(l.cosine)},
        p = ${n(l.pdf)} /sr, MIS weight w = ${n(l.weight)}: reflects ${n(l.L)}, adds ${n(v.reflected)}`);
    if (v.unlit) lines.push(html`<b>no light sample:</b> ${v.unlit}`);
    if (v.pdf) lines.push(html`<b>next direction:</b> β f |cos| / p, with f = ${n(v.f)}, |cos| = ${n(v.cosine)},
        p = ${n(v.pdf)} /sr${v.next ? html`: β becomes ${n(v.next)}` : ""}`);
    if (v.next) {
        const before = Math.max(...times(times(v.throughput, v.f), v.cosine / v.pdf)), after = Math.max(...v.next);
        if (after > before * (1 + 1e-6)) lines.push(html`It survives Russian roulette with probability
            ${n(before / after)}, by which β is divided.`);
    }
    lines.push(html`L so far = ${n(v.L)}`);
    if (v.end) lines.push(html`<b>The path ends:</b> ${v.end}; L = ${n(path.L)}`);
    return html`<ul class="equation">${lines.map(line => html`<li>${line}</li>`)}</ul>`;
}

// ---- The element --------------------------------------------------------------------------------

const skeleton = `<style>${style}</style><slot></slot><p class="problem" role="alert" hidden></p>
<div class="stage" tabindex="0" role="application" hidden aria-label="picture: arrows choose a pixel and open its path, Escape
closes it, plus and minus change the exposure">
<canvas></canvas><canvas data-two></canvas><svg preserveAspectRatio="none"></svg></div>
<div class="controls" hidden>
<input class="divide" type="range" min="0" max="1000" value="500" data-two aria-label="A on the left, B on the right">
<div class="row"><button class="toggle" type="button">Pause</button>
<label>Exposure, stops <input class="exposure" type="number" step="0.5" value="0"></label>
<label data-two>A and B have
<select class="mode"><option value="samples">equal samples</option><option value="time">equal time</option></select></label></div>
<div class="numbers scroll"></div><details open><summary>Error over samples</summary><div class="curves"></div></details></div>
<section class="path" hidden></section>`;

class LiveFigure extends HTMLElement {
    static observedAttributes = ["scene", "technique", "against", "samples", "size"];
    sides = [];
    stops = 0;       // exposure, in powers of two
    cursor = null;   // the pixel whose path is shown
    sample = 0;
    half = 0;
    vertex = 0;
    turn = 0;        // of loading: a later one replaces those before it

    connectedCallback() {
        if (!this.shadowRoot) this.build();
        this.observer = new IntersectionObserver(entries => {
            this.is_seen = entries.at(-1).isIntersecting;
            if (!this.is_seen) return;
            if (this.sides.length || this.is_loading) this.run();
            else this.reload();
        });
        this.observer.observe(this);
    }
    disconnectedCallback() {
        this.observer.disconnect();
        this.is_seen = false;
        ++this.turn;
        this.replace([]);
    }
    attributeChangedCallback() { if (this.is_seen) this.reload(); }
    // The text that is rendered; a page may set another.
    get text() { return this.own_text ?? penumbra.scenes[this.getAttribute("scene")] ?? ""; }
    set text(text) {
        this.own_text = text;
        if (this.is_seen) this.reload();
    }
    get name() { return `scenes/${this.own_text === undefined ? this.getAttribute("scene") : "this"}.scene`; }

    // ---- Loading and rendering ----

    async reload() {
        const turn = ++this.turn, scene = { name: this.name, text: this.text, files: penumbra.files };
        const option = (name, as) => this.getAttribute(name) ? `${as} ${this.getAttribute(name)} ` : "";
        const common = option("samples", "--spp") + option("size", "--size");
        const names = this.hasAttribute("against") ? ["technique", "against"] : ["technique"];
        const sides = names.map(name => new Side(common + (this.getAttribute(name) ?? "")));
        this.is_loading = true;
        try {
            workers.start();
            for (const side of sides) if (turn === this.turn) await side.load(scene);
            if (sides.some(side => side.desk?.pixels !== sides[0].desk.pixels)) throw Error("A and B differ in size");
        } catch (error) {
            for (const side of sides) side.drop();
            if (turn === this.turn) this.tell(error.message);
        }
        if (turn !== this.turn) return sides.forEach(side => side.drop());
        this.is_loading = false;
        if (sides.every(side => !side.is_dropped)) this.begin(sides);
    }
    replace(sides) {
        for (const side of this.sides) side.drop();
        this.sides = sides;
    }
    begin(sides) {
        const { width, height } = sides[0].info;
        this.replace(sides);
        this.is_paused = false;
        this.tell(null);
        for (const canvas of this.canvases) [canvas.width, canvas.height] = [width, height];
        this.overlay.setAttribute("viewBox", `0 0 ${width} ${height}`);
        for (const part of this.shadowRoot.querySelectorAll("[data-two]")) part.hidden = sides.length < 2;
        this.cursor ??= this.getAttribute("pixel")?.split(",").map(Number);
        if (this.cursor?.[0] < width && this.cursor[1] < height) this.show_path();
        else this.close_path();
        this.run();
    }

    // Next is the side that is behind, in samples or in time.
    get next_side() {
        const [a, b] = this.sides;
        if (!a || !b) return a && !a.is_done ? a : null;
        b.is_timed = this.mode.value !== "samples";
        if (this.mode.value === "samples") {
            if (a.is_done || b.is_done) return a.is_done && b.is_done ? null : a.is_done ? b : a;
            return b.samples < a.samples ? b : a;
        }
        if (a.is_done) return b.seconds < a.seconds ? b : null;
        return b.seconds < a.seconds ? b : a;
    }

    async run() {
        if (this.is_running) return;
        this.is_running = true;
        try {
            for (let side; this.is_seen && !this.is_paused && (side = this.next_side);) {
                try { await side.pass(this.reference); } catch (error) { if (!side.is_dropped) throw error; }
                if (!side.is_dropped) this.show(side);
            }
        } catch (error) { this.fail(error); }
        this.is_running = false;
        this.show_state();
    }

    // Resolves when no sample is missing.
    async finished() {
        const is_over = () => this.message.textContent || this.is_paused || (this.sides.length && !this.next_side);
        while (this.is_loading || this.is_running || !is_over()) await new Promise(resolve => setTimeout(resolve, 20));
    }

    // ---- What is shown ----

    build() {
        this.attachShadow({ mode: "open" }).innerHTML = skeleton;
        const find = name => this.shadowRoot.querySelector(name);
        this.canvases = [...this.shadowRoot.querySelectorAll("canvas")];
        [this.still, this.message, this.stage, this.overlay, this.controls, this.divide, this.toggle] =
            ["slot", ".problem", ".stage", ".stage svg", ".controls", ".divide", ".toggle"].map(find);
        [this.exposure, this.mode, this.numbers, this.curves, this.path_box] =
            [".exposure", ".mode", ".numbers", ".curves", ".path"].map(find);
        this.stage.addEventListener("click", event => this.click(event));
        this.stage.addEventListener("keydown", event => this.key(event));
        this.divide.addEventListener("input", () => this.show_divide());
        this.toggle.addEventListener("click", () => this.start_or_stop());
        this.exposure.addEventListener("input", () => this.set_stops(+this.exposure.value));
        this.mode.addEventListener("change", () => this.run());
        this.path_box.addEventListener("click", event => this.step(event.target.closest("button")?.dataset.act));
    }

    // Tells a problem, or that there is none.
    tell(problem) {
        this.message.hidden = !problem;
        this.message.textContent = problem ?? "";
        if (problem) this.dispatchEvent(new CustomEvent("problem", { detail: problem }));
        else this.dispatchEvent(new CustomEvent("loaded", { detail: this.sides[0].info.warnings }));
    }
    fail(error) { this.replace([]), this.tell(error.message); }

    show(side) {
        const { width, height, exposure } = side.info, factor = exposure * 2 ** this.stops;
        const shown = new ImageData(width, height);
        for (let i = 0; i < width * height; ++i) {
            for (let c = 0; c < 3; ++c) shown.data[4 * i + c] = srgb(factor * side.image[3 * i + c]);
            shown.data[4 * i + 3] = 255;
        }
        this.canvases[this.sides.indexOf(side)].getContext("2d").putImageData(shown, 0, 0);
        this.still.hidden = true;
        this.stage.hidden = this.controls.hidden = false;
        this.show_divide();
        this.show_state();
    }
    show_state() {
        const has_truth = this.sides.some(side => side.curve.at(-1)?.[2] !== undefined);
        const error_of = ({ d_rel, standard_error, doubt }) => doubt ? `not known: ${doubt}` :
            percent(d_rel) + (Number.isFinite(standard_error) ? ` ± ${percent(standard_error)}` : "");
        const row = (side, k) => html`<tr><th class="${"ab"[k]}" scope="row">${this.sides[1] ? "AB"[k] : "●"}</th>
            <td>${digits(side.samples)}</td><td>${side.seconds.toPrecision(3)} s</td><td class="error">${error_of(side.error ?? {})}</td>
            ${has_truth ? html`<td>${percent(side.curve.at(-1)?.[2])}</td>` : ""}
            <td><code>${side.options || "default technique"}</code></td></tr>`;
        this.numbers.innerHTML = html`<table><tr><th></th><th scope="col">samples per pixel</th><th scope="col">work</th>
            <th scope="col">error</th>${has_truth ? html`<th scope="col">true error</th>` : ""}<th></th></tr>
            ${this.sides.map(row)}</table>`.text;
        this.curves.innerHTML = plot_of(this.sides).text;
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

    // Opens the path of a pixel, or of the nearest in the picture.
    open_path(...pixel) {
        const { width, height } = this.sides[0].info;
        this.cursor = pixel.map((x, k) => Math.max(0, Math.min([width, height][k] - 1, Math.floor(x))));
        this.vertex = 0;
        this.show_path();
        this.dispatchEvent(new CustomEvent("pixel"));
    }
    close_path() {
        this.cursor = null;
        this.path_box.hidden = true;
        this.overlay.replaceChildren();
        this.dispatchEvent(new CustomEvent("pixel"));
    }
    click(event) {
        if (!this.sides[0]) return;
        const box = this.stage.getBoundingClientRect(), { width, height } = this.sides[0].info;
        this.sample = 0;
        this.open_path((event.clientX - box.left) / box.width * width, (event.clientY - box.top) / box.height * height);
    }
    key(event) {
        if (!this.sides[0] || event.ctrlKey || event.altKey || event.metaKey) return;
        const { width, height } = this.sides[0].info, [x, y] = this.cursor ?? [width >> 1, height >> 1];
        const far = event.shiftKey ? 10 : 1, go = (right, down) => () => this.open_path(x + far * right, y + far * down);
        const act = { ArrowLeft: go(-1, 0), ArrowRight: go(1, 0), ArrowUp: go(0, -1), ArrowDown: go(0, 1), Enter: go(0, 0),
            Escape: () => this.close_path(),
            "+": () => this.set_stops(this.stops + 0.5), "-": () => this.set_stops(this.stops - 0.5) }[event.key];
        if (!act) return;
        act();
        event.preventDefault();
    }
    // A button of the path: "vertex 1" is the next vertex.
    step(act) {
        if (!act) return;
        if (act === "close") return this.close_path(), this.stage.focus();
        const [what, by] = act.split(" "), replications = this.sides[0].info.replications;
        this[what] = what === "half" ? (this.half + 1) % replications : Math.max(0, this[what] + +by);
        this.show_path();
        (this.path_box.querySelector(`[data-act="${act}"]:enabled`) ?? this.path_box.querySelector("button:enabled")).focus();
    }
    // The path belongs to the side that is seen at its pixel.
    get side_of_path() {
        const is_right = 1000 * (this.cursor[0] + 0.5) / this.sides[0].info.width > this.divide.value;
        return this.sides[1] && is_right ? this.sides[1] : this.sides[0];
    }
    show_path() {
        const side = this.side_of_path, { info, desk } = side, [x, y] = this.cursor;
        try { this.path = desk.path(x, y, this.sample, this.half); } catch (error) { return this.fail(error); }
        const vertices = this.path.vertices, last = vertices.length - 1;
        if (last < 0) return this.tell("the path has no vertex: no step was shown to the visitor");
        const k = this.vertex = Math.min(this.vertex, last), v = vertices[k];
        const button = (act, label, words, is_on = true) =>
            html`<button type="button" data-act="${act}" aria-label="${label}"${is_on ? "" : " disabled"}>${words}</button>`;
        this.overlay.innerHTML = html`${drawn_path(vertices, k, p => projected(info, p), info.width / 640)}
            <rect class="pixel" x="${x - 0.5}" y="${y - 0.5}" width="2" height="2"/>`.text;
        this.path_box.hidden = false;
        this.path_box.innerHTML = html`<div class="row">
            <b>Path of pixel ${x},${y}${this.sides[1] ? ` in ${"AB"[this.sides.indexOf(side)]}` : ""}</b>
            ${button("sample -1", "sample before", "◀", this.sample > 0)} sample ${this.sample}
            ${button("sample 1", "next sample", "▶")} ${button("half 1", "other half", `half ${this.half}`)}
            ${button("close", "close the path", "✕")}</div>
            <div class="views">${side_view(info, vertices, k, "from above", 0, 2, 1)}
            ${side_view(info, vertices, k, "from the side", 2, 1, -1)}</div>
            <p class="soft">L(x, ωₒ) = Lₑ(x, ωₒ) + ∫ f(x, ωₒ, ωᵢ) L(y, −ωᵢ) |cos θ| dωᵢ,
            estimated by one direction and one light sample at each vertex.</p>
            <div class="row">${button("vertex -1", "vertex before", "◀", k > 0)} <b>Vertex ${k} of ${last}</b>
            ${button("vertex 1", "next vertex", "▶", k < last)}
            ${v.p ? `${v.material}, ${v.line}, at distance ${digits(v.distance)}` : ""}</div>${equation(v, this.path)}
            <details><summary><code>--pixel ${x},${y} --sample ${this.sample},${this.half}</code></summary>
            <pre class="scroll">${this.path.printed}</pre></details>`.text;
    }
}

// Linear radiance to a byte, as in the program's PNG (IEC 61966-2-1).
const srgb = x => 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.min(1, x) ** (1 / 2.4) - 0.055);

// Without WebAssembly the still picture stays.
if (globalThis.WebAssembly && globalThis.DecompressionStream) customElements.define("live-figure", LiveFigure);
