// labs/trade_style.h  1  how the page of a trade looks: light or dark, wide or on a telephone
#pragma once

inline constexpr const char* trade_style = R"css(
:root { color-scheme: light dark; --ground: #fff; --card: #f4f5f7; --ink: #1b1f24; --soft: #545d68;
        --line: #c9ced6; --link: #0550ae; --focus: #c04a00; }
@media (prefers-color-scheme: dark) {
    :root { --ground: #14171b; --card: #1e2227; --ink: #e8eaed; --soft: #a9b1bb; --line: #454c55;
            --link: #82b8ff; --focus: #ffb454; }
    svg > rect { fill: #1e2227; }
    svg text[fill="#222222"], svg text[fill="#000000"], svg circle[fill="#000000"] { fill: #e8eaed; }
    svg polyline[stroke="#e2e2e2"] { stroke: #3a4048; }
    svg polyline[stroke="#000000"] { stroke: #e8eaed; }
    svg polyline[stroke="#b8b8b8"] { stroke: #59616b; }
    svg circle[fill="#b8b8b8"] { fill: #59616b; }
    .legend b[style*="#000000"] { background: #e8eaed !important; color: #000 !important; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 76rem; padding: 1rem; background: var(--ground); color: var(--ink);
       font: 1rem/1.5 system-ui, "Helvetica Neue", Arial, sans-serif; }
h1, h2, h3 { line-height: 1.2; margin: 1.6em 0 .5em; }
h1 { margin-top: .5em; }
p, ol { max-width: 46rem; }
a { color: var(--link); }
:focus-visible { outline: 3px solid var(--focus); outline-offset: 2px; }
code { font: .92em ui-monospace, Menlo, Consolas, monospace; overflow-wrap: anywhere; }
code span, .law { white-space: nowrap; }
nav ul { display: flex; flex-wrap: wrap; gap: .3rem 1rem; padding: 0; list-style: none; }
nav a { display: inline-block; padding: .2rem 0; }
.scene, #compare { border-top: 1px solid var(--line); margin-top: 2rem; }
html:not(.scripted) .scripted { display: none; }
[hidden] { display: none !important; }

.scroll { overflow-x: auto; max-width: 100%; margin: .5rem 0 1rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
caption { text-align: left; color: var(--soft); padding-bottom: .3rem; }
caption span { display: inline-block; max-width: calc(100vw - 2rem); }
small { color: var(--soft); }
th, td { padding: .25rem .7rem .25rem 0; text-align: left; vertical-align: top;
         border-bottom: 1px solid var(--line); }
.number { text-align: right; }
tbody .number { white-space: nowrap; }
th { font-weight: 600; }
tbody th { font-weight: 400; }
summary { cursor: pointer; padding: .3rem 0; }

.curves svg { display: block; width: 100%; max-width: 640px; height: auto; }
.curves { margin: 0; display: grid; grid-template-columns: minmax(0, 40rem) minmax(16rem, 1fr);
          gap: 0 1.5rem; }
.curves figcaption { grid-row: 2; margin-bottom: .6rem; }
@media (max-width: 60rem) { .curves { display: block; } }
.legend { list-style: none; margin: .3rem 0 0; padding: 0; font-size: .92rem; }
.legend li { display: flex; gap: .5rem; padding: .1rem 0; }
.legend code { font-size: 1em; }
.legend b { flex: none; width: 1.4rem; height: 1.4rem; line-height: 1.4rem; text-align: center;
            border-radius: 50%; color: #fff; font-size: .8rem; }

img { display: block; width: 100%; height: auto; image-rendering: pixelated; background: var(--card); }
.shots { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(14rem, 46%), 1fr));
         gap: 1.2rem .8rem; }
.shots figure { margin: 0; }
.shots .map { margin-top: .3rem; }
figcaption { font-size: .9rem; margin-top: .3rem; color: var(--soft); }
figcaption code { color: var(--ink); }
.scale { max-width: 24rem; margin: .8rem 2.5rem 1.2rem 0; font-size: .85rem; }
.scale img { height: .9rem; }
.scale ul { position: relative; height: 1.4rem; margin: 0; padding: 0; list-style: none; }
.scale li { position: absolute; transform: translateX(-50%); white-space: nowrap; }
.scale li:first-child { transform: none; }

#controls { display: flex; flex-wrap: wrap; gap: .6rem 1rem; align-items: end;
            font-size: .92rem; }
h2[tabindex] { width: fit-content; }
#controls label { display: flex; flex-direction: column; max-width: 100%; }
#controls .wide { flex: 1 1 24rem; }
#controls fieldset { display: flex; flex-wrap: wrap; gap: 0 1rem; border: 1px solid var(--line);
                     border-radius: .3rem; margin: 0; padding: .2rem .7rem .3rem; min-width: 0; }
#controls fieldset label { flex-direction: row; gap: .35rem; align-items: center; min-height: 1.8rem; }
select, button, input { font: inherit; color: inherit; min-height: 2.1rem; max-width: 100%; }
select, button, input[type=number] { background: var(--card); border: 1px solid var(--soft);
                                     border-radius: .3rem; padding: .1rem .5rem; }
input[type=number] { width: 4.5rem; }
input[type=radio] { min-height: 0; }
#stage { display: grid; grid-template-columns: 1fr 1fr; gap: .3rem .8rem; margin: 1rem 0 .5rem; }
#stage p { margin: 0; font-size: .92rem; align-self: end; grid-row: 1; }
#name-b { grid-column: 2; }
.frame { position: relative; grid-row: 2; touch-action: pan-y; cursor: crosshair; align-self: start; }
.mark { position: absolute; pointer-events: none; outline: 1px solid #fff; box-shadow: 0 0 0 2px #000;
        left: calc(100% * var(--x) / var(--w)); top: calc(100% * var(--y) / var(--h));
        width: calc(100% / var(--w)); height: calc(100% / var(--h)); }
#stage[data-mode=flip] .frame, #stage[data-mode=wipe] .frame { grid-column: 1 / -1; }
#stage[data-mode=flip] p { grid-column: 1 / -1; }
#stage[data-mode=flip][data-shown=a] .b, #stage[data-mode=flip][data-shown=b] .a { visibility: hidden; }
#stage[data-mode=wipe] .b.frame { clip-path: inset(0 0 0 calc(1% * var(--wipe))); }
#stage[data-mode=wipe] .b.frame::before { content: ""; position: absolute; inset: 0 auto 0
    calc(1% * var(--wipe)); border-left: 2px solid #fff; box-shadow: -1px 0 #000; z-index: 1; }
#stage[data-mode=flip], #stage[data-mode=wipe] { max-width: 56rem; }
#live { display: block; min-height: 1.5em; }
.lenses { display: flex; flex-wrap: wrap; gap: .8rem 2rem; align-items: start; }
.lenses > div { display: flex; gap: .6rem; }
.lenses figure { margin: 0; text-align: center; }
canvas { display: block; width: 9rem; max-width: 28vw; background: var(--card); image-rendering: pixelated; }
@media (max-width: 40rem) {
    #stage[data-mode=side], #stage[data-mode=error] { grid-template-columns: 1fr; }
    #stage[data-mode=side] > *, #stage[data-mode=error] > * { grid-column: 1; grid-row: auto; }
    th, td { padding-right: .45rem; font-size: .85rem; }
    td.number > span { display: block; }
}
)css";
