// The page of a case, second half: the pixel inspector, controls, keys and pointers. It goes on inside
// the function that viewer.js begins.
  // ---- the pixel inspector

  const signed = (value) => value > 0 ? '+' + value : value < 0 ? '−' + -value : '0';
  function delta(x, y) {
    const a = rgb(test, x, y), b = rgb(reference, x, y);
    return a && b ? a.map((value, i) => value - b[i]) : null;
  }
  function inspect() {
    const {x, y} = cursor;
    $('where').textContent = `Pixel (${x}, ${y})`;
    const fill = (id, list, color) => {
      const row = $(id);
      if (!row) return;
      [...row.cells].slice(1).forEach((cell, i) => { cell.textContent = list[i] ?? '–'; });
      row.querySelector('.swatch').style.background = color ? `rgb(${color})` : 'none';
    };
    const hex = (c) => '#' + c.map((v) => v.toString(16).padStart(2, '0')).join('');
    for (const [id, picture] of [['of-test', test], ['of-reference', reference]]) {
      const color = rgb(picture, x, y);
      fill(id, color ? [...color, hex(color)] : [], color);
    }
    const d = delta(x, y), e = error(x, y);
    fill('of-difference', d ? [...d.map(signed), ''] : [], d && d.map(Math.abs));
    fill('of-flip', e === null ? [] : [e.toFixed(3)], e !== null && rgb(heat, x, y));
  }
  let speech = 0;
  function say() {
    clearTimeout(speech);
    speech = setTimeout(() => {
      const {x, y} = cursor, list = (c) => c ? c.join(' ') : 'none', e = error(x, y);
      $('said').textContent =
          `Pixel ${x}, ${y}. ${names.test}: ${list(rgb(test, x, y))}. ${names.reference}: ` +
          list(rgb(reference, x, y)) + (e === null ? '.' : `. FLIP ${e.toFixed(3)}.`);
    }, 250);
  }
  function point(x, y, pin) {
    cursor = {x: clamp(x, 0, width - 1), y: clamp(y, 0, height - 1)};
    pinned = pin;
    inspect();
    redraw();
  }
  function step(dx, dy) {
    const pane = panes[0];
    point(cursor.x + dx, cursor.y + dy, true);
    const away = {x: (cursor.x + 0.5 - view.x) * view.scale,
                  y: (cursor.y + 0.5 - view.y) * view.scale};
    if (Math.abs(away.x) > pane.w / 2 - 8) view.x = cursor.x + 0.5;
    if (Math.abs(away.y) > pane.h / 2 - 8) view.y = cursor.y + 0.5;
    settle();
    say();
  }
  function visit(x, y, scale, middle) {
    point(x, y, true);
    aim(...(middle || [x, y]), scale);
    viewer.scrollIntoView({behavior: calm.matches ? 'auto' : 'smooth', block: 'start'});
    canvas.focus({preventScroll: true});
    say();
  }

  // ---- controls

  function setSplit(value) {
    split = clamp(value, 0, 1);
    $('split').value = split * 100;
    redraw();
  }
  function swap() {
    second = !second;
    $('shown').textContent = 'shown: ' + names[shown()];
    redraw();
  }
  // Off until asked for, and below three changes a second.
  function blinking(on) {
    clearInterval(timer);
    timer = on ? setInterval(swap, 600) : 0;
    $('blink').setAttribute('aria-pressed', String(on));
  }
  function setMode(value) {
    mode = value;
    blinking(false);
    for (const part of viewer.querySelectorAll('[data-mode]'))
      part.hidden = part.dataset.mode !== mode;
    $('shown').textContent = 'shown: ' + names[shown()];
    layout();
  }
  for (const radio of viewer.querySelectorAll('[name=mode]')) {
    radio.addEventListener('change', () => setMode(radio.value));
    if (radio.checked) mode = radio.value;
  }
  $('split').addEventListener('input', () => setSplit($('split').value / 100));
  $('blink').addEventListener('click', () => blinking(!timer));
  $('swap').addEventListener('click', () => { blinking(false); swap(); });
  $('gain').addEventListener('change', () => { gain = Number($('gain').value); redraw(); });
  $('mark').addEventListener('change', redraw);
  $('worst')?.addEventListener('click', () => visit(...worst, 40));
  const zooms = {
    in: () => zoom(1.5, pinned && middle()), out: () => zoom(1 / 1.5, pinned && middle()),
    fit: () => { fit(); settle(); }, one: () => zoom(1 / view.scale, pinned && middle())};
  const middle = () => ({x: cursor.x + 0.5, y: cursor.y + 0.5});
  for (const button of viewer.querySelectorAll('[data-zoom]'))
    button.addEventListener('click', zooms[button.dataset.zoom]);
  for (const button of document.querySelectorAll('.go')) {
    button.hidden = false;
    button.addEventListener('click', () => {
      const [x, y, side] = numbers(button.dataset.tile), pane = panes[0];
      const scale = clamp(Math.min(pane.w, pane.h) / side, 36, 48);
      visit(...numbers(button.dataset.pixel), scale, [x + side / 2 - 0.5, y + side / 2 - 0.5]);
    });
  }
  const keys = {
    ArrowLeft: (n) => step(-n, 0), ArrowRight: (n) => step(n, 0),
    ArrowUp: (n) => step(0, -n), ArrowDown: (n) => step(0, n),
    '+': zooms.in, '=': zooms.in, '-': zooms.out, '_': zooms.out, '0': zooms.fit, '1': zooms.one,
    ' ': () => { if (mode === 'blink') { blinking(false); swap(); } }};
  canvas.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key](event.shiftKey ? 10 : 1);
  });

  // ---- pointers: one inspects, moves the divider or the pictures; two zoom

  function place(event) {
    const box = canvas.getBoundingClientRect();
    const at = {left: event.clientX - box.left, top: event.clientY - box.top};
    const pane = panes.find((p) => at.left < p.x + p.w && at.top < p.y + p.h) || panes[0];
    const corner = across(pane);
    return {...at, x: (at.left - corner.x) / view.scale, y: (at.top - corner.y) / view.scale};
  }
  const pointers = new Map();
  let drag = '', start = null, hover = '';
  const near = (at) => Math.abs(at.left - split * panes[0].w) < 24;
  canvas.addEventListener('pointerdown', (event) => {
    const at = place(event);
    pointers.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
    start = {clientX: event.clientX, clientY: event.clientY};
    drag = mode === 'slider' && (near(at) || canvas.classList.contains('roomy')) ? 'split' : 'pan';
    point(Math.floor(at.x), Math.floor(at.y), event.pointerType !== 'mouse');
  });
  canvas.addEventListener('pointermove', (event) => {
    const last = pointers.get(event.pointerId), at = place(event);
    if (!last) {
      const where = event.clientX + ' ' + event.clientY;
      if (where === hover) return;  // the page moved, not the mouse
      hover = where;
      canvas.classList.toggle('near', mode === 'slider' && near(at));
      if (event.pointerType === 'mouse') point(Math.floor(at.x), Math.floor(at.y), false);
      return;
    }
    if (pointers.size === 2) pinch(event);
    else if (drag === 'split') setSplit(at.left / panes[0].w);
    else pan(event.clientX - last.clientX, event.clientY - last.clientY);
    pointers.set(event.pointerId, event);
  });
  function pan(dx, dy) {
    view.x -= dx / view.scale;
    view.y -= dy / view.scale;
    fitted = false;
    settle();
  }
  function pinch(event) {
    const [other] = [...pointers.values()].filter((p) => p.pointerId !== event.pointerId);
    const last = pointers.get(event.pointerId);
    const far = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
    drag = 'pinch';
    zoom(far(event) / Math.max(far(last), 1),
         place({clientX: (event.clientX + other.clientX) / 2,
                clientY: (event.clientY + other.clientY) / 2}));
  }
  function release(event) {
    pointers.delete(event.pointerId);
    const moved = start && Math.hypot(event.clientX - start.clientX, event.clientY - start.clientY);
    const at = place(event);
    // A click where there is room for nothing to be dragged moves the divider there.
    if (event.type === 'pointerup' && drag === 'split' && moved < 4 && !near(at))
      setSplit(at.left / panes[0].w);
    if (pointers.size === 0) drag = '';
  }
  canvas.addEventListener('pointerup', release);
  canvas.addEventListener('pointercancel', release);
  canvas.addEventListener('wheel', (event) => {
    // At the smallest scale the wheel goes on to scroll the page.
    if (event.deltaY > 0 && view.scale <= least() * 1.0001 && !event.ctrlKey) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 33 : 1;
    zoom(Math.exp(-clamp(event.deltaY * lines, -240, 240) * (event.ctrlKey ? 0.01 : 0.0022)),
         place(event));
  }, {passive: false});

  viewer.hidden = false;
  $('pictures').hidden = true;
  new ResizeObserver(layout).observe($('stage'));
  setMode(mode);
  inspect();
})();
