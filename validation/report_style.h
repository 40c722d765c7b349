// The style sheet of the report.
#pragma once

#include <string_view>

namespace penumbra {

inline constexpr std::string_view report_style = R"css(
:root {
  color-scheme: light dark;
  --paper: #f5f6f8; --card: #fff; --ink: #1b1e24; --quiet: #5a606b; --line: #dadde3;
  --field: #fff; --link: #0b57c4; --accent: #0b57c4; --on-accent: #fff; --rail: #e4e7ec;
  --good: #116a35; --warn: #7d5200; --bad: #b3211b; --other: #5b3da8; --stage: #e9ebef;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #121317; --card: #1b1d22; --ink: #e8e9ec; --quiet: #a2a7b1; --line: #343841;
    --field: #24272e; --link: #8ab8ff; --accent: #8ab8ff; --on-accent: #0d1422; --rail: #343841;
    --good: #64d18c; --warn: #ecb95a; --bad: #ff8a80; --other: #bda7ff; --stage: #0b0c0f;
  }
}
* { box-sizing: border-box; }
[hidden] { display: none !important; }
body {
  margin: 0 auto; padding: 1.25rem clamp(.75rem, 3vw, 2rem) 3rem; max-width: 92rem;
  background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; font-variant-numeric: tabular-nums;
}
:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
.unseen {
  position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%);
  white-space: nowrap;
}
.quiet, footer, small { color: var(--quiet); }
.small { font-size: .85rem; }
header { margin-bottom: 1rem; }
header p, header nav { margin: 0; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: .1rem 0 .25rem; overflow-wrap: anywhere; }
h2 { font-size: 1.05rem; margin: 0 0 .6rem; }
h3 { font-size: .95rem; margin: 0 0 .5rem; }
a { color: var(--link); overflow-wrap: anywhere; }
.card {
  display: block; background: var(--card); border: 1px solid var(--line); border-radius: .7rem;
  padding: clamp(.75rem, 2vw, 1.25rem); margin: 0 0 1rem; scroll-margin-top: .5rem; min-width: 0;
}
.card > :last-child { margin-bottom: 0; }
.chip {
  display: inline-block; padding: .05em .65em; border: 1.5px solid currentColor;
  border-radius: 1em; font-size: .85rem; font-weight: 600; line-height: 1.5; white-space: nowrap;
  color: var(--other); vertical-align: .12em; letter-spacing: 0;
}
.chip.pass, .good { color: var(--good); }
.chip.warn, td .warn, .gauge.warn { color: var(--warn); }
.chip.fail, .chip.error, .bad { color: var(--bad); }
.good, .bad, td .warn { white-space: nowrap; }

/* the verdict */
.verdict { border-left: .4rem solid var(--other); }
.verdict.pass { border-left-color: var(--good); }
.verdict.warn { border-left-color: var(--warn); }
.verdict:is(.fail, .error) { border-left-color: var(--bad); }
.verdict p { margin: 0 0 .35rem; }
.diagnosis { padding-left: 1.2rem; margin: 0 0 .6rem; }
.message { white-space: pre-wrap; }
.headline { display: flex; flex-wrap: wrap; gap: .4rem 2rem; margin: 0; }
.headline dt { font-size: .8rem; color: var(--quiet); }
.headline dd { margin: 0; font-size: 1.2rem; font-weight: 600; line-height: 1.3; }

/* controls */
button, select, input[type=search] {
  font: inherit; font-size: .9rem; color: var(--ink); background: var(--field);
  border: 1px solid var(--quiet); border-radius: .45rem; padding: .25rem .7rem; min-height: 2.25rem;
}
button, select, summary, .check, .modes label { cursor: pointer; }
button:hover, .modes label:hover span { border-color: var(--accent); color: var(--link); }
button[aria-pressed=true] { background: var(--accent); color: var(--on-accent); }
input { accent-color: var(--accent); }
.toolbar, .controls, .controls > div, .aims, .filters, .filters fieldset {
  display: flex; flex-wrap: wrap; gap: .5rem .75rem; align-items: center;
}
.toolbar { justify-content: space-between; margin-bottom: .6rem; }
fieldset { border: 0; margin: 0; padding: 0; min-width: 0; }
.modes { display: flex; flex-wrap: wrap; gap: .3rem; }
.modes input { position: absolute; opacity: 0; pointer-events: none; }
.modes span {
  display: block; padding: .3rem .8rem; border: 1px solid var(--quiet); border-radius: .45rem;
  font-size: .9rem; background: var(--field);
}
.modes input:checked + span {
  background: var(--accent); border-color: var(--accent); color: var(--on-accent); font-weight: 600;
}
.modes label:hover input:checked + span { color: var(--on-accent); }
.modes input:focus-visible + span { outline: 3px solid var(--accent); outline-offset: 2px; }
.modes label { position: relative; }
.zoom { display: flex; gap: .3rem; align-items: center; }
.zoom output { min-width: 4.2rem; text-align: center; font-size: .9rem; }
.controls { justify-content: space-between; margin-bottom: .6rem; min-height: 2.4rem; }
.controls > div { flex: 1 1 16rem; }
.controls > .aims { flex: 0 1 auto; margin-left: auto; }
.controls label { font-size: .9rem; }
#split { flex: 1; min-width: 8rem; max-width: 34rem; height: 1.5rem; }
.scale { flex: 1; max-width: 34rem; min-width: 12rem; }
.check { display: inline-flex; gap: .4rem; align-items: center; font-size: .9rem; }
.check input { width: 1.05rem; height: 1.05rem; margin: 0; }

/* the viewer */
.bench { display: grid; gap: 1rem; }
@media (min-width: 68rem) { .bench { grid-template-columns: minmax(0, 1fr) 21rem; } }
.stage {
  position: relative; background: var(--stage); border: 1px solid var(--line); overflow: hidden;
  border-radius: .35rem; align-self: start; min-width: 0;
}
canvas { display: block; width: 100%; cursor: grab; border-radius: .3rem; }
canvas:active { cursor: grabbing; }
canvas.near, canvas.near:active { cursor: ew-resize; }
canvas.roomy:not(.near) { cursor: crosshair; }
canvas:focus-visible { outline-offset: -3px; }
.tag {
  position: absolute; top: 8px; left: 8px; max-width: 45%; padding: .1rem .55rem;
  border-radius: .3rem; background: rgb(0 0 0 / .72); color: #fff; font-size: .8rem;
  pointer-events: none; overflow: hidden; text-overflow: ellipsis; white-space: nowrap;
}
#tag-b { left: auto; right: 8px; }
.inspector table { table-layout: auto; }
.inspector caption { text-align: left; font-weight: 600; padding-bottom: .2rem; }
.inspector tbody th { width: 40%; }
.inspector th div {
  display: flex; align-items: baseline; overflow-wrap: anywhere; line-height: 1.35;
}
.inspector .swatch { flex: none; align-self: center; }
.inspector td { min-width: 2.6rem; }
kbd {
  font: inherit; font-size: .8rem; padding: 0 .35em; border: 1px solid var(--line);
  border-radius: .3em; background: var(--field);
}

/* pictures */
.pictures { display: grid; gap: 1rem; }
@media (min-width: 44rem) { .pictures { grid-template-columns: 1fr 1fr; } }
figure { margin: 0; min-width: 0; }
figcaption { font-size: .85rem; margin-top: .3rem; overflow-wrap: anywhere; }
.frame { border: 1px solid var(--line); line-height: 0; }
.frame img, .crops img { width: 100%; height: auto; }
.pixels, .crops img { image-rendering: pixelated; }
.heat { filter: url(#magma); }
.bar { height: .7rem; border: 1px solid var(--line); border-radius: .2rem; }
.ticks { display: flex; justify-content: space-between; font-size: .75rem; color: var(--quiet); }
.tiles {
  display: grid; gap: 1.5rem;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 24rem), 1fr));
}
.tile { max-width: 40rem; min-width: 0; }
.tile table { margin: .5rem 0; font-size: .82rem; }
.tile th, .tile td { padding: .15rem .2rem; }
.tile tbody th { white-space: nowrap; }
.crops { display: grid; grid-template-columns: repeat(3, 1fr); gap: .5rem; }
.crops img { border: 1px solid var(--line); display: block; }
.crops figcaption { font-size: .8rem; margin: .15rem 0 0; }

/* tables */
.columns {
  display: grid; gap: 0 1rem;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 28rem), 1fr));
}
.columns > * { min-width: 0; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; }
th, td {
  text-align: right; padding: .3rem .4rem; border-bottom: 1px solid var(--line);
  vertical-align: top;
}
th { font-weight: 500; }
td { white-space: nowrap; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
thead th { color: var(--quiet); font-size: .82rem; vertical-align: bottom; }
tbody tr:last-child > * { border-bottom: 0; }
th small { display: block; font-size: .78rem; line-height: 1.3; font-weight: 400; }
.sum th, .sum td { font-weight: 600; }
.part th { font-weight: 600; padding-top: .9rem; font-size: .82rem; color: var(--quiet); }
tbody:first-of-type .part th { padding-top: .3rem; }
.swatch {
  display: inline-block; width: 1em; height: 1em; margin-right: .5em; vertical-align: -.12em;
  border: 1px solid var(--line); border-radius: .2em;
}
.wraps { white-space: normal; }
.figures tr:not(.part) th:first-child { width: 60%; }
.gauge {
  display: inline-flex; flex-direction: column; align-items: flex-end; font-size: .82rem;
  width: 6rem;
}
.gauge svg { width: 100%; height: .4rem; border-radius: .2rem; }
.rail { fill: var(--rail); }
.used { fill: currentColor; }
.mark { fill: var(--ink); }
ul { padding-left: 1.2rem; margin: .25rem 0; }
li { overflow-wrap: anywhere; }
code, pre { font-family: ui-monospace, monospace; font-size: .85rem; }
pre {
  background: var(--paper); border: 1px solid var(--line); border-radius: .4rem;
  padding: .75rem; margin: .35rem 0; overflow: auto; max-height: 30rem;
}
summary { font-weight: 600; }
details details, .card details { font-size: .9rem; margin-top: .75rem; }
.card details summary { font-weight: 400; }
footer { margin-top: 1.5rem; font-size: .85rem; }

/* plots */
.plots {
  display: grid; gap: 1rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr));
}
.plot { width: 100%; max-width: 32rem; display: block; font: 9.5px system-ui, sans-serif; }
.plot text { fill: var(--quiet); }
.plots figcaption { font-weight: 500; margin: 0 0 .5rem; }
.plots figure { display: flex; flex-direction: column-reverse; justify-content: flex-end; }
.grid { stroke: var(--line); fill: none; }
.axis { stroke: var(--quiet); }
.within { fill: var(--good); }
.beyond { fill: var(--bad); }
.curve { fill: none; stroke: var(--accent); stroke-width: 2; stroke-linejoin: round; }
.dot { fill: var(--accent); }
.limit { fill: none; stroke: var(--warn); stroke-dasharray: 4 3; }
.plot .limit-name { fill: var(--warn); }

/* the list of all cases */
.shares { display: block; width: 100%; height: .5rem; border-radius: .25rem; margin-bottom: 1rem; }
.shares .pass { fill: var(--good); } .shares .warn { fill: var(--warn); }
.shares :is(.fail, .error) { fill: var(--bad); } .shares .not_comparable { fill: var(--other); }
.filters { margin-bottom: .75rem; gap: .5rem 1.25rem; }
.filters output { margin-left: auto; color: var(--quiet); font-size: .9rem; }
.find { display: inline-flex; gap: .5rem; align-items: center; font-size: .9rem; }
.find input { width: 16rem; max-width: 100%; min-width: 0; }
.index > thead button {
  all: unset; cursor: pointer; padding: .2rem 0; font-weight: 600;
}
.index > thead button:focus-visible { outline: 3px solid var(--accent); border-radius: .2rem; }
.index > thead button:hover { color: var(--link); text-decoration: underline; }
.index [aria-sort] { color: var(--ink); }
.index > thead button::after {
  content: "▲"; font-size: .7em; margin-left: .3em; visibility: hidden;
}
.index [aria-sort] button::after { visibility: visible; }
.index [aria-sort=descending] button::after { content: "▼"; }
.index :is(td, th) { vertical-align: middle; padding: .35rem .4rem; }
.index { font-size: .86rem; }
.index :is([data-name=scene], [data-name=verdict], .cause) { text-align: left; }
.index > thead th:nth-child(-n+4) { text-align: left; }
.index [data-name=scene] { overflow-wrap: anywhere; min-width: 8rem; }
.index .cause {
  white-space: normal; overflow-wrap: anywhere; width: 28%; font-size: .82rem; line-height: 1.4;
}
.strip { width: 1%; }
.strip img { display: block; height: 42px; width: auto; max-width: none; border-radius: .2rem; }
.index > tbody tr:hover { background: var(--paper); }
@media (max-width: 60rem) {
  .index, .index > tbody { display: block; }
  .index > thead { display: block; border-bottom: 1px solid var(--line); }
  .index > thead tr { display: flex; flex-wrap: wrap; gap: .1rem .9rem; padding-bottom: .4rem; }
  .index > thead tr::before {
    content: "sort by"; color: var(--quiet); font-size: .82rem; align-self: center;
  }
  .index > thead :is(th, td) { border: 0; padding: 0; }
  .index > thead td { display: none; }
  .index > tbody tr {
    display: grid; gap: .25rem .75rem;
    grid-template-columns: repeat(auto-fill, minmax(5.2rem, 1fr));
    padding: .8rem 0; border-bottom: 1px solid var(--line);
  }
  .index > tbody :is(td, th) {
    border: 0; padding: 0; text-align: left; min-width: 0; width: auto;
  }
  .index > tbody :is(.strip, .cause, [data-name=scene], [data-name=verdict]) {
    grid-column: 1 / -1;
  }
  .index > tbody .cause:empty, .strip:empty { display: none; }
  .index [data-name=scene] { font-weight: 600; }
  .strip { width: auto; }
  .strip img { height: auto; max-height: 108px; max-width: 100%; }
  .index > tbody td:not(.strip, .cause, [data-name=verdict])::before {
    content: attr(data-name); display: block; font-size: .75rem; color: var(--quiet);
  }
}
@media (max-width: 40rem) {
  body { font-size: 15px; }
  .figures tr {
    display: grid; grid-template-columns: 6.2rem 4.6rem 1fr 1.2rem; column-gap: .3rem;
    padding: .35rem 0; border-bottom: 1px solid var(--line);
  }
  .figures :is(thead, tbody) { display: block; }
  .figures, .figures > caption { display: block; }
  .figures :is(th, td) { border: 0; padding: 0; text-align: left; }
  .figures tr:not(.part) th:first-child { grid-column: 1 / -1; width: auto; }
  .figures .part th:first-child { grid-column: 1 / -1; }
  .figures thead :is(th:first-child, th:last-child), .hex { display: none; }
  .figures td:nth-child(4) { justify-self: end; }
  .word { display: none; }
  .find, .find input { width: 100%; }
  .zoom { width: 100%; }
}
@media print {
  .card { break-inside: avoid; }
  .viewer, .filters { display: none; }
  #pictures { display: grid !important; }
}
)css";

}  // namespace penumbra
