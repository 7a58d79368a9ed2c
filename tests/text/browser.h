// text/browser.h  pages in Chromium: a script in the page operates it, and writes what it saw into
// attributes of the root
#pragma once
#include <cstdlib>
#include <map>

#include "text/folder.h"

namespace penumbra {

inline std::string browser() {
    for (const std::string name : {"chromium", "chromium-browser", "google-chrome"})
        if (std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0) return name;
    MESSAGE("no Chromium on this machine (Debian: apt-get install chromium): not tested");
    return "";
}

// The browser's stdout, or an empty string if the browser does not end.
inline std::string browse(const Folder& folder, const std::string& flags,
                          const std::string& address) {
    const std::string command =
        "timeout 120 " + browser() +
        " --headless=new --no-sandbox --disable-gpu --hide-scrollbars --virtual-time-budget=6000 "
        "--user-data-dir='" +
        folder / "profile" + "' " + flags + " 'file://" + folder / address + "' >'" +
        folder / "out" + "' 2>/dev/null";
    return std::system(command.c_str()) == 0 ? folder.read("out") : "";
}

// The attributes of a page's root, without "data-".
inline std::map<std::string, std::string> seen_in(const std::string& dom) {
    std::map<std::string, std::string> all;
    const size_t html = std::min(dom.find("<html"), dom.size());
    const std::string root = dom.substr(html);
    for (size_t at = 0; (at = root.find("data-", at)) < root.find("<head");) {
        const size_t quote = root.find('"', at), end = root.find('"', quote + 1);
        all[root.substr(at + 5, quote - at - 6)] = root.substr(quote + 1, end - quote - 1);
        at = end;
    }
    return all;
}

// What a page says that has this script at its end.  The script may use these functions.
inline std::string driven_by(const std::string& script) {
    return R"js(<script>{
const root = document.documentElement, say = (name, value) => root.setAttribute("data-" + name, value);
addEventListener("error", event => say("error", event.message));
const soon = (ms = 50) => new Promise(done => setTimeout(done, ms));
const pair = document.querySelector("image-pair"), stage = pair.stage;
const $ = name => pair.find(name) ?? document.getElementById(name);
const key = (key, shiftKey) => stage.dispatchEvent(
    new KeyboardEvent("keydown", { key, shiftKey, bubbles: true, cancelable: true }));
const set = (name, value) => {
    $(name).value = value;
    $(name).dispatchEvent(new Event("input", { bubbles: true }));
};
const drawn = (who, x, y) => $("image-" + who).getContext("2d").getImageData(x, y, 1, 1).data;
const cells = k => [...$("values").querySelectorAll("tbody tr")[k].children].map(c => c.textContent);
const mouse = (fx, fy, buttons = 0, who = "a") => {
    const view = document.querySelector(`.${who} .view`), box = view.getBoundingClientRect();
    view.dispatchEvent(new PointerEvent("pointermove", { bubbles: true, buttons,
        clientX: box.left + fx * box.width, clientY: box.top + fy * box.height }));
};
addEventListener("load", async () => {
)js" + script +
           "say(\"done\", 1); }); }</script>";
}

}  // namespace penumbra
