// web/render.js  4  the module in Node.js, as a program: render.js MODULE.wasm [options] -o FILE.pfm SCENE
//
// tests/everywhere compares its pictures with those of build/penumbra; so does --pixel X,Y what it prints.
"use strict";
const fs = require("fs"), path = require("path"), { Renderer } = require("./renderer.js");

const [module_file, ...words] = process.argv.slice(2), own = { "-o": "", "--pixel": "", "--sample": "0,0" };
const scene_file = words.pop(), options = [];
for (let i = 0; i < words.length; ++i)
    if (words[i] in own) own[words[i]] = words[++i];
    else options.push(words[i]);

// Meshes and their materials may be what the scene names.
const beside = path.dirname(scene_file), files = {};
for (const folder of [beside, "build"])
    for (const name of fs.existsSync(folder) ? fs.readdirSync(folder) : [])
        if (/\.(obj|mtl)$/.test(name)) files[path.join(folder, name)] = fs.readFileSync(path.join(folder, name));

// The bytes of a PFM file: the bottom row first.
function pfm(image, width, height) {
    const rows = [Buffer.from(`PF\n${width} ${height}\n-1.0\n`)];
    for (let y = height - 1; y >= 0; --y) rows.push(Buffer.from(image.slice(3 * width * y, 3 * width * (y + 1)).buffer));
    return Buffer.concat(rows);
}

(async () => {
    const renderer = await Renderer.of(await WebAssembly.compile(fs.readFileSync(module_file)));
    if (!renderer.calls.rounds_once()) throw Error(`${module_file}: fma rounds twice on this processor`);
    let scene;
    try {
        scene = renderer.load({ name: scene_file, text: fs.readFileSync(scene_file), files, options: options.join(" ") });
    } catch (error) {
        console.error(error.message);
        process.exit(2);
    }
    const numbers = word => own[word].split(",").map(Number);
    if (own["--pixel"]) return process.stdout.write(renderer.path(...numbers("--pixel"), ...numbers("--sample")).printed);
    while (renderer.is_pilot && !renderer.is_pilot_done) renderer.add(renderer.n + 1);
    if (renderer.is_pilot) renderer.choose();
    renderer.add(scene.samples);
    if (own["-o"]) fs.writeFileSync(own["-o"], pfm(renderer.image, scene.width, scene.height));
    if (!options.includes("--quiet")) console.error(renderer.error);
})().catch(error => { console.error(error.message); process.exit(1); });
