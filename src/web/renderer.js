// web/renderer.js  3  calls of the module (web.cpp), for pages, their workers and Node.js
"use strict";

// An instance of the module.  A call that fails throws an Error with the module's message, and
// ends the instance: nothing that it holds may be used again.
class Renderer {
    static async of(module) {
        const renderer = new Renderer(), encoder = new TextEncoder(), decoder = new TextDecoder();
        const bytes = (at, size) => new Uint8Array(renderer.memory.buffer, at, size);
        const text = (at, size) => decoder.decode(bytes(at, size).slice());
        const system = {  // no files, no environment
            environ_sizes_get: (count, size) => { bytes(count, 4).fill(0); bytes(size, 4).fill(0); return 0; },
            fd_write: (fd) => { throw Error(`the module writes to file ${fd}`); },
            proc_exit: (status) => { throw Error(`the module ends with status ${status}`); },
        };
        const imports = {
            page: { fail: (at, size) => { throw Error(text(at, size)); },
                    answer: (at, size) => { renderer.answer = JSON.parse(text(at, size)); } },
            wasi_snapshot_preview1: new Proxy(system, { get: (known, name) => known[name] ?? (() => 0) }),
        };
        renderer.calls = (await WebAssembly.instantiate(module, imports)).exports;
        renderer.memory = renderer.calls.memory;
        renderer.calls._initialize();
        renderer.texts = (...words) => words.flatMap(word => {
            const encoded = typeof word === "string" ? encoder.encode(word) : word;
            const at = renderer.calls.room(Math.max(1, encoded.length));
            bytes(at, encoded.length).set(encoded);
            return [at, encoded.length];
        });
        return renderer;
    }

    // Reads a scene { name, text, files: { name: text }, options: "--light nee" }.
    load({ name, text, files = {}, options = "" }) {
        for (const [file, content] of Object.entries(files)) this.calls.give(...this.texts(file, content));
        this.calls.load(...this.texts(text, name, options));
        this.scene = this.answer;
        this.pixels = this.scene.width * this.scene.height;
        this.n = 0;  // samples of each replication of weight 1, or of the pilot
        return this.scene;
    }
    // Adds samples to every `step`-th block from `first`, until n.
    add(n, first = 0, step = 1) {
        this.calls.add(first, step, n);
        this.took(n);
    }
    took(n) { this.calls.took(n); this.n = n; }
    get is_pilot() { return this.calls.pilot() > 0; }
    get is_pilot_done() { return this.is_pilot && this.n >= Math.min(this.calls.pilot(), this.scene.samples); }
    choose() { this.calls.choose(); this.n = 0; }

    // ---- What the module holds: views, which end with the next call ----
    array(Type, at, length) { return new Type(this.memory.buffer, at, length); }
    get image() { return this.array(Float32Array, this.calls.image(), 3 * this.pixels); }
    get error() {
        this.calls.error();
        return this.answer;
    }
    get sums() { return this.array(Float64Array, this.calls.sums(), 3 * this.scene.replications * this.pixels); }
    get deviations() { return this.array(Float32Array, this.calls.deviations(), this.is_pilot ? this.pixels : 0); }
    get near() { return this.array(Uint8Array, this.calls.near(), this.calls.near_size()); }

    // A path; at each vertex also what it adds to L, by its emission and by its light sample, and L so far.
    path(x, y, i = 0, set = 0) {
        this.calls.path(x, y, i, set);
        const times = (a, b) => a.map((value, k) => value * (b === null ? NaN : b[k] ?? b));
        let L = [0, 0, 0];
        for (const v of this.answer.vertices) {
            v.emitted = v.emission && times(times(v.throughput, v.emission), v.weight);
            v.reflected = v.light && times(v.throughput, v.light.L);
            for (const added of [v.emitted, v.reflected]) if (added) L = L.map((sum, k) => sum + added[k]);
            v.L = L;
        }
        return this.answer;
    }

    // ---- Blocks of a film, from one instance to another ----
    // Calls copy(place, from, to) for the pixels of every `step`-th block from `first`; returns their number.
    blocks(first, step, copy) {
        const { block, blocks } = this.scene;
        let place = 0;
        for (let b = first; b < blocks; b += step) {
            const from = b * block, to = Math.min(this.pixels, from + block);
            copy(place, from, to);
            place += to - from;
        }
        return place;
    }
    packed(first, step) {
        const sums = this.sums, deviations = this.deviations, size = 3 * this.scene.replications;
        const pixels = this.blocks(first, step, () => 0);
        const taken = { first, step, near: this.near.slice(), sums: new Float64Array(size * pixels),
            deviations: new Float32Array(deviations.length && pixels) };
        this.blocks(first, step, (place, from, to) => {
            taken.sums.set(sums.subarray(size * from, size * to), size * place);
            if (deviations.length) taken.deviations.set(deviations.subarray(from, to), place);
        });
        this.near.fill(0);  // each is taken once
        return taken;
    }
    put(taken) {
        const sums = this.sums, deviations = this.deviations, size = 3 * this.scene.replications;
        this.blocks(taken.first, taken.step, (place, from, to) => {
            sums.set(taken.sums.subarray(size * place, size * (place + to - from)), size * from);
            if (deviations.length) deviations.set(taken.deviations.subarray(place, place + to - from), from);
        });
        this.calls.add_near(...this.texts(taken.near));  // ends these views
    }
}

if (typeof exports === "object") exports.Renderer = Renderer;
