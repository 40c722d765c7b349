// The page of a case, first half: the viewer's pictures, its view and how it draws. controls.js goes
// on inside the function that begins here.
'use strict';
(async () => {
  const $ = (id) => document.getElementById(id);
  const viewer = $('viewer');
  if (!viewer) return;
  const numbers = (text) => text.split(',').map(Number);
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  // ---- pictures: canvases whose pixels can be read

  async function take(id) {
    const image = $(id);
    if (!image) return null;
    await image.decode();
    return surface(image.naturalWidth, image.naturalHeight, (c) => c.drawImage(image, 0, 0));
  }
  function surface(width, height, paint) {
    const canvas = document.createElement('canvas');
    canvas.width = width;
    canvas.height = height;
    const context = canvas.getContext('2d', {willReadFrequently: true});
    paint(context);
    return {canvas, width, height, pixels: context.getImageData(0, 0, width, height).data};
  }
  const [test, reference, flip] = await Promise.all(['test', 'reference', 'flip'].map(take));
  const names = {test: $('test').alt, reference: $('reference').alt};
  const width = Math.max(test.width, reference.width);
  const height = Math.max(test.height, reference.height);
  const same = test.width === reference.width && test.height === reference.height;
  const worst = numbers(viewer.dataset.worst);
  const tiles = viewer.dataset.tiles ? viewer.dataset.tiles.split(';').map(numbers) : [];

  function rgb(picture, x, y) {
    if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return null;
    const at = 4 * (y * picture.width + x);
    return [picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2]];
  }
  let amplified = null;
  function difference(gain) {
    if (amplified && amplified.gain === gain) return amplified;
    amplified = surface(width, height, (context) => {
      const data = context.createImageData(width, height);
      for (let i = 0; i < data.data.length; ++i)
        data.data[i] = i % 4 === 3 ? 255 : gain * Math.abs(test.pixels[i] - reference.pixels[i]);
      context.putImageData(data, 0, 0);
    });
    amplified.gain = gain;
    return amplified;
  }
  // FLIP errors are grey levels; this is their picture in the colours of the map.
  const stops = viewer.dataset.magma.split(',').map(
      (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));
  const colors = Array.from({length: 256}, (_, level) => {
    const place = level / 17, low = Math.min(Math.floor(place), 14);
    return stops[low].map((from, k) => from + (place - low) * (stops[low + 1][k] - from));
  });
  const heat = flip && surface(flip.width, flip.height, (context) => {
    const data = context.createImageData(flip.width, flip.height);
    for (let i = 0; i < data.data.length; ++i)
      data.data[i] = i % 4 === 3 ? 255 : colors[flip.pixels[i]][i % 4];
    context.putImageData(data, 0, 0);
  });
  function error(x, y) {
    const level = flip && rgb(flip, x, y);
    return level ? level[0] / 255 : null;
  }

  // ---- state, and what follows from it

  const canvas = $('canvas'), context = canvas.getContext('2d');
  const calm = matchMedia('(prefers-reduced-motion: reduce)');
  let mode = 'slider', split = 0.5, second = false, timer = 0, gain = 16;
  let panes = [], view = {x: width / 2, y: height / 2, scale: 1}, fitted = true;
  let cursor = {x: worst[0], y: worst[1]}, pinned = false, frame = 0;

  // The largest scale that fits; whole steps when it enlarges, so that all pixels are equal.
  function fitting(w, h) {
    const scale = Math.min(w / width, h / height), ratio = devicePixelRatio;
    return scale > 1 ? Math.max(1, Math.floor(scale * ratio) / ratio) : scale;
  }
  const least = () => Math.min(1, fitting(panes[0].w, panes[0].h));
  const across = (pane) => ({x: pane.x + pane.w / 2 - view.x * view.scale,
                             y: pane.y + pane.h / 2 - view.y * view.scale});

  function layout() {
    const w = $('stage').clientWidth, most = clamp(innerHeight * 0.75, 240, 1000);
    const two = mode === 'side', beside = two && w >= 560;
    const paneWidth = beside ? (w - 4) / 2 : w;
    const room = two && !beside ? most * 0.7 : most;
    const paneHeight = Math.round(clamp(fitting(paneWidth, room) * height, 160, room));
    panes = [{x: 0, y: 0, w: paneWidth, h: paneHeight}];
    if (two)
      panes.push(beside ? {x: paneWidth + 4, y: 0, w: paneWidth, h: paneHeight}
                        : {x: 0, y: paneHeight + 4, w: paneWidth, h: paneHeight});
    const h = two && !beside ? 2 * paneHeight + 4 : paneHeight;
    canvas.width = Math.round(w * devicePixelRatio);
    canvas.height = Math.round(h * devicePixelRatio);
    canvas.style.height = h + 'px';
    if (fitted) fit();
    settle();
  }
  function settle() {
    const pane = panes[0];
    view.scale = clamp(view.scale, least(), 96);
    for (const [axis, side, size] of [['x', pane.w, width], ['y', pane.h, height]]) {
      const half = side / 2 / view.scale;
      view[axis] = half * 2 >= size ? size / 2 : clamp(view[axis], half, size - half);
    }
    const roomy = width * view.scale <= pane.w + 1 && height * view.scale <= pane.h + 1;
    canvas.style.touchAction = roomy ? 'pan-y' : 'none';
    canvas.classList.toggle('roomy', roomy);
    $('zoom').textContent = Math.round(view.scale * 100) + ' %';
    redraw();
  }
  function fit() {
    view = {x: width / 2, y: height / 2, scale: fitting(panes[0].w, panes[0].h)};
    fitted = true;
  }
  function zoom(factor, at) {
    const pane = panes[0], old = view.scale;
    const scale = clamp(old * factor, least(), 96);
    const x = at ? at.x : view.x, y = at ? at.y : view.y;
    view = {x: x + (view.x - x) * old / scale, y: y + (view.y - y) * old / scale, scale};
    fitted = scale === fitting(pane.w, pane.h);
    settle();
  }
  function aim(x, y, scale) {
    view = {x: x + 0.5, y: y + 0.5, scale: scale || view.scale};
    fitted = false;
    settle();
  }

  // ---- drawing

  function redraw() {
    if (!frame) frame = requestAnimationFrame(draw);
  }
  const shown = () => second ? 'reference' : 'test';
  function layers() {
    const all = panes[0], x = Math.round(split * all.w);
    switch (mode) {
      case 'slider':
        return [{pane: all, picture: test, name: 'test', clip: [0, x]},
                {pane: all, picture: reference, name: 'reference', clip: [x, all.w]}];
      case 'blink':
        return [{pane: all, picture: second ? reference : test, name: shown()}];
      case 'side':
        return [{pane: panes[0], picture: test, name: 'test'},
                {pane: panes[1], picture: reference, name: 'reference'}];
      case 'difference': return [{pane: all, picture: difference(gain), name: 'difference'}];
      default: return [{pane: all, picture: heat, name: 'flip'}];
    }
  }
  function draw() {
    frame = 0;
    const ratio = devicePixelRatio;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    for (const layer of layers()) {
      const {pane, picture} = layer, [from, to] = layer.clip || [0, pane.w];
      const corner = across(pane), snap = (v) => Math.round(v * ratio) / ratio;
      context.save();
      context.beginPath();
      context.rect(pane.x + from, pane.y, to - from, pane.h);
      context.clip();
      context.imageSmoothingEnabled = view.scale * ratio < 1;
      context.imageSmoothingQuality = 'high';
      context.drawImage(picture.canvas, snap(corner.x), snap(corner.y),
                        picture.width * view.scale, picture.height * view.scale);
      if (view.scale >= 36) values(layer, corner, pane.x + from, pane.x + to);
      if ($('mark').checked) tiles.forEach((tile, i) => outline(corner, tile, i + 1));
      if (pinned) outline(corner, [cursor.x, cursor.y, 1]);
      context.restore();
    }
    if (mode === 'slider') divider(panes[0]);
    label();
  }
  // Black on white, so that it is seen on any picture.
  function twice(paint) {
    for (const [style, size] of [['#000', 3.5], ['#fff', 1.5]]) {
      context.strokeStyle = style;
      context.lineWidth = size;
      paint();
    }
  }
  function outline(corner, [x, y, side], number) {
    const size = Math.max(side * view.scale, 9), grow = (size - side * view.scale) / 2;
    const left = corner.x + x * view.scale - grow, top = corner.y + y * view.scale - grow;
    twice(() => context.strokeRect(left, top, size, size));
    if (!number) return;
    context.font = '600 13px system-ui, sans-serif';
    context.textAlign = 'left';
    context.textBaseline = 'bottom';
    twice(() => context.strokeText(number, left, top - 2));
    context.fillStyle = '#000';
    context.fillText(number, left, top - 2);
  }
  function divider(pane) {
    const x = Math.round(split * pane.w);
    twice(() => {
      context.beginPath();
      context.moveTo(x, 0);
      context.lineTo(x, pane.h);
      context.stroke();
    });
    context.beginPath();
    context.arc(x, pane.h / 2, 13, 0, 7);
    context.fillStyle = '#fff';
    context.fill();
    context.lineWidth = 1.5;
    context.strokeStyle = '#000';
    context.stroke();
    context.beginPath();
    for (const way of [-1, 1]) {
      context.moveTo(x + 3 * way, pane.h / 2 - 4.5);
      context.lineTo(x + 7.5 * way, pane.h / 2);
      context.lineTo(x + 3 * way, pane.h / 2 + 4.5);
    }
    context.stroke();
  }
  function values({pane, name, picture}, corner, from, to) {
    const scale = view.scale, first = Math.max(0, Math.floor((from - corner.x) / scale));
    context.font = Math.min(scale / 3.6, 13) + 'px ui-monospace, monospace';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    for (let y = Math.max(0, Math.floor((pane.y - corner.y) / scale));
         y < height && corner.y + y * scale < pane.y + pane.h; ++y)
      for (let x = first; x < width && corner.x + x * scale < to; ++x) {
        const under = rgb(picture, x, y), lines = words(name, x, y);
        if (!under) continue;
        const light = 0.3 * under[0] + 0.59 * under[1] + 0.11 * under[2];
        context.fillStyle = light > 120 ? '#000' : '#fff';
        lines.forEach((line, i) => context.fillText(
            line, corner.x + (x + 0.5) * scale,
            corner.y + (y + 0.5 + (i - (lines.length - 1) / 2) * 0.29) * scale));
      }
  }
  function words(name, x, y) {
    if (name === 'flip') return [error(x, y).toFixed(2)];
    if (name !== 'difference') return rgb(name === 'test' ? test : reference, x, y).map(String);
    return delta(x, y).map(signed);
  }
  function label() {
    const tag = (id, words, x, y) => {
      $(id).textContent = words;
      $(id).hidden = !words;
      if (id === 'tag-b') Object.assign($(id).style, {left: x, right: x ? 'auto' : '', top: y});
    };
    const second = panes[1], titles = {difference: 'difference × ' + gain, flip: 'FLIP'};
    tag('tag-a', titles[mode] || names[mode === 'blink' ? shown() : 'test']);
    if (mode === 'slider') tag('tag-b', names.reference, '', '');
    else if (second) tag('tag-b', names.reference, second.x + 8 + 'px', second.y + 8 + 'px');
    else tag('tag-b', '');
  }
