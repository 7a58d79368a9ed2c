// web/first_picture.js  prints how soon figures show a picture: node tests/web/first_picture.js [SCENE...], after make web
//
// For each scene, medians of seven loads of a page: seconds from when its figure is seen to its first picture, and until it has so many
// samples per pixel.  Nothing is kept from one load to the next but the file's pages in memory.
"use strict";
const fs = require("fs"), os = require("os"), path = require("path"), { open } = require("./browser.js");

const loads = 7, samples = 64, page = path.resolve("build/web/first_picture.html");
const scenes = process.argv.length > 2 ? process.argv.slice(2) : ["cornell", "materials", "atelier", "mesh"];
const median = values => values.sort((a, b) => a - b)[values.length >> 1];
const range = values => `${median(values).toFixed(2)} s (${values[0].toFixed(2)} to ${values.at(-1).toFixed(2)})`;

// The figure is below the window, as most figures of a chapter are; the clock starts when it is scrolled into view.
const html = scene => `<!doctype html><html lang="en"><title>${scene}</title><link rel="icon" href="data:,"><div style="height: 5000px"></div>
    <live-figure scene="${scene}" samples="${samples}"></live-figure><script src="scenes.js"></script><script src="figure.js"></script>`;
const clocked = `(async () => {
    const figure = document.querySelector("live-figure"), show = figure.show;
    while (figure.is_seen !== false) await new Promise(soon => setTimeout(soon, 20));
    let seen, first;
    figure.show = side => {
        show.call(figure, side);
        first ??= performance.now() - seen;
    };
    seen = performance.now();
    figure.scrollIntoView();
    while (!figure.is_seen) await new Promise(soon => setTimeout(soon, 5));
    await figure.finished();
    return { first: first / 1000, all: (performance.now() - seen) / 1000, info: figure.sides[0].info, module: penumbra.chosen };
})()`;

(async () => {
    const browser = await open();
    if (!browser) throw Error("no Chromium on this machine (Debian: apt-get install chromium)");
    const { product } = await browser.send("Browser.getVersion", {}, undefined);
    console.log(`${os.cpus()[0].model.trim()}, ${os.cpus().length} processors, ${product}; medians of ${loads} loads (least to most)`);
    await browser.size(1280, 1000);
    for (const scene of scenes) {
        fs.writeFileSync(page, html(scene));
        const first = [], all = [];
        let told;
        for (let k = 0; k < loads; ++k) {
            await browser.go(page);
            told = await browser.run(clocked);
            first.push(told.first);
            all.push(told.all);
        }
        console.log(`${scene}, ${told.info.width}x${told.info.height}, module ${told.module}: first picture after ${range(first)}; ` +
            `${samples} samples per pixel after ${range(all)}`);
    }
    fs.rmSync(page);
    await browser.close();
})().catch(error => { console.error(error.message); process.exit(1); });
