// show/show.h  1  the picture while it renders: a page that shows it (--show)
//
// Beside a.png lie a.html, the page, and a.html.js, which tells it when there is a new picture: a
// page from a disk may load scripts and pictures, but read no file.
#pragma once
#include <chrono>

#include "app/render.h"

namespace penumbra {

// It knows its files by its own name.  A picture stays until the next one is there.
inline constexpr std::string_view show_page =
    R"(<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>penumbra --show</title>
<meta name="viewport" content="width=device-width"><style>
body { font: 16px/1.4 system-ui, sans-serif; margin: 1em; color: #222; background: #fff }
h1 { font-size: 1.2em; margin: 0; border-left: .5em solid #c60; padding-left: .5em }
h1.done { border-color: #292 } h1.stopped { border-color: #b00 }
p { margin: .5em 0; overflow-wrap: anywhere } img { max-width: 100%; image-rendering: pixelated }
@media (prefers-color-scheme: dark) { body { color: #ddd; background: #181818 } }
</style><h1>nothing yet</h1><p></p><img alt="the picture so far" hidden>
<script>
const page = location.href.replace(/[?#].*/, ""), part = name => document.querySelector(name);
let last;
function now(stamp, state, has_picture, words) {
    if (stamp === last) return;
    last = stamp;
    part("h1").className = state;
    part("h1").textContent = state + ", " + new Date(stamp).toLocaleTimeString();
    part("p").textContent = words;
    part("img").hidden = !has_picture;
    if (has_picture) part("img").src = page.replace(/html$/, "png?") + stamp;
}
function ask() {
    const script = document.createElement("script");
    script.src = page + ".js?" + Date.now();
    script.onload = script.onerror = () => script.remove();
    document.head.append(script);
}
ask();
setInterval(ask, 500);
</script>
)";

// When the next picture may be written, after one that took from `start` to `end`: pictures take at
// most a 20th of the time.
template <class Time>
Time next_picture(Time start, Time end, typename Time::duration interval) {
    return end + std::max(interval, 19 * (end - start));
}

class Show {
    using clock = std::chrono::steady_clock;

public:
    Show() = default;
    Show(const Show&) = delete;
    ~Show() {  // an error ends the run
        try {
            if (!page_.empty()) tell_page("stopped", words_);
        } catch (const std::exception&) {
        }
    }

    OptionTable rows() {
        const char* help =
            "write the PNG every second at most while it renders, and beside it NAME.html, which "
            "shows it";
        return in_group("Output", {{"--show", "", help, "", [this](Text) { wanted_ = true; }}});
    }

    // Writes a page without a picture.  Throws UserError if there will be none, if files cannot be
    // written, or if they would replace a page of somebody else.
    void begin(const Options& o, const std::vector<std::string>& outputs) {
        if (!wanted_) return;
        const auto is_png = [](const std::string& path) { return path.ends_with(".png"); };
        const auto png = std::ranges::find_if(outputs, is_png);
        if (png == outputs.end()) throw UserError("--show: needs -o FILE.png");
        const std::string page = png->substr(0, png->size() - 3) + "html";
        const std::string_view first_line = show_page.substr(0, show_page.find('\n'));
        for (const auto& [path, first] :
             {std::pair{page, first_line}, std::pair{page + ".js", std::string_view("now(")}}) {
            check_writable(path);
            const std::string name = true_name(path),
                              there = std::filesystem::exists(path) ? read_file(path) : "";
            if (name == true_name(o.stats) || name == true_name(o.keep) ||
                !(there.empty() || there.starts_with(first)))
                throw UserError(path + ": --show would replace a page that is not its own");
        }
        png_ = *png, page_ = page;
        tell_page("rendering", o.scene);
        write_file(page, show_page);
        tell(o, "open " + page + " in a browser");
    }

    // At most every second.  If it fails, the render continues, and the next picture may fit.
    void picture_now_and_then(const Options& o, const Scene& scene, const Plan& plan,
                              const Film& film, const Spent& spent,
                              clock::time_point start = clock::now()) {
        if (page_.empty() || !film.has_samples() || start < next_) return;
        try {
            picture(o, scene, plan, film, spent);
        } catch (const std::exception& e) {
            if (words_ != e.what())
                std::fprintf(stderr, "%s; the render continues\n", printable(e.what()).c_str());
            words_ = e.what();
        }
        next_ = next_picture(start, clock::now(), std::chrono::seconds(1));
    }

    // The picture first: the page then asks for it.
    void picture(const Options& o, const Scene& scene, const Plan& plan, const Film& film,
                 const Spent& spent) {
        Options in_silence = o;
        in_silence.quiet = true, in_silence.stats = "";
        Run run = run_of(film, plan, spent, Stop::no);
        run.is_radiance = !o.view.of;
        write_picture(in_silence, {}, scene, {png_}, {image_of(film), run, ""});
        has_picture_ = true;
        tell_page("rendering", summary(o.scene, run));
    }

    // The last picture is written.
    void end(const Options& o, const Run& run) {
        if (page_.empty()) return;
        has_picture_ = run.spp > 0;
        tell_page(run.interrupted() ? "stopped" : "done", summary(o.scene, run, o.error));
        page_.clear();
    }

private:
    bool wanted_ = false, has_picture_ = false;
    std::string png_, page_;  // "": nothing is shown
    std::string words_;       // of the last picture, or why there was none
    clock::time_point next_ = {};
    int64_t stamp_ = 0;

    // Another stamp each time: milliseconds since 1970, as a page knows time.
    void tell_page(const char* state, const std::string& words) {
        const auto since = std::chrono::system_clock::now().time_since_epoch();
        const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(since).count();
        stamp_ = std::max(stamp_ + 1, int64_t(ms));
        words_ = words;
        write_file(page_ + ".js", "now(" + std::to_string(stamp_) + ", \"" + state + "\", " +
                                      json::truth(has_picture_) + ", " + json::string(words) +
                                      ");\n");
    }
};

}  // namespace penumbra
