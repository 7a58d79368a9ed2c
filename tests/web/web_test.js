// web/web_test.js  the playground in headless Chromium: bits, numbers, errors, keys; web_test.cpp runs it
"use strict";
const { execFileSync, spawnSync } = require("child_process"), fs = require("fs"), os = require("os"), path = require("path");
const { open } = require("./browser.js");

const penumbra = process.argv[2], page = "build/web/playground.html", folder = fs.mkdtempSync(path.join(os.tmpdir(), "penumbra-web-"));
const short = value => String(value).slice(0, 300);
function expect(what, is, wanted) { if (is !== wanted) throw Error(`${what}: ${short(is)}, expected ${short(wanted)}`); }

// What the program draws, as rows from the top, and what it prints.
function drawn(scene, options, ...more) {
    const file = path.join(folder, "picture.pfm");
    execFileSync(penumbra, ["--quiet", ...options.split(" ").filter(Boolean), ...more, "-o", file, scene]);
    const bytes = fs.readFileSync(file), [, width, height] = bytes.toString("latin1", 0, 40).match(/^PF\n(\d+) (\d+)/).map(Number);
    const rows = bytes.subarray(bytes.length - 12 * width * height);
    const from_bottom = y => rows.subarray(12 * width * y, 12 * width * (y + 1));
    return Buffer.concat(Array.from({ length: height }, (_, y) => from_bottom(height - 1 - y))).toString("base64");
}
const printed = (scene, options) => execFileSync(penumbra, [...options.split(" "), scene]).toString().replace(/^.*\n/, "");

const address = state => `${page}#${new URLSearchParams(state)}`;
const bits = side => `btoa(Array.from(new Uint8Array(figure.sides[${side}].image.buffer), x => String.fromCharCode(x)).join(""))`;
const finished = "figure.finished()", problem = "$('problem').textContent";
const until = async (browser, condition) => {
    for (let k = 0; !await browser.run(condition); ++k) {
        if (k > 12000) throw Error(`never: ${condition}`);
        await new Promise(soon => setTimeout(soon, 50));
    }
};

// Makes figures anew with so many workers.
const with_workers = workers => `${finished}.then(() => {
    Object.defineProperty(navigator, "hardwareConcurrency", { value: ${workers}, configurable: true });
    workers.all.splice(0).forEach(worker => worker.terminate()); figure.reload(); return ${finished}; })`;

const tests = {
    async "pictures have the program's bits, whatever their size and the number of workers"(browser) {
        for (const [scene, options, size = "40x20", samples = 24] of [["cornell", ""], ["materials", "--sampler halton --light nee"],
            ["mesh", "--light none --direction uniform"], ["cornell36obj", "--sampler independent --seed 7"],
            ["atelier", "--view normal"], ["lanterns", "--sampler stratified --replications 4 --depth 3"],
            ["cornell", "", "16x8"], ["materials", "", "1x1", 50], ["panel", "", "1x1", 3], ["cornell", "", "40x20", 1]])
            for (const workers of size === "40x20" && samples > 1 ? [1, 3] : [3]) {
                await browser.go(address({ scene, a: options, size, samples }));
                await browser.run(with_workers(workers));
                expect(`${scene} ${options}, workers`, await browser.run("workers.all.length"), workers);
                expect(`${scene} ${options} ${size} ${samples}, ${workers} workers`, await browser.run(bits(0)),
                    drawn(`scenes/${scene}.scene`, `--size ${size} --spp ${samples} ${options}`));
            }
    },
    async "an error is the program's, and so is the reason why it is not known"(browser) {
        const sparks = fs.readFileSync("scenes/calibration/hard", "utf8").split(/^@@ /m), file = path.join(folder, "spark.scene");
        for (const [name, options, reason] of [["spark_in_mirror", "", "by way of mirrors or glass"], ["spark", "", "smaller than a pixel"],
            ["spark", "--replications 4 --light none", "smaller than a pixel"], ["bulb", "--depth 0 --light nee", "no sample found light"],
            ["cornell", "", ""]]) {
            const text = sparks.find(part => part.startsWith(`${name}\n`))?.replace(/^.*/, "") ?? fs.readFileSync(`scenes/${name}.scene`, "utf8");
            fs.writeFileSync(file, text);
            drawn(file, `--size 40x20 --spp 64 ${options}`, "--stats", path.join(folder, "stats.json"));
            const stats = JSON.parse(fs.readFileSync(path.join(folder, "stats.json")));
            await browser.go(address({ scene: "cornell", text, a: options, size: "40x20", samples: 64 }));
            await browser.run(with_workers(3));
            const { spp, d_rel, doubt } = await browser.run("figure.sides[0].error");
            expect(`${name}: samples`, spp, stats.samples_per_pixel);
            expect(`${name}: d_rel`, d_rel, stats.d_rel_by_spread);
            expect(`${name}: reason`, doubt, stats.d_rel_reason ?? "");
            expect(`${name}: kind of reason`, doubt.includes(reason) && (doubt === "") === (reason === ""), true);
            const shown = await browser.run("figure.numbers.querySelector('.error').textContent");
            expect(`${name}: shown`, reason ? shown : shown.replace(/[\d.]+/g, "1"), reason ? `not known: ${doubt}` : "1 % ± 1 %");
        }
    },
    async "the module with fma in software has the same bits"(browser) {
        await browser.go(address({ scene: "cornell", size: "40x20", samples: 8 }));
        await browser.run(finished);
        const software = await browser.run(`(async () => {
            const bytes = Uint8Array.from(atob(penumbra.modules.software), letter => letter.charCodeAt(0));
            const code = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
            const r = await Renderer.of(await WebAssembly.compile(code)); r.load({ ...figure.sides[0].scene });
            while (!r.is_pilot_done) r.add(r.n + 1); r.choose(); r.add(r.scene.samples);
            const image = r.image; return r.calls.rounds_once() + " " + image.every((x, i) => x === figure.sides[0].image[i]); })()`);
        expect("software", software, "1 true");
    },
    async "a path has the numbers of --pixel, and its own sum"(browser) {
        for (const [scene, x, y, options] of [["cornell", 20, 12, ""], ["materials", 9, 15, "--light nee --roulette 0.9"],
            ["panel", 30, 11, "--sampler halton"]]) {
            await browser.go(address({ scene, size: "40x20", samples: 8, a: options, pixel: `${x},${y}` }));
            await browser.run(finished);
            for (const [i, half] of [[0, 0], [5, 1]]) {
                await browser.run(`figure.sample = ${i}, figure.half = ${half}, figure.show_path()`);
                const text = printed(`scenes/${scene}.scene`, `--size 40x20 --pixel ${x},${y} --sample ${i},${half} ${options}`.trim());
                expect(`${scene} ${i},${half}`, await browser.run("figure.path.printed"), text);
                // Each line of numbers is a member of a vertex, in order.
                const told = await browser.run("figure.path");
                for (const name of ["throughput", "p", "n", "emission", "f", "wi"])
                    expect(`${scene} ${i},${half}: ${name}`, JSON.stringify(told.vertices.filter(v => v.p && v[name]).map(v => v[name])),
                        JSON.stringify([...text.matchAll(new RegExp(`^  ${name}: (.*)`, "gm"))].map(m => m[1].split(" ").map(Number))));
                expect("light samples", told.vertices.filter(v => v.light?.occluded).length, text.match(/, occluded$/gm)?.length ?? 0);
                for (const { light: l, next, k } of told.vertices) {
                    if (next) expect("the next throughput", JSON.stringify(next), JSON.stringify(told.vertices[k + 1].throughput));
                    const is_reflected = (f, c) => Math.abs(f * l.Le[c] * l.cosine / l.pdf * l.weight - l.L[c]) <= 1e-12 * l.L[c];
                    if (l && !l.occluded) expect("f of the light sample", l.f.every(is_reflected), true);
                }
                expect("the sum", JSON.stringify(told.vertices.at(-1).L), JSON.stringify(told.L));
                expect("steps", told.vertices.filter(v => v.p).length, text.match(/^vertex /gm)?.length ?? 0);
            }
        }
    },
    async "an error in a scene is shown at its line, in the program's words"(browser) {
        const text = "camera 0 0 5  0 0 0  40\ndiffuse grey 0.5 0.5 0.5\nlight lamp 1 1 1\nsphere 0 0 0  1  gray\n";
        const file = path.join(folder, "bad.scene");
        fs.writeFileSync(file, text);
        const words = spawnSync(penumbra, [file]).stderr.toString().trim().replace(/^.*bad.scene:(\d+): /, "Line $1: ");
        await browser.go(address({ scene: "cornell", text, size: "40x20", samples: 4 }));
        await until(browser, problem);
        expect("the message", await browser.run(problem), words);
        const marked = "[...document.querySelectorAll('#gutter .bad')].map(line => line.textContent).join()";
        expect("the line that is marked", await browser.run(marked), "4");
        await browser.run("$('text').value = $('text').value.replace('gray', 'lamp'); $('text').dispatchEvent(new Event('input'))");
        await until(browser, `!${problem} && figure.sides[0]?.image`);
        await browser.run(finished);
        expect("mended", await browser.run(problem), "");
        fs.writeFileSync(file, text.replace("gray", "lamp"));
        expect("its picture", await browser.run(bits(0)), drawn(file, "--size 40x20 --spp 4"));
        await browser.run("$('size').value = '30000x30000'; changed()");
        await until(browser, problem);
        expect("a film without room", await browser.run(problem), "--size: a film of more than 1 GB");
        await browser.run("$('size').value = '40x20'; $('a-light').value = 'none'; $('a-depth').value = 'x'; changed()");
        await until(browser, `${problem}.startsWith("--depth")`);
        expect("an option", await browser.run(problem), spawnSync(penumbra, ["--depth", "x", file]).stderr.toString().trim());
    },
    async "an error after a worker has begun is shown, and the next picture is right"(browser) {
        const text = "camera 0 1e-5 5e-5  0 0 0  40\ndiffuse grey 0.5 0.5 0.5\n" +
            "quad -1e-4 0 -1e-4  0 0 2e-4  2e-4 0 0  grey\npointlight 0 1e-5 0  1e30 1e30 1e30\n";
        const file = path.join(folder, "bright.scene");
        fs.writeFileSync(file, text);
        await browser.go(address({ scene: "cornell", text, size: "40x20", samples: 4 }));
        await until(browser, problem);
        const told = await browser.run(problem), which = told.match(/^a sample is not finite: (--pixel \d+,\d+ --sample \d+,\d+)$/)?.[1];
        const L = printed(file, `--size 40x20 ${which}`).match(/^L: (.*)/m)[1].split(" ");
        expect("the sample is more than a float holds", L.every(x => Math.fround(+x) === Infinity), true);
        const is_right = async what => {
            await browser.run(`$("text").value = penumbra.scenes.cornell; $("samples").value = 8; changed(); figure.reload(); ${finished}`);
            expect(what, await browser.run(bits(0)), drawn("scenes/cornell.scene", "--size 40x20 --spp 8"));
            expect("no message", await browser.run("figure.message.textContent"), "");
        };
        await is_right("after a sample that is not finite");

        // A worker that ends ends all: pictures that render say so, and those that go on later.
        const end = "workers.all[0].dispatchEvent(new ErrorEvent('error', { message: 'no memory' }))";
        await browser.run("figure.toggle.click()");
        await browser.run(`figure.sides[0].limit = Infinity; figure.run(); ${end}`);
        await until(browser, problem);
        expect("while it renders", await browser.run(problem), "no memory");
        await is_right("after a worker that ended");
        await browser.run(`${end}; figure.toggle.click()`);
        await until(browser, problem);
        expect("before it goes on", await browser.run(problem), "a worker ended");
        await is_right("after workers that had ended");
    },
    async "what a scene is called is text, and no markup"(browser) {
        const text = fs.readFileSync("scenes/cornell.scene", "utf8").replaceAll("white", "<u>white</u>");
        await browser.go(address({ scene: "cornell", text, size: "40x20", samples: 4, pixel: "20,17" }));
        await browser.run(finished);
        expect("the material", await browser.run("figure.path.vertices[0].material"), "<u>white</u>");
        expect("shown", await browser.run("figure.path_box.textContent.includes('<u>white</u>')"), true);
        expect("elements", await browser.run("figure.shadowRoot.querySelectorAll('u').length"), 0);
    },
    async "A and B stop at equal samples, or at equal time; the slider divides them"(browser) {
        await browser.go(address({ scene: "cornell", size: "40x20", samples: 32, b: "--light none" }));
        await browser.run(finished);
        for (const [side, options] of [[0, ""], [1, "--light none"]])
            expect(`side ${side}`, await browser.run(bits(side)), drawn("scenes/cornell.scene", `--size 40x20 --spp 32 ${options}`));
        await browser.run("figure.divide.value = 250; figure.divide.dispatchEvent(new Event('input'))");
        expect("divided", await browser.run("figure.canvases[1].style.clipPath"), "inset(0px 0px 0px 25%)");
        expect("the path left of it", await browser.run("figure.open_path(9, 3), figure.side_of_path === figure.sides[0]"), true);
        expect("the path right of it", await browser.run("figure.open_path(10, 3), figure.side_of_path === figure.sides[1]"), true);
        // B begins passes as long as it has worked less than A, which is done, and no longer.
        await browser.run(`{ const [a, b] = figure.sides, pass = b.pass; a.seconds = 0.2; b.seconds = 0; b.before = [];
            b.pass = reference => (b.before.push(b.seconds), pass.call(b, reference)); }
            figure.mode.value = "time"; figure.run(); ${finished}`);
        expect("equal time", await browser.run("figure.sides[1].before.every(seconds => seconds < 0.2) && figure.sides[1].seconds >= 0.2"), true);
        expect("more samples", await browser.run("figure.sides[1].desk.n > figure.sides[1].limit && figure.sides[0].desk.n === figure.sides[0].limit"), true);
        expect("B is done by samples again", await browser.run("figure.mode.value = 'samples'; figure.next_side === null && figure.sides[1].is_done"), true);
        expect("curves", await browser.run("figure.shadowRoot.querySelectorAll('.plot polyline').length"), 4);
    },
    async "the true error is that of the picture against its reference"(browser) {
        const floats = text => new Float32Array(new Uint8Array(Buffer.from(text, "base64")).buffer);
        const reference = floats(drawn("scenes/cornell.scene", "--size 40x20 --spp 4096 --seed 1"));
        await browser.go(address({ scene: "cornell", size: "40x20", samples: 32 }));
        await browser.run(`figure.reference = new Float32Array(${JSON.stringify([...reference])}); figure.reload()`);
        await browser.run(finished);
        let off = 0, norm = 0;
        floats(drawn("scenes/cornell.scene", "--size 40x20 --spp 32")).forEach((x, i) => {
            off += (x - reference[i]) ** 2;
            norm += reference[i] ** 2;
        });
        expect("the last true error", await browser.run("figure.sides[0].curve.at(-1)[2]"), Math.sqrt(off / norm));
        const shown = await browser.run("figure.numbers.querySelectorAll('td')[3].textContent");
        expect("the table", shown, `${+(100 * Math.sqrt(off / norm)).toPrecision(3)} %`);
    },
    async "buttons go from vertex to vertex, and from sample to sample"(browser) {
        await browser.go(address({ scene: "cornell", size: "40x20", samples: 4, pixel: "20,12" }));
        await browser.run(finished);
        const press = act => browser.run(`figure.path_box.querySelector('[data-act="${act}"]').click()`);
        for (const act of ["sample 1", "sample 1", "sample -1", "half 1", "vertex 1"]) await press(act);
        expect("the state", await browser.run("[figure.sample, figure.half, figure.vertex].join()"), "1,1,1");
        expect("the text", await browser.run("figure.path_box.querySelector('pre').textContent"),
            printed("scenes/cornell.scene", "--size 40x20 --pixel 20,12 --sample 1,1"));
        expect("the number under the mouse", await browser.run("figure.path_box.querySelector('.number').title"),
            await browser.run("figure.path.vertices[1].throughput.join(' ')"));
        for (const act of ["vertex -1", "vertex 1"]) {
            await press(act);
            expect("the point in the picture", await browser.run("figure.overlay.querySelectorAll('.here').length"), 1);
        }
        expect("views", await browser.run("figure.path_box.querySelectorAll('.views svg:has(.here)').length"), 2);
        await press("close");
        expect("closed", await browser.run("figure.cursor"), null);
    },
    async "keys and clicks open paths; the address keeps the state"(browser) {
        await browser.size(1000, 900);
        await browser.go(address({ scene: "cornell", size: "40x20", samples: 4 }));
        await browser.run(finished);
        const box = await browser.run("figure.stage.scrollIntoView(), figure.stage.getBoundingClientRect().toJSON()");
        await browser.click(box.x + box.width * 10.5 / 40, box.y + box.height * 5.5 / 20);
        expect("clicked", await browser.run("figure.cursor.join()"), "10,5");
        await browser.tap(box.x + box.width * 10.5 / 40, box.y + box.height * 6.5 / 20);
        await until(browser, "figure.cursor.join() === '10,6'");
        await browser.click(box.x + box.width * 10.5 / 40, box.y + box.height * 5.5 / 20);
        await browser.run("figure.stage.focus()");
        for (const key of ["ArrowRight", "ArrowDown", "ArrowDown"]) await browser.press(key);
        expect("moved", await browser.run("figure.cursor.join()"), "11,7");
        const state = await browser.run("location.hash");
        expect("kept", new URLSearchParams(state.slice(1)).get("pixel"), "11,7");
        await browser.press("Escape");
        expect("closed", await browser.run("figure.path_box.hidden"), true);
        await browser.go(page + state);
        await browser.run(finished);
        await until(browser, "figure.cursor");
        expect("restored", await browser.run("figure.cursor.join() + ' ' + figure.getAttribute('size')"), "11,7 40x20");
    },
    async "a figure that is not seen costs nothing; without scripts its still picture stays"(browser) {
        const file = path.resolve("build/web/test.html");
        fs.writeFileSync(file, `<!doctype html><html lang="en"><title>test</title><link rel="icon" href="data:,">
            <div style="height:5000px"></div><live-figure scene="cornell" size="40x20" samples="4">still</live-figure>
            <script src="scenes.js"></script><script src="figure.js"></script>`);
        await browser.go(file);
        const figure = "document.querySelector('live-figure')";
        await until(browser, `${figure}.is_seen === false`);  // the observer has told that it is not
        expect("before", await browser.run(`workers.all.length + ${figure}.sides.length + (penumbra.chosen ? 1 : 0)`), 0);
        expect("still", await browser.run(`${figure}.still.hidden`), false);
        await browser.run(`${figure}.scrollIntoView()`);
        await until(browser, `${figure}.is_seen`);
        await browser.run(`${figure}.finished()`);
        expect("after", await browser.run(`${figure}.still.hidden && ${figure}.sides[0].samples > 0`), true);
        await browser.send("Emulation.setScriptExecutionDisabled", { value: true });
        await browser.go(file);
        expect("no script", await browser.run(`${figure}.innerText.trim() + (${figure}.shadowRoot === null)`), "stilltrue");
        await browser.send("Emulation.setScriptExecutionDisabled", { value: false });
        fs.rmSync(file);
    },
};

(async () => {
    const browser = await open();
    if (!browser) return console.log("no Chromium on this machine (Debian: apt-get install chromium): not tested");
    let failed = 0;
    for (const [name, test] of Object.entries(tests)) {
        const begin = Date.now();
        if (process.argv[3] && !name.includes(process.argv[3])) continue;
        browser.problems.length = 0;
        try {
            await browser.size(1280, 1000);
            await test(browser);
            expect("the console", browser.problems.join("; "), "");
            console.log(`passed: ${name} (${(Date.now() - begin) / 1000} s)`);
        } catch (error) {
            console.log(`FAILED: ${name}: ${error.message}`);
            ++failed;
        }
    }
    await browser.close();
    fs.rmSync(folder, { recursive: true });
    process.exitCode = failed > 0 ? 1 : 0;
})();
