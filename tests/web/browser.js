// web/browser.js  a page in headless Chromium, which this process drives through a pipe
"use strict";
const { spawn, spawnSync } = require("child_process"), fs = require("fs"), os = require("os"), path = require("path");

const program = ["chromium", "chromium-browser", "google-chrome"].find(name => spawnSync("sh", ["-c", `command -v ${name}`]).status === 0);

const words_of = details => details.exception?.description ?? details.text;

// A browser, or null if this machine has none.  Messages of the DevTools protocol end with a 0.
async function open() {
    if (!program) return null;
    const profile = fs.mkdtempSync(path.join(os.tmpdir(), "penumbra-"));
    const child = spawn(program, ["--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--remote-debugging-pipe",
        `--user-data-dir=${profile}`, "about:blank"], { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"] });
    const waiting = new Map(), problems = [];
    let calls = 0, session, rest = "";
    child.stdio[4].setEncoding("utf8").on("data", text => {
        const messages = (rest + text).split("\0");
        rest = messages.pop();
        for (const { id, result, error, method, params } of messages.map(JSON.parse)) {
            if (id) {
                const { resolve, reject } = waiting.get(id);
                waiting.delete(id);
                error ? reject(Error(error.message)) : resolve(result);
            }
            const is_bad = level => ["error", "warning", "assert"].includes(level);
            if (method === "Runtime.exceptionThrown") problems.push(words_of(params.exceptionDetails));
            if (method === "Runtime.consoleAPICalled" && is_bad(params.type))
                problems.push(params.args.map(argument => argument.value ?? argument.description).join(" "));
            if (method === "Log.entryAdded" && is_bad(params.entry.level)) problems.push(params.entry.text);
        }
    });
    // Who waits for a browser that has ended would wait for ever, and Node.js would end without a word.
    const ended = new Promise(resolve => child.on("exit", resolve));
    ended.then(() => waiting.forEach(({ reject }) => reject(Error("the browser has ended"))));
    const send = (method, params = {}, own = session) => new Promise((resolve, reject) => {
        waiting.set(++calls, { resolve, reject });
        child.stdio[3].write(JSON.stringify({ id: calls, method, params, ...(own && { sessionId: own }) }) + "\0");
    });
    const { targetInfos } = await send("Target.getTargets");
    const { targetId } = targetInfos.find(target => target.type === "page");
    session = (await send("Target.attachToTarget", { targetId, flatten: true })).sessionId;
    for (const domain of ["Page", "Runtime", "Log"]) await send(`${domain}.enable`);
    return {
        problems, send,
        async size(width, height, is_dark = false) {
            await send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
            await send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: is_dark ? "dark" : "light" }] });
        },
        async go(address) {
            const [file, hash = ""] = address.split(/(?=#)/);
            await send("Page.navigate", { url: "about:blank" });
            await send("Page.navigate", { url: `file://${path.resolve(file)}${hash}` });
            while (await this.run("document.readyState") !== "complete") await new Promise(soon => setTimeout(soon, 20));
        },
        // The value of an expression in the page; a Promise is waited for.
        async run(expression) {
            const { result, exceptionDetails } = await send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
            if (exceptionDetails) throw Error(words_of(exceptionDetails));
            return result.value;
        },
        async press(key) {
            for (const type of ["keyDown", "keyUp"]) await send("Input.dispatchKeyEvent", { type, key, code: key });
        },
        async click(x, y) {
            for (const type of ["mousePressed", "mouseReleased"])
                await send("Input.dispatchMouseEvent", { type, x, y, button: "left", clickCount: 1 });
        },
        async tap(x, y) {
            await send("Emulation.setTouchEmulationEnabled", { enabled: true });
            await send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [{ x, y }] });
            await send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
            await send("Emulation.setTouchEmulationEnabled", { enabled: false });
        },
        async shoot(file, is_whole = true) {
            const { data } = await send("Page.captureScreenshot", { captureBeyondViewport: is_whole });
            fs.writeFileSync(file, Buffer.from(data, "base64"));
        },
        async close() {
            await send("Browser.close", {}, undefined).catch(() => 0);
            await ended;
            fs.rmSync(profile, { recursive: true, force: true });
        },
    };
}

module.exports = { open };
