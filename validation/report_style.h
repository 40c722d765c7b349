// The style sheet of the report.
#pragma once

namespace penumbra {

inline constexpr const char* report_style = R"css(
:root {
  color-scheme: light dark;
  --paper: #fbfbfa; --card: #fff; --ink: #1d1f23; --quiet: #62666d; --line: #dcdee2;
  --link: #0b57c4; --good: #116a35; --warn: #7d5200; --bad: #b3211b; --other: #5b3da8;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #131417; --card: #1c1e22; --ink: #e7e8ea; --quiet: #9ea3ab; --line: #33363c;
    --link: #84b5ff; --good: #64d18c; --warn: #ecb95a; --bad: #ff8a80; --other: #bda7ff;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 1rem clamp(.75rem, 3vw, 2rem) 3rem; max-width: 90rem;
  background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; font-variant-numeric: tabular-nums;
}
header { display: flex; flex-wrap: wrap; gap: 0 1rem; align-items: baseline; }
h1 { font-size: 1.25rem; margin: .25rem 0; }
header p, .quiet, footer, small { color: var(--quiet); }
header p { margin: 0; }
h2 { font-size: 1.35rem; margin: 0 0 .5rem; overflow-wrap: anywhere; }
h3 { font-size: 1rem; margin: 1.25rem 0 .35rem; }
a { color: var(--link); overflow-wrap: anywhere; }
section, nav {
  background: var(--card); border: 1px solid var(--line); border-radius: .6rem;
  padding: clamp(.75rem, 2vw, 1.5rem); margin-top: 1.25rem; scroll-margin-top: .5rem;
}
nav { overflow-x: auto; }
.chip {
  display: inline-block; padding: .05em .65em; border: 1.5px solid currentColor;
  border-radius: 1em; font-size: .85rem; font-weight: 600; white-space: nowrap;
  vertical-align: .1em; color: var(--other);
}
.pass, .good { color: var(--good); }
.warn { color: var(--warn); }
.fail, .error, .bad { color: var(--bad); }
.good, .bad { white-space: nowrap; }
.diagnosis { padding-left: 1.2rem; margin: .25rem 0 1rem; overflow-wrap: anywhere; }
.pictures { display: grid; gap: 1rem; }
@media (min-width: 44rem) { .pictures { grid-template-columns: 1fr 1fr; } }
figure { margin: 0; min-width: 0; }
figcaption { font-size: .9rem; margin-top: .3rem; overflow-wrap: anywhere; }
.frame { position: relative; overflow: hidden; border: 1px solid var(--line); line-height: 0; }
.frame img { width: 100%; height: auto; }
.frame img.small { image-rendering: pixelated; }
.ring {
  position: absolute; width: 22px; height: 22px; margin: -11px 0 0 -11px; border-radius: 50%;
  border: 2px solid #fff; outline: 1px solid #000; box-shadow: inset 0 0 0 1px #000; opacity: .8;
}
.bar { height: .7rem; margin-top: .4rem; border: 1px solid var(--line); }
.ticks { display: flex; justify-content: space-between; font-size: .75rem; color: var(--quiet); }
.columns {
  display: grid; gap: 0 2.5rem;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr));
}
.columns > div { min-width: 0; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; }
th, td {
  text-align: right; padding: .3rem .5rem; border-bottom: 1px solid var(--line);
  vertical-align: top;
}
th { font-weight: 500; }
td { white-space: nowrap; }
th:first-child, td:first-child, .index th:nth-child(2) {
  text-align: left; padding-left: 0; overflow-wrap: anywhere;
}
thead th { color: var(--quiet); font-size: .85rem; }
.index th:nth-child(2) { width: 100%; padding-left: .5rem; }
.index thead th:nth-child(n+3) { text-align: right; }
@media (max-width: 40rem) {
  th, td { padding: .3rem .25rem; }
  .index :is(th, td):nth-child(n+4), .word { display: none; }
  .columns table { font-size: .85rem; }
}
th small { display: block; font-size: .78rem; line-height: 1.25; font-weight: 400; }
.sum th, .sum td { font-weight: 600; border-bottom: 0; }
.swatch {
  display: inline-block; width: 1em; height: 1em; margin-right: .5em; vertical-align: -.12em;
  border: 1px solid var(--line); border-radius: .2em;
}
ul { padding-left: 1.2rem; margin: .25rem 0; }
li { overflow-wrap: anywhere; }
code, pre { font-family: ui-monospace, monospace; font-size: .85rem; }
pre {
  background: var(--paper); border: 1px solid var(--line); border-radius: .4rem;
  padding: .75rem; margin: .35rem 0; overflow-x: auto; max-height: 30rem;
}
details { margin-top: 1.25rem; }
summary { cursor: pointer; font-weight: 600; }
footer { margin-top: 1.5rem; font-size: .85rem; }
@media print { section { break-inside: avoid; } details { display: none; } }
)css";

}  // namespace penumbra
