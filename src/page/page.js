/* The figures of a page, drawn from the results that stand in the page as data. D3 gives scales, ticks and shapes; everything else is
 * below. Texts of results reach the document by textContent and attributes alone.
 *
 *   GROUPS       which figures stand at which place of the page: a new figure is one more entry there
 *   figure()     title, legend, drawing, reading under the pointer, numbers as a table, buttons
 *   panels(), rows(), matrix(), rotor(), motion(), meridian()   the kinds of drawings */
'use strict';
(() => {
  const NS = 'http://www.w3.org/2000/svg';
  const COLORS = ['blue', 'vermilion', 'green', 'purple', 'ochre'];
  const results = JSON.parse(document.getElementById('data').textContent);
  /* Lengths and frequencies as the deck states them; the data are in SI. Amplitudes keep their micrometres. */
  const stated = (key) => results.map((r) => (r.result ?? r)[key]).find(Boolean);
  const M = stated('length_unit') ?? 'm';
  const HZ = stated('frequency_unit') ?? 'Hz';
  const inM = { cm: 1e2, mm: 1e3, in: 1 / 0.0254 }[M] ?? 1;
  const inHz = { kHz: 1e-3, rpm: 60, 'rad/s': 2 * Math.PI }[HZ] ?? 1;
  const times = (v, f) => (Array.isArray(v) ? v.map((one) => times(one, f)) : typeof v === 'number' ? v * f : v);
  function convert(o) {
    if (!o || typeof o !== 'object') return;
    for (const key of Object.keys(o)) {
      if (key === 'unbalance') continue;
      if (/^z$|_m$/.test(key) && !/_(n|kg)_m$/.test(key) || (key === 'value' && o.unit === 'm')) o[key] = times(o[key], inM);
      else if (/_hz$/.test(key)) o[key] = times(o[key], inHz);
      else convert(o[key]);
    }
  }
  if (inM !== 1 || inHz !== 1) convert(results);
  const known = (v) => typeof v === 'number' && isFinite(v);
  const color = (name) => `var(--${name})`;

  /* ---- text and numbers */

  const minus = (text) => text.replace('-', '\u2212');
  /* Significant digits, zeros at the end left out. */
  function num(v, digits = 4) {
    if (!known(v)) return '\u2013';
    if (v === 0) return '0';
    const size = Math.abs(v);
    if (size >= 1e6 || size < 1e-4) return minus(String(Number(v.toPrecision(digits)).toExponential()).replace('e+', 'e'));
    return minus(String(Number(v.toPrecision(digits))));
  }
  const fixed = (v, decimals) => (known(v) ? minus(v.toFixed(decimals)) : '\u2013');
  const signed = (v, decimals) => (known(v) && v > 0 ? '+' : '') + fixed(v, decimals);
  /* Two digits, zeros kept: 0.10 beside 2.3. */
  const short = (v) => (known(v) && v !== 0 && Math.abs(v) >= 1e-3 && Math.abs(v) < 100 ? minus(v.toPrecision(2)) : num(v, 2));
  const rms = (list) => (list.length ? Math.sqrt(list.reduce((sum, v) => sum + v * v, 0) / list.length) : NaN);
  /* The prefix that suits a value: as human_unit of src/report/human.c. */
  function unitOf(value, unit) {
    const shown = { Pa: 'Pa', 'N/m': 'N/m', 'N.m/rad': 'N\u00b7m/rad', N: 'N' }[unit];
    if (!shown) return { factor: 1, text: !unit || unit === '1' ? '' : unit };
    const step = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k']].find(([from]) => Math.abs(value) >= from) || [1, ''];
    return { factor: 1 / step[0], text: step[1] + shown };
  }
  const label = (name, unit) => (unit ? `${name} [${unit}]` : name);
  const plain = (id) => String(id).replace(/_/g, ' ');
  const range = (values) => {
    const list = values.filter(known);
    return list.length ? [Math.min(...list), Math.max(...list)] : [0, 1];
  };
  function padded(values, share = 0.06, zero = false) {
    let [low, high] = range(zero ? values.concat(0) : values);
    if (low === high) [low, high] = [low - (Math.abs(low) || 1) * 0.1, high + (Math.abs(high) || 1) * 0.1];
    const room = (high - low) * share;
    return [zero && low === 0 ? 0 : low - room, zero && high === 0 ? 0 : high + room];
  }

  /* ---- elements */

  function fill(element, attributes, children) {
    for (const [name, value] of Object.entries(attributes || {})) {
      if (name === 'onclick') element.addEventListener('click', value);
      else if (value !== undefined && value !== null) element.setAttribute(name, value);
    }
    for (const child of children) if (child !== null && child !== undefined) element.append(child);
    return element;
  }
  const el = (name, attributes, ...children) => fill(document.createElement(name), attributes, children);
  const sv = (name, attributes, ...children) => fill(document.createElementNS(NS, name), attributes, children);
  const text = (x, y, words, attributes) => sv('text', { x, y, ...attributes }, String(words));
  const line = (x1, y1, x2, y2, stroke, attributes) => sv('line', { x1, y1, x2, y2, stroke: color(stroke), ...attributes });
  const path = (d, attributes) => sv('path', { d, fill: 'none', ...attributes });

  let ruler;
  function widthOf(words, size = 12) {
    ruler = ruler || document.createElement('canvas').getContext('2d');
    ruler.font = `${size}px Arial, "Liberation Sans", Helvetica, sans-serif`;
    return ruler.measureText(words).width;
  }
  /* Lines of a text that are `room` px wide. */
  function wrapped(words, room) {
    const lines = [''];
    for (const word of String(words).split(' ')) {
      const longer = lines[lines.length - 1] ? `${lines[lines.length - 1]} ${word}` : word;
      if (widthOf(longer) <= room || !lines[lines.length - 1]) lines[lines.length - 1] = longer;
      else lines.push(word);
    }
    return lines.map((is) => {
      let cut = is;
      while (cut.length > 4 && widthOf(cut) > room) cut = `${cut.slice(0, -2)}\u2026`;
      return cut;
    });
  }

  /* ---- what leaves the page */

  function save(name, type, content) {
    const url = URL.createObjectURL(content instanceof Blob ? content : new Blob([content], { type }));
    el('a', { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }
  /* A formula of a spreadsheet is text. */
  const csvCell = (cell) => {
    const words = String(cell ?? '');
    const safe = typeof cell !== 'number' && /^[=+@\t]|^-\D/.test(words) ? `'${words}` : words;
    return /[",\n]/.test(safe) ? `"${safe.replace(/"/g, '""')}"` : safe;
  };
  const csv = (table) => [table.head, ...table.rows].map((row) => row.map(csvCell).join(',')).join('\n') + '\n';
  const tabs = (table) => [table.head, ...table.rows].map((row) => row.map((c) => String(c ?? '').replace(/[\t\n]/g, ' ')).join('\t')).join('\n');
  function copy(button, words) {
    const say = (what) => {
      button.textContent = what;
      setTimeout(() => { button.textContent = 'copy'; }, 1500);
    };
    const by_hand = () => {
      const area = el('textarea', { 'aria-label': 'copy' });
      area.value = words;
      document.body.append(area);
      area.select();
      const done = document.execCommand('copy');
      area.remove();
      say(done ? 'copied' : 'failed');
    };
    if (navigator.clipboard) navigator.clipboard.writeText(words).then(() => say('copied'), by_hand);
    else by_hand();
  }
  const button = (words, onclick, attributes) => el('button', { type: 'button', onclick, ...attributes }, words);
  function tools(name, table) {
    const copies = button('copy', () => copy(copies, tabs(table())));
    return [button('CSV', () => save(`${name}.csv`, 'text/csv', csv(table()))), copies];
  }
  /* The drawing with every colour and font as it is shown, to stand alone. */
  function alone(drawing) {
    const legend = drawing.closest('figure').querySelectorAll('.legend span');
    const whole = drawing.cloneNode(true);
    const box = drawing.viewBox.baseVal;
    let x = 0;
    const marks = [...legend].flatMap((entry) => {
      const mark = sv('g', { transform: `translate(${x} ${box.height + 6})` }, ...[...entry.querySelector('svg').children].map((shape) => shape.cloneNode(true)), text(24, 10, entry.textContent));
      x += 44 + widthOf(entry.textContent);
      return mark;
    });
    whole.append(...marks);
    whole.setAttribute('viewBox', `0 0 ${Math.max(box.width, x)} ${box.height + (marks.length ? 24 : 0)}`);
    drawing.after(whole); /* styles are those of the page */
    const clone = whole.cloneNode(true);
    const from = whole.querySelectorAll('*');
    clone.querySelectorAll('*').forEach((element, i) => {
      const style = getComputedStyle(from[i]);
      const usual = { stroke: 'none', 'stroke-dasharray': 'none', 'stroke-width': '1px', opacity: '1', 'fill-opacity': '1', 'font-weight': '400' };
      const names = ['fill', 'stroke', 'stroke-width', 'stroke-dasharray', 'opacity', 'fill-opacity', ...(element.tagName === 'text' ? ['font-family', 'font-size', 'font-weight'] : [])];
      if (element.tagName === 'g') return;
      for (const name of names) {
        const value = style.getPropertyValue(name);
        if (value === usual[name]) element.removeAttribute(name);
        else element.setAttribute(name, value);
      }
      element.removeAttribute('class');
    });
    whole.remove();
    const size = clone.viewBox.baseVal;
    clone.setAttribute('width', size.width);
    clone.setAttribute('height', size.height);
    clone.prepend(sv('rect', { width: size.width, height: size.height, fill: getComputedStyle(document.documentElement).getPropertyValue('--paper') }));
    return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(clone)}`;
  }
  function png(name, drawing) {
    const image = new Image();
    image.onload = () => {
      const canvas = el('canvas', { width: 2 * image.width, height: 2 * image.height });
      canvas.getContext('2d').drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob((blob) => save(`${name}.png`, 'image/png', blob));
    };
    image.src = URL.createObjectURL(new Blob([alone(drawing)], { type: 'image/svg+xml' }));
  }

  /* ---- a figure. is: id, title, caption, draw(width, is) -> drawing, table() -> {head, rows}, legend [[name, colour, mark]],
   * controls(redraw) -> elements, read(x) under the pointer */

  const drawn = [];
  const taken = new Set();

  function legendOf(entries) {
    return el('div', { class: 'legend' }, ...entries.map(([name, tint, mark]) => el('span', {}, sv('svg', { viewBox: '0 0 18 12', 'aria-hidden': 'true' },
      mark === 'dot' ? sv('circle', { cx: 9, cy: 6, r: 4, fill: color(tint) })
        : mark === 'ring' ? sv('circle', { cx: 9, cy: 6, r: 3.5, fill: 'none', stroke: color(tint), 'stroke-width': 1.5 })
          : mark === 'face' ? sv('rect', { x: 2, y: 1, width: 14, height: 10, fill: color(tint) })
            : line(0, 6, 18, 6, tint, { 'stroke-width': 2, 'stroke-dasharray': mark === 'dash' ? '5 3' : null })), name)));
  }
  function tableElement(table, caption) {
    return el('div', { class: 'scroll', role: 'group', tabindex: 0, 'aria-label': caption }, el('table', {}, el('thead', {},
      el('tr', {}, ...table.head.map((name) => el('th', { scope: 'col' }, String(name))))),
    el('tbody', {}, ...table.rows.map((row) => el('tr', {}, ...row.map((cell, j) => el(j ? 'td' : 'th', { class: typeof cell === 'number' ? 'n' : null, scope: j ? null : 'row' },
      typeof cell === 'number' ? num(cell, 6) : String(cell ?? '\u2013'))))))));
  }
  function figure(is) {
    let id = is.id;
    for (let i = 2; taken.has(id); i++) id = `${is.id}-${i}`;
    taken.add(id);
    const title = el('h3', { id: `${id}-title` }, is.title);
    const legend = el('div');
    const holder = el('div');
    const readout = el('p', { class: 'readout' });
    const numbers = el('details', { class: 'numbers' }, el('summary', {}, 'Numbers of this figure'));
    const drawing = sv('svg', { role: 'img', 'aria-labelledby': `${id}-title` });
    const redraw = () => {
      const width = Math.max(280, Math.round(holder.clientWidth || 720));
      const made = is.draw(width, is);
      drawing.setAttribute('viewBox', `0 0 ${width} ${Math.ceil(made.height)}`);
      drawing.replaceChildren(made.content);
      if (is.title !== title.textContent) title.textContent = is.title;
      const entries = typeof is.legend === 'function' ? is.legend() : is.legend || [];
      legend.replaceChildren(entries.length > 1 ? legendOf(entries) : '');
      readout.textContent = is.said ? is.said() : '';
      if (numbers.open) showNumbers();
    };
    const showNumbers = () => {
      while (numbers.children.length > 1) numbers.lastChild.remove();
      numbers.append(tableElement(is.table(), is.title));
    };
    numbers.addEventListener('toggle', () => numbers.open && showNumbers());
    const point = (event) => {
      const box = drawing.getBoundingClientRect();
      const scale = drawing.viewBox.baseVal.width / box.width;
      readout.textContent = is.read((event.clientX - box.left) * scale, (event.clientY - box.top) * scale, drawing) || (is.said ? is.said() : '');
    };
    if (is.read) {
      drawing.addEventListener('pointermove', point);
      drawing.addEventListener('pointerdown', point);
      drawing.addEventListener('pointerleave', () => {
        drawing.querySelectorAll('.cursor').forEach((mark) => mark.remove());
        readout.textContent = is.said ? is.said() : '';
      });
    }
    if (is.zoom) zoomable(is, drawing, redraw);
    holder.append(drawing);
    const more = is.controls ? is.controls(redraw) : [];
    const element = el('figure', { id }, title, more.length ? el('div', { class: 'controls' }, ...more) : null, legend, holder,
      is.read || is.said ? readout : null, is.caption ? el('figcaption', {}, is.caption) : null,
      el('div', { class: 'tools' }, button('SVG', () => save(`${id}.svg`, 'image/svg+xml', alone(drawing))), button('PNG', () => png(id, drawing)),
        ...tools(id, is.table)), numbers);
    drawn.push(redraw);
    return { element, redraw };
  }
  /* Drags along x choose a range, a double click shows all. */
  function zoomable(is, drawing, redraw) {
    let from = null;
    const at = (event) => (event.clientX - drawing.getBoundingClientRect().left) * drawing.viewBox.baseVal.width / drawing.getBoundingClientRect().width;
    drawing.addEventListener('pointerdown', (event) => { from = at(event); });
    drawing.addEventListener('pointerup', (event) => {
      if (from !== null && Math.abs(at(event) - from) > 12) {
        is.range = [from, at(event)].sort((a, b) => a - b).map((x) => is.scale.invert(x));
        redraw();
      }
      from = null;
    });
    drawing.addEventListener('dblclick', () => { is.range = null; redraw(); });
    const before = is.controls;
    const by = (share) => () => {
      const [low, high] = is.scale.domain();
      const middle = (low + high) / 2;
      is.range = [middle - (middle - low) * share, middle + (high - middle) * share];
      redraw();
    };
    const move = (share) => () => {
      const [low, high] = is.scale.domain();
      is.range = [low + (high - low) * share, high + (high - low) * share];
      redraw();
    };
    is.controls = (again) => [...(before ? before(again) : []), button('zoom in', by(0.5)), button('zoom out', by(2)), button('\u25c0', move(-0.4), { 'aria-label': 'left' }),
      button('\u25b6', move(0.4), { 'aria-label': 'right' }), button('all', () => { is.range = null; redraw(); })];
  }

  /* ---- panels with axes. panel: height, x and y {label, domain, log, ticks}, marks, title */

  const scaleOf = (axis, from, to) => (axis.log ? d3.scaleLog() : d3.scaleLinear()).domain(axis.domain).range([from, to]);
  function ticksOf(scale, axis, count) {
    if (axis.ticks) return axis.ticks;
    const ticks = scale.ticks(count);
    return axis.log && ticks.length > count ? ticks.filter((v) => Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-9) : ticks;
  }
  const power = (v) => `10${String(Math.round(Math.log10(v))).replace(/./g, (c) => '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079'['0123456789'.indexOf(c)] || '\u207b')}`;
  function tickText(axis, v) {
    if (axis.names) return axis.names(v);
    if (axis.log && (v >= 1e4 || v < 1e-2)) return power(v);
    return num(v, 6);
  }
  function axes(content, panel, x, y, box) {
    const [left, top, right, bottom] = box;
    for (const v of ticksOf(y, panel.y, Math.max(3, (bottom - top) / 36))) {
      if (panel.y.grid !== false) content.append(line(left, y(v), right, y(v), 'grid'));
      content.append(text(left - 6, y(v) + 4, tickText(panel.y, v), { 'text-anchor': 'end', class: 'quiet' }));
    }
    let last = -Infinity;
    for (const v of ticksOf(x, panel.x, Math.max(3, (right - left) / 80))) {
      const words = tickText(panel.x, v);
      const half = widthOf(words) / 2;
      if (v < Math.min(...x.domain()) || v > Math.max(...x.domain())) continue;
      content.append(line(x(v), bottom, x(v), bottom + 4, 'muted'));
      if (x(v) - half < last + 6) continue;
      last = x(v) + half;
      content.append(text(Math.min(x(v), right + 12 - half), bottom + 17, words, { 'text-anchor': 'middle', class: 'quiet' }));
    }
    content.append(line(left, bottom, right, bottom, 'muted'));
    content.append(text((left + right) / 2, bottom + 34, panel.x.label || '', { 'text-anchor': 'middle', class: 'quiet' }));
    content.append(text(0, top - 9, panel.y.label || '', { class: 'quiet' }));
    if (panel.title) content.append(text(right, top - 9, panel.title, { 'text-anchor': 'end', class: 'strong' }));
  }
  let clips = 0;
  function drawMark(content, mark, x, y) {
    const tint = color(mark.color || 'blue');
    const points = (mark.points || []).filter(([a, b]) => known(a) && known(b) && (!mark.log || b > 0));
    if (mark.type === 'line') {
      const shape = d3.line().defined(([a, b]) => known(a) && known(b)).x(([a]) => x(a)).y(([, b]) => y(b));
      content.append(path(shape(mark.points) || '', { stroke: tint, 'stroke-width': mark.width || 2, 'stroke-dasharray': mark.dash ? '6 4' : null }));
    } else if (mark.type === 'band') {
      content.append(sv('rect', { x: x.range()[0], y: y(mark.to), width: x.range()[1] - x.range()[0], height: Math.max(0, y(mark.from) - y(mark.to)), fill: color('shade') }));
    } else if (mark.type === 'rule') {
      const [x0, x1] = x.range();
      const [y0, y1] = y.range();
      content.append(known(mark.x) ? line(x(mark.x), y0, x(mark.x), y1, mark.color || 'muted', { 'stroke-dasharray': '4 3' })
        : line(x0, y(mark.y), x1, y(mark.y), mark.color || 'muted', { 'stroke-dasharray': mark.solid ? null : '4 3' }));
    } else if (mark.type === 'interval' && mark.area) {
      const least = Math.min(...y.domain());
      const shape = d3.area().defined(([, low, high]) => known(low) && known(high)).x(([a]) => x(a)).y0(([, low]) => y(Math.max(low, least))).y1(([, , high]) => y(Math.max(high, least)));
      content.append(sv('path', { d: shape(mark.points) || '', fill: tint, opacity: 0.16 }));
    } else if (mark.type === 'interval') {
      for (const [a, low, high] of mark.points) if (known(low) && known(high)) content.append(line(x(a), y(low), x(a), y(high), mark.color, { 'stroke-width': mark.width || 1.5, opacity: mark.opacity }));
    } else if (mark.type === 'stems') {
      for (const [a, b] of points) content.append(line(x(a), y(0), x(a), y(b), mark.color, { 'stroke-width': 1.5 }));
    }
    if (mark.type === 'dots' || mark.type === 'stems')
      for (const [a, b] of points)
        content.append(mark.square ? sv('rect', { x: x(a) - 4, y: y(b) - 4, width: 8, height: 8, fill: tint })
          : sv('circle', { cx: x(a), cy: y(b), r: mark.r || 3.5, fill: mark.ring ? color('paper') : tint, stroke: tint, 'stroke-width': mark.ring ? 1.5 : 0, opacity: mark.opacity }));
  }
  function drawPanels(list, is, width, top = 0) {
    const content = sv('g');
    const left = Math.min(110, Math.max(...list.map((panel) => Math.max(...ticksOf(scaleOf(panel.y, 1, 0), panel.y, Math.max(3, panel.height / 36)).map((v) => widthOf(tickText(panel.y, v))), 20)))) + 10;
    const right = width - 12;
    is.boxes = [];
    for (const panel of list) {
      const box = [left, top + 26, right, top + 26 + panel.height];
      const x = scaleOf(is.range ? { ...panel.x, domain: is.range } : panel.x, left + (panel.inset || 0), right - (panel.inset || 0));
      const y = scaleOf(panel.y, box[3], box[1]);
      is.scale = x;
      const inside = sv('g');
      const clip = `clip-${++clips}`;
      const edge = is.range ? 0 : 8; /* for dots on the edge */
      content.append(sv('clipPath', { id: clip }, sv('rect', { x: left - edge, y: box[1] - 4 - edge / 2, width: right - left + 2 * edge, height: panel.height + 8 + edge })));
      inside.setAttribute('clip-path', `url(#${clip})`);
      for (const mark of panel.marks) if (mark.type === 'band') drawMark(inside, mark, x, y);
      axes(content, panel, x, y, box);
      for (const mark of panel.marks) if (mark.type !== 'band') drawMark(inside, mark, x, y);
      content.append(inside);
      is.boxes.push({ panel, x, y, box });
      top = box[3] + (panel.x.label ? 46 : 28);
    }
    return { content, height: top };
  }
  /* The points of all named series, joined over x where they have the same. */
  function tableOf(list) {
    const head = [];
    const rows = new Map();
    list.forEach((panel, number) => {
      for (const mark of panel.marks) {
        if (!mark.name || !mark.points) continue;
        const at = head.length;
        const wide = mark.type === 'interval';
        head.push(...(wide ? [`${mark.name}, from`, `${mark.name}, to`] : [mark.name]).map((name) => (panel.title ? `${name}, ${panel.title}` : name)));
        for (const p of mark.points) {
          let key = `${p[0]}`;
          while (rows.has(key) && rows.get(key)[at + 1] !== undefined) key += `|${number}`;
          if (!rows.has(key)) rows.set(key, [p[0]]);
          const row = rows.get(key);
          row[at + 1] = p[1];
          if (wide) row[at + 2] = p[2];
        }
      }
    });
    const all = [...rows.values()].map((row) => Array.from({ length: head.length + 1 }, (_, j) => row[j]));
    return { head: [list[0].x.label || 'x', ...head], rows: all };
  }
  function legendOfPanels(list) {
    const seen = new Map();
    for (const panel of list) for (const mark of panel.marks) if (mark.name && !seen.has(mark.name) && mark.legend !== false) seen.set(mark.name, [mark.name, mark.color || 'blue', mark.type === 'line' ? (mark.dash ? 'dash' : 'line') : mark.ring ? 'ring' : 'dot']);
    return [...seen.values()];
  }
  /* What stands nearest to the pointer in each series, as a line of text. */
  function readPanels(is, px, py, drawing) {
    const at = is.boxes.find(({ box }) => py <= box[3] + 30) || is.boxes[is.boxes.length - 1];
    if (!at) return '';
    let nearest = null;
    for (const mark of at.panel.marks) for (const p of mark.name ? mark.points || [] : []) if (known(p[0]) && (nearest === null || Math.abs(at.x(p[0]) - px) < Math.abs(at.x(nearest) - px))) nearest = p[0];
    drawing.querySelectorAll('.cursor').forEach((mark) => mark.remove());
    if (nearest === null) return '';
    const cursor = line(at.x(nearest), is.boxes[0].box[1], at.x(nearest), is.boxes[is.boxes.length - 1].box[3], 'muted', { 'stroke-dasharray': '2 2', class: 'cursor' });
    drawing.firstChild.append(cursor);
    const said = [];
    for (const { panel } of is.together ? is.boxes : [at])
      for (const mark of panel.marks) {
        const p = mark.name && (mark.points || []).find(([a]) => a === nearest);
        if (p) said.push(`${mark.name} ${mark.type === 'interval' ? `${num(p[1])} to ${num(p[2])}` : num(p[1])}${panel.title ? ` (${panel.title})` : ''}`);
      }
    return `${at.panel.x.name ? at.panel.x.name(nearest) : `${at.panel.x.label || 'x'} ${num(nearest, 6)}`}: ${said.join('; ')}`;
  }
  function panels(is, list) {
    const make = typeof list === 'function' ? list : () => list;
    const usual = {
      legend: () => legendOfPanels(make()), table: () => tableOf(make()), draw: (width) => drawPanels(make(width), is, width),
      read: (x, y, drawing) => readPanels(is, x, y, drawing),
    };
    return figure(Object.assign(is, usual, { ...is })); /* one object, which its controls change */
  }

  /* ---- rows with a name each. columns: label, domain, log, draw(row, i, x, y, content), value(row) for the table */

  function rows(is, list, columns) {
    return figure({
      table: () => ({ head: ['', ...columns.flatMap((c) => c.head || [c.label])], rows: list.map((row) => [row.name, ...columns.flatMap((c) => [].concat(c.value(row)))]) }),
      draw: (width) => {
        const narrow = width < 520;
        const content = sv('g');
        const bold = (row) => (row.strong ? 1.15 : 1); /* wider */
        const longest = Math.max(...list.map((row) => widthOf(row.name) * bold(row)));
        const room = narrow ? width - 8 : Math.min(width * 0.42, longest + 14);
        const names = list.map((row) => wrapped(row.name, (room - 8) / bold(row)));
        const step = names.map((lines) => (narrow ? 15 * lines.length + 20 : Math.max(22, 15 * lines.length + 6)));
        const left = narrow ? 4 : room;
        const gap = 18;
        const each = (width - left - 14 - gap * (columns.length - 1)) / columns.length;
        const head = 15 * Math.max(...columns.map((column) => wrapped(column.label, each).length)) + 8;
        const bottom = head + step.reduce((sum, h) => sum + h, 0);
        const scales = columns.map((column, j) => scaleOf(column, left + j * (each + gap), left + j * (each + gap) + each));
        columns.forEach((column, j) => {
          wrapped(column.label, each).forEach((words, k) => content.append(text(scales[j].range()[0], 11 + 15 * k, words, { class: 'quiet' })));
          let last = -Infinity;
          for (const v of ticksOf(scales[j], column, Math.max(2, each / 70))) {
            const words = tickText(column, v);
            const half = widthOf(words) / 2;
            content.append(line(scales[j](v), head, scales[j](v), bottom, 'grid'));
            if (scales[j](v) - half < last + 6) continue;
            last = scales[j](v) + half;
            content.append(text(Math.max(half, Math.min(scales[j](v), width - half)), bottom + 16, words, { 'text-anchor': 'middle', class: 'quiet' }));
          }
        });
        let y = head;
        list.forEach((row, i) => {
          names[i].forEach((words, k) => content.append(text(narrow ? 2 : room - 8, y + (narrow ? 12 : step[i] / 2 + 4 - 7.5 * (names[i].length - 1)) + 15 * k, words,
            { 'text-anchor': narrow ? 'start' : 'end', class: row.strong ? 'strong' : null })));
          const middle = narrow ? y + 15 * names[i].length + 8 : y + step[i] / 2;
          columns.forEach((column, j) => column.draw(row, scales[j], middle, content, i));
          y += step[i];
        });
        return { content, height: bottom + 24 };
      },
      ...is,
    });
  }
  const bar = (content, x0, x1, y, tint, attributes) => content.append(sv('rect', { x: Math.min(x0, x1), y: y - 6, width: Math.max(1, Math.abs(x1 - x0)), height: 12, fill: color(tint), ...attributes }));
  const dot = (content, x, y, tint, ring) => content.append(sv('circle', { cx: x, cy: y, r: 4.5, fill: ring ? color('paper') : color(tint), stroke: color(tint), 'stroke-width': 1.8 }));

  /* ---- a matrix of colours */

  function matrix(is, rowNames, columnNames, value, most = 1, decimals = 2) {
    return figure({
      table: () => ({ head: [is.corner || '', ...columnNames], rows: rowNames.map((name, i) => [name, ...columnNames.map((_, j) => value(i, j))]) }),
      draw: (width) => {
        const content = sv('g');
        const left = Math.min(width * 0.35, Math.max(...rowNames.map((name) => widthOf(name))) + 12);
        const size = Math.min(46, (width - left - 4) / columnNames.length);
        const high = Math.min(30, size);
        const tall = columnNames.some((name) => widthOf(name) > size - 4);
        const top = 20 + (tall ? Math.min(120, Math.max(...columnNames.map((name) => widthOf(name)))) : 16);
        content.append(text(left, 11, is.across || '', { class: 'quiet' }));
        columnNames.forEach((name, j) => {
          const x = left + (j + 0.5) * size;
          content.append(tall ? text(0, 0, wrapped(name, 112)[0], { transform: `translate(${x + 4} ${top - 5}) rotate(-90)` }) : text(x, top - 6, name, { 'text-anchor': 'middle' }));
        });
        rowNames.forEach((name, i) => {
          content.append(text(left - 6, top + (i + 0.5) * high + 4, wrapped(name, left - 10)[0], { 'text-anchor': 'end' }));
          columnNames.forEach((_, j) => {
            const v = value(i, j);
            if (!known(v)) return;
            const share = Math.min(1, Math.abs(v) / most);
            const shade = share <= 0.6 ? 0.04 + 0.41 * share / 0.6 : 0.8 + 0.5 * (share - 0.6); /* between, neither ink nor paper reads */
            content.append(sv('rect', { x: left + j * size + 0.5, y: top + i * high + 0.5, width: size - 1, height: high - 1, fill: color(v < 0 ? 'down' : 'ramp'), opacity: shade.toFixed(3) }));
            const words = fixed(v, decimals);
            if (size > widthOf(words, 11) + 3) content.append(sv('text', { x: left + (j + 0.5) * size, y: top + (i + 0.5) * high + 4, 'text-anchor': 'middle', class: share > 0.6 ? 'over' : 'on' }, words));
          });
        });
        return { content, height: top + rowNames.length * high + 6 };
      },
      ...is,
    });
  }

  /* ---- the rotor, to scale */

  const heightOf = (segment) => segment.height_m ?? segment.outer_m ?? 0;
  const segmentsOf = (geometry) => geometry.groups.flatMap((group) => group.segments.map((segment) => ({ ...segment, group })));
  const radiusOf = (geometry) => Math.max(...segmentsOf(geometry).map(heightOf), 0.001) / 2;
  const radiusAt = (geometry, z) => Math.max(0, ...segmentsOf(geometry).filter((s) => z >= s.from_m - 1e-9 && z <= s.to_m + 1e-9).map((s) => heightOf(s) / 2));
  const isIdentified = (group, parameters) => (parameters || []).some((p) => p.name.split('=').some((name) => name.startsWith(`${group.name}.`)));
  /* Sections of the rotor whose axis is at (z, w) and whose cross sections stand normal to it: x, y map m to px; w, slope in px. */
  function drawSections(content, geometry, x, middle, scale, w, identified) {
    for (const segment of segmentsOf(geometry)) {
      const radius = heightOf(segment) / 2 * scale;
      const inner = (segment.inner_m || 0) / 2 * scale;
      const steps = w ? Math.max(2, Math.ceil((x(segment.to_m) - x(segment.from_m)) / 8)) : 1;
      const edge = (side, r) => Array.from({ length: steps + 1 }, (_, i) => {
        const z = segment.from_m + (segment.to_m - segment.from_m) * i / steps;
        const [deflection, slope] = w ? w(z) : [0, 0];
        const turn = Math.hypot(1, slope);
        return [x(z) + side * r * slope / turn, middle - deflection - side * r / turn];
      });
      const outline = edge(1, radius).concat(edge(-1, radius).reverse());
      const layer = segment.group.layer_of;
      const named = isIdentified(segment.group, identified);
      content.append(path(`M${outline.map((p) => p.map((v) => v.toFixed(1)).join(',')).join('L')}Z`, { fill: color(named ? 'sheets' : 'steel'), stroke: color('ink'), 'stroke-width': 0.8, opacity: layer ? 0.75 : null }));
      if (inner > 0) for (const side of [1, -1]) content.append(path(`M${edge(side, inner).map((p) => p.map((v) => v.toFixed(1)).join(',')).join('L')}`, { stroke: color('ink'), 'stroke-width': 0.6, 'stroke-dasharray': '3 2' }));
    }
  }
  function rotor(geometry, identified, marks = [], is = {}) {
    const parts = geometry.groups.filter((group) => isIdentified(group, identified)).map((group) => group.name);
    return figure({
      id: 'rotor',
      title: `The rotor: ${num(geometry.length_m)} ${M}, ${geometry.groups.length} ${geometry.groups.length === 1 ? 'part' : 'parts'}${parts.length ? `; identified: ${parts.join(', ')}` : ''}`,
      caption: `To scale. ${geometry.sensors.length ? `Dots on the axis: ${geometry.sensors.length} sensors. ` : ''}${geometry.springs.length ? 'Triangles: springs. ' : ''}${geometry.disks.length ? 'Squares: disks. ' : ''}${geometry.tierods.length + geometry.bars.length ? 'Dashed green: tie rods and bars. ' : ''}`,
      table: () => ({
        head: ['part', `from [${M}]`, `to [${M}]`, `height or diameter [${M}]`, 'material', 'E [GPa]', 'G [GPa]', 'density [kg/m\u00b3]'],
        rows: segmentsOf(geometry).map((s) => [s.group.name, s.from_m, s.to_m, heightOf(s), s.group.material?.name || '', (s.group.material?.e_pa ?? NaN) / 1e9, (s.group.material?.g_pa ?? NaN) / 1e9, s.group.material?.rho_kg_m3]),
      }),
      legend: parts.length ? [['identified part', 'sheets', 'face'], ['other parts', 'steel', 'face'], ...marks.filter((m) => m.name).map((m) => [m.name, m.color, 'dot'])] : marks.filter((m) => m.name).map((m) => [m.name, m.color, 'dot']),
      draw: (width) => {
        const content = sv('g');
        const x = d3.scaleLinear().domain([0, geometry.length_m]).range([16, width - 16]);
        const scale = Math.min((width - 32) / geometry.length_m, 110 / radiusOf(geometry));
        const middle = 34 + radiusOf(geometry) * scale;
        const bottom = middle + radiusOf(geometry) * scale + 16;
        drawSections(content, geometry, x, middle, scale, null, identified);
        for (const rod of [...geometry.tierods, ...geometry.bars])
          for (const side of rod.pitch_radius_m ? [1, -1] : [0]) content.append(line(x(rod.from_m), middle + side * rod.pitch_radius_m * scale, x(rod.to_m), middle + side * rod.pitch_radius_m * scale, 'green', { 'stroke-width': 2, 'stroke-dasharray': '6 3' }));
        content.append(line(x(0) - 10, middle, x(geometry.length_m) + 10, middle, 'muted', { 'stroke-dasharray': '8 3 2 3' }));
        for (const spring of geometry.springs) {
          const y = middle + radiusAt(geometry, spring.z_m) * scale;
          content.append(path(`M${x(spring.z_m)},${y}l-7,12h14Z`, { fill: color('paper'), stroke: color('blue'), 'stroke-width': 1.5 }));
        }
        for (const disk of geometry.disks) content.append(sv('rect', { x: x(disk.z_m) - 4, y: middle - radiusOf(geometry) * scale - 6, width: 8, height: 2 * radiusOf(geometry) * scale + 12, fill: 'none', stroke: color('purple'), 'stroke-width': 1.5 }));
        for (const sensor of geometry.sensors) content.append(sv('circle', { cx: x(sensor.z_m), cy: middle, r: 2.2, fill: color('ink') }));
        let last = -Infinity;
        for (const group of geometry.groups) {
          const at = x((group.from_m + group.to_m) / 2);
          const half = widthOf(group.name) / 2;
          if (at - half < last + 6 || group.layer_of) continue;
          last = at + half;
          content.append(text(Math.max(half, Math.min(width - half, at)), 14, group.name, { 'text-anchor': 'middle' }));
        }
        for (const mark of marks) for (const [z, share] of mark.points) content.append(line(x(z), bottom + 44, x(z), bottom + 44 - 40 * share, mark.color, { 'stroke-width': 2 }));
        const low = bottom + (marks.length ? 46 : 4);
        content.append(line(x(0), low, x(geometry.length_m), low, 'muted'));
        for (const v of x.ticks(width / 90)) content.append(line(x(v), low, x(v), low + 4, 'muted'), text(x(v), low + 17, num(v), { 'text-anchor': 'middle', class: 'quiet' }));
        content.append(text(width / 2, low + 33, `z [${M}]`, { 'text-anchor': 'middle', class: 'quiet' }));
        return { content, height: low + 40 };
      },
      ...is,
    });
  }

  /* Value and slope, over a sixtieth of the length, of a line through points by rising z. */
  function along(zs, values) {
    const near = (zs[zs.length - 1] - zs[0]) / 120;
    const at = d3.scaleLinear().domain(zs).range(values).clamp(true);
    return (z) => {
      const low = Math.max(zs[0], z - near);
      const high = Math.min(zs[zs.length - 1], z + near);
      return [at(z), high > low ? (at(high) - at(low)) / (high - low) : 0];
    };
  }

  /* The rotor in motion. models: [{name, color, dash, modes: [{z, w, at: predicted at the sensors}]}], the last one moves the
   * drawing; modes: [{label, said, measured, std}]; sensors: z. */
  function motion(is, geometry, identified, modes, models, sensors, ids) {
    const state = { mode: is.first || 0, phase: 1, playing: false };
    const last = models[models.length - 1];
    const measured = modes.some((mode) => mode.measured);
    const over = (model, mode, i) => (mode.measured && known(mode.measured[i]) && mode.std?.[i] > 0 ? (mode.measured[i] - model.modes[state.mode].at[i]) / mode.std[i] : NaN);
    const list = () => {
      const mode = modes[state.mode];
      const lines = models.map((model) => ({ type: 'line', name: model.name, color: model.color, dash: model.dash, points: model.modes[state.mode].z.map((z, i) => [z, model.modes[state.mode].w[i]]) }));
      const dots = mode.measured ? [{ type: 'dots', name: 'measured', color: 'ink', r: 2.8, points: sensors.map((z, i) => [z, mode.measured[i]]) }] : [];
      const noise = mode.measured && mode.std ? [{ type: 'interval', name: null, color: 'muted', points: sensors.map((z, i) => [z, mode.measured[i] - 2 * mode.std[i], mode.measured[i] + 2 * mode.std[i]]), opacity: 0.5 }] : [];
      const all = [...lines, ...dots].flatMap((mark) => mark.points.map((p) => p[1]));
      const domain = [0, geometry.length_m];
      const first = { height: 110, x: { domain, label: measured ? '' : `z [${M}]` }, y: { label: 'deflection', domain: padded(all, 0.08, true) }, marks: [{ type: 'rule', y: 0, solid: true }, ...noise, ...lines, ...dots] };
      if (!measured) return [first];
      const residuals = models.map((model, m) => ({ type: m === models.length - 1 ? 'stems' : 'dots', ring: m < models.length - 1, r: m < models.length - 1 ? 3 : 2.6, name: `residual ${model.name}`, legend: false, color: model.color, points: sensors.map((z, i) => [z, over(model, mode, i)]) }));
      const extreme = Math.max(3, ...residuals.flatMap((mark) => mark.points.map((p) => Math.abs(p[1]))).filter(known));
      return [first, { height: 84, x: { domain, label: `z [${M}]` }, y: { label: 'measured less predicted, over its noise', domain: [-extreme * 1.1, extreme * 1.1] }, marks: [{ type: 'band', from: -2, to: 2 }, { type: 'rule', y: 0, solid: true }, ...residuals] }];
    };
    let group;
    let frame = 0;
    const self = {
      id: 'motion', together: true, legend: () => [...legendOfPanels(list()), ...(geometry.groups.some((g) => isIdentified(g, identified)) ? [['identified part', 'sheets', 'face']] : [])],
      said: () => modes[state.mode].said,
      table: () => {
        const mode = modes[state.mode];
        if (!sensors.length || !last.modes[state.mode].at) return tableOf(list());
        return {
          head: ['sensor', `z [${M}]`, ...(measured ? ['measured', 'noise'] : []), ...models.flatMap((model) => [model.name, ...(measured ? [`residual over noise, ${model.name}`] : [])])],
          rows: sensors.map((z, i) => [ids?.[i] ?? i + 1, z, ...(measured ? [mode.measured?.[i], mode.std?.[i]] : []), ...models.flatMap((model) => [model.modes[state.mode].at[i], ...(measured ? [over(model, mode, i)] : [])])]),
        };
      },
      read: (x, y, drawing) => {
        const z = is.self.boxes[0].x.invert(x);
        if (!sensors.length) return readPanels(is.self, x, is.self.boxes[0].box[3], drawing);
        const i = sensors.reduce((best, at, k) => (Math.abs(at - z) < Math.abs(sensors[best] - z) ? k : best), 0);
        const mode = modes[state.mode];
        drawing.querySelectorAll('.cursor').forEach((mark) => mark.remove());
        drawing.firstChild.append(line(is.self.boxes[0].x(sensors[i]), 4, is.self.boxes[0].x(sensors[i]), is.self.boxes[is.self.boxes.length - 1].box[3], 'muted', { 'stroke-dasharray': '2 2', class: 'cursor' }));
        const said = models.map((model) => `${model.name} ${num(model.modes[state.mode].at?.[i], 3)}${known(over(model, mode, i)) ? `, ${num(over(model, mode, i), 2)} times its noise off` : ''}`);
        return `Sensor ${ids?.[i] ?? i + 1} at ${num(sensors[i])} m: ${mode.measured ? `measured ${num(mode.measured[i], 3)}; ` : ''}${said.join('; ')}.`;
      },
      draw: (width) => {
        const content = sv('g');
        const radius = radiusOf(geometry);
        const lower = drawPanels(list(), is.self, width, 0);
        const { x } = is.self.boxes[0];
        const scale = Math.min((x.range()[1] - x.range()[0]) / geometry.length_m, 70 / radius);
        const amplitude = Math.max(26, Math.min(46, radius * scale * 0.9));
        const height = 2 * radius * scale + 2 * amplitude + 24;
        group = sv('g');
        const turn = () => {
          const model = last.modes[state.mode];
          const mode = modes[state.mode];
          const size = Math.max(...model.w.map(Math.abs), ...(mode.measured || []).filter(known).map(Math.abs), 1e-12);
          const axis = along(model.z, model.w);
          const share = state.phase * amplitude / size;
          const per = x(1) - x(0);
          const w = (z) => { const [value, slope] = axis(z); return [value * share, slope * share / per]; };
          group.replaceChildren(line(x(0) - 8, height / 2, x(geometry.length_m) + 8, height / 2, 'muted', { 'stroke-dasharray': '8 3 2 3' }));
          drawSections(group, geometry, x, height / 2, scale, w, identified);
          group.append(path(d3.line()(model.z.map((z, i) => [x(z), height / 2 - model.w[i] * share])), { stroke: color(last.color), 'stroke-width': 2 }));
          if (mode.measured) sensors.forEach((z, i) => known(mode.measured[i]) && group.append(sv('circle', { cx: x(z), cy: height / 2 - mode.measured[i] * share, r: 3, fill: color('ink') })));
        };
        is.self.turn = turn;
        turn();
        lower.content.setAttribute('transform', `translate(0 ${height})`);
        for (const at of is.self.boxes) at.box = [at.box[0], at.box[1] + height, at.box[2], at.box[3] + height];
        content.append(group, lower.content);
        return { content, height: height + lower.height };
      },
      controls: (redraw) => {
        const play = button('play', () => {
          state.playing = !state.playing;
          play.textContent = state.playing ? 'stop' : 'play';
          play.setAttribute('aria-pressed', state.playing);
          const start = performance.now();
          const step = (now) => {
            state.phase = state.playing ? Math.cos((now - start) / 320) : 1;
            is.self.turn();
            if (state.playing) frame = requestAnimationFrame(step);
          };
          cancelAnimationFrame(frame);
          frame = requestAnimationFrame(step);
        }, { 'aria-pressed': false });
        const choose = modes.map((mode, k) => button(mode.label, () => {
          state.mode = k;
          choose.forEach((other, j) => other.setAttribute('aria-pressed', j === k));
          redraw();
        }, { 'aria-pressed': k === state.mode }));
        return [play, ...choose];
      },
    };
    is.self = Object.assign(self, is);
    return figure(self);
  }

  /* A motion from fits: without and with the causes. */
  function motionOfFits(of, geometry, fits) {
    const fit = fits[fits.length - 1].fit;
    const { shapes } = fit;
    if (!shapes || !shapes.modes.length || !geometry) return null;
    const models = fits.map(({ name, fit: own, color: tint, dash }) => ({
      name, color: tint, dash,
      modes: shapes.modes.map((mode) => {
        const same = own.shapes.modes.find((m) => m.mode === mode.mode && m.measured_mode === mode.measured_mode) || mode;
        return same.predicted_axis?.length ? { z: own.shapes.axis_z_m, w: same.predicted_axis, at: same.predicted } : { z: own.shapes.z_m, w: same.predicted, at: same.predicted };
      }),
    }));
    const quality = fit.modes.filter((mode) => known(mode.nco ?? mode.mac));
    const least = quality.reduce((a, b) => (a && (a.nco ?? a.mac) <= (b.nco ?? b.mac) ? a : b), null);
    const word = least && known(least.nco) ? 'NCO' : 'MAC';
    const modes = shapes.modes.map((shape) => {
      const mode = fit.modes.find((m) => m.mode === shape.mode && m.measured_mode === shape.measured_mode) || {};
      return {
        label: `mode ${shape.mode}`, measured: shape.measured, std: shape.measured_std,
        said: `Mode ${shape.mode}: measured ${num(mode.measured_hz, 5)} ${HZ}, predicted ${num(mode.predicted_hz, 5)} ${HZ} (${signed(mode.error_percent, 2)} %)${known(mode.mac) ? `, MAC ${fixed(mode.mac, 4)}` : ''}${known(mode.nco) ? `, NCO ${fixed(mode.nco, 4)}` : ''}.`,
      };
    });
    const first = least ? Math.max(0, shapes.modes.findIndex((mode) => mode.mode === least.mode)) : 0;
    return motion({
      first,
      title: least ? `The shapes of ${of} against the measured ones: least alike is mode ${least.mode}, ${word} ${fixed(least.nco ?? least.mac, 3)}` : `Predicted shapes of ${modes.length} modes of ${of}: none was measured`,
      caption: `${num(geometry.length_m)} ${M}, ${num(fit.mass_kg)} kg, ${shapes.z_m.length} sensors. Drawn to scale with the deflection enlarged; sections stand normal to the axis. ${shapes.modes.some((m) => m.measured) ? 'Bars and band: two standard deviations of the noise.' : ''}`,
    }, geometry, fit.parameters, modes, models, shapes.z_m, shapes.sensor_id);
  }

  /* ---- fits */

  const wordsOf = (entry) => (entry.causes || []).join(' and ');
  function frequencyFigure(id, groups, title, caption) {
    return panels({ id, title, caption }, () => groups.map(({ name, series, noise }) => {
      const all = [...series.flatMap((s) => s.points.map((p) => p[1])), ...(noise || []).flatMap((p) => [p[1], p[2]])];
      const last = Math.max(...series.flatMap((s) => s.points.map((p) => p[0])), 1);
      return {
        title: name, height: groups.length > 1 ? 110 : 190, inset: 20,
        x: { label: 'mode', domain: [0.5, last + 0.5], ticks: d3.range(1, last + 1), name: (v) => `Mode ${v}` },
        y: { label: 'error of the frequency [%]', domain: padded(all, 0.08, true) },
        marks: [{ type: 'rule', y: 0, solid: true }, { type: 'interval', name: noise?.length ? 'two deviations of the noise' : null, color: 'steel', width: 14, points: noise || [] },
          ...series.map((s) => ({ type: 'stems', ...s }))],
      };
    }));
  }
  const errorsOf = (fit) => fit.modes.filter((m) => known(m.error_percent));
  function seriesOf(name, tint, fit, square, shift = 0) {
    const points = (holdout) => errorsOf(fit).filter((m) => !m.holdout === !holdout).map((m) => [m.mode + shift, m.error_percent]);
    return [{ name, color: tint, square, points: points(0) }, ...(points(1).length ? [{ name: `${name}, held out`, color: tint, ring: true, points: points(1) }] : [])];
  }
  const noiseOf = (fit) => fit.modes.filter((m) => m.frequency_std > 0).map((m) => [m.mode, -200 * m.frequency_std, 200 * m.frequency_std]);
  function frequencies(entry) {
    const r = entry.result;
    const base = r.base || r;
    const fitted = (fit) => rms(errorsOf(fit).filter((m) => !m.holdout).map((m) => m.error_percent));
    const references = (r.references || []).filter((one) => one.quantity === 'error_percent');
    if (r.extended) {
      const [before, after] = [r.gain.frequency_rms_percent.before, r.gain.frequency_rms_percent.after];
      return frequencyFigure('frequencies', [{ series: [...seriesOf('without', 'vermilion', r.base, true), ...seriesOf(`with ${wordsOf(entry)}`, 'blue', r.extended, false, 0.18)], noise: noiseOf(r.base) }],
        `With ${wordsOf(entry)} the errors of the frequencies ${after < before ? 'fall' : 'go'} from ${short(before)} to ${short(after)} % rms`, 'Predicted over measured frequency, less one.');
    }
    const reference = references.length && !r.base ? [{ name: references[0].source || 'reference in the deck', color: 'muted', ring: true, points: references[0].values.map((v, k) => [base.modes[k]?.mode, v]).filter(([k]) => known(k)).map(([k, v]) => [k + 0.18, v]) }] : [];
    return frequencyFigure('frequencies', [{ series: [...seriesOf(r.base ? 'the model' : 'the identified model', 'blue', base), ...reference], noise: noiseOf(base) }],
      `The model leaves ${short(fitted(base))} % rms in the ${errorsOf(base).filter((m) => !m.holdout).length} fitted frequencies`, 'Predicted over measured frequency, less one.');
  }
  function stateFrequencies(r) {
    const groups = r.states.map((state) => ({ name: state.name, series: seriesOf('the model', 'blue', state), noise: noiseOf(state) }));
    const each = r.states.map((state) => rms(errorsOf(state).map((m) => m.error_percent)));
    const worst = each.reduce((best, v, k) => (!(each[best] >= v) ? k : best), 0);
    return frequencyFigure('frequencies', groups, `One set of parameters for ${r.states.length} states: the largest errors, ${short(each[worst])} % rms, are those of ${r.states[worst].name}`, 'Predicted over measured frequency, less one; one panel a state.');
  }
  function correlations(entry) {
    const fit = entry.result.extended || entry.result.base || entry.result;
    return [['mac', 'MAC'], ['nco', 'NCO']].map(([key, word]) => {
      const values = fit[`${key}_matrix`];
      if (!values?.length || !fit.matrix_columns?.length) return null;
      const best = values.map((row) => Math.max(...row.filter(known)));
      const off = values.flatMap((row) => row.filter(known).sort((a, b) => b - a).slice(1, 2));
      return matrix({ id: key, corner: 'measured', across: 'mode of the model', title: `${word} of measured and predicted shapes: the best pairs reach ${fixed(Math.min(...best.filter(known)), 2)} to ${fixed(Math.max(...best.filter(known)), 2)}, the others at most ${fixed(Math.max(0, ...off), 2)}`,
        caption: word === 'MAC' ? 'Modal assurance criterion; rows: measured modes.' : 'Normalised cross orthogonality with the mass condensed onto the sensors; rows: measured modes.' },
      fit.matrix_rows.map((n) => `measured ${n}`), fit.matrix_columns.map(String), (i, j) => values[i][j]);
    });
  }
  function correlation(fit) {
    const names = fit.parameters.map((p) => p.name);
    if (names.length < 2 || !fit.correlation?.length) return null;
    let pair = [0, 1];
    names.forEach((_, i) => names.forEach((__, j) => { if (i < j && Math.abs(fit.correlation[i][j]) > Math.abs(fit.correlation[pair[0]][pair[1]])) pair = [i, j]; }));
    const most = fit.correlation[pair[0]][pair[1]];
    if (!known(most)) return null;
    return matrix({ id: 'correlation', title: `Most alike to the data: ${names[pair[0]]} and ${names[pair[1]]}, correlation ${signed(most, 2)}`, caption: 'Correlation of the parameters. Near 1 or \u22121 the data know a combination of the two better than each alone.' }, names, names, (i, j) => fit.correlation[i][j]);
  }
  function intervalRows(id, title, caption, list) {
    const share = (v, p) => 100 * (v / p.at - 1);
    const shown = list.filter((p) => known(p.at) && p.at !== 0 && p.values.some((v) => known(v.low)));
    if (!shown.length) return null;
    const ends = shown.flatMap((p) => p.values.flatMap((v) => [share(v.low, p), share(v.high, p), share(v.value, p)])).filter(known);
    const out = [...new Map(shown.flatMap((p) => p.values.map((v) => [v.name, [v.name, v.color, 'dot']]))).values()];
    return rows({ id, title, caption, legend: out }, shown.map((p) => ({ ...p, name: `${p.name} = ${num(p.at * unitOf(p.at, p.unit).factor, 4)} ${unitOf(p.at, p.unit).text}` })), [{
      label: 'from the value at the left [%]', domain: padded(ends, 0.05, true), head: ['series', 'value', '95 % from', 'to', 'unit'],
      value: (p) => { const u = unitOf(p.at, p.unit); const v = p.values[p.values.length - 1]; return [v.name, v.value * u.factor, v.low * u.factor, v.high * u.factor, u.text]; },
      draw: (p, x, y, content) => p.values.forEach((v, k) => {
        const at = y + (k - (p.values.length - 1) / 2) * 8;
        if (known(v.low)) content.append(line(x(share(v.low, p)), at, x(share(v.high, p)), at, v.color, { 'stroke-width': 3 }));
        if (known(v.value)) dot(content, x(share(v.value, p)), at, v.color);
      }),
    }]);
  }
  function parameterIntervals(fit) {
    const widths = fit.parameters.map((p) => [50 * (p.ci95[1] - p.ci95[0]) / Math.abs(p.value), p.name]).filter(([v]) => known(v) && v > 0).sort((a, b) => b[0] - a[0]);
    if (!widths.length) return null;
    return intervalRows('intervals', `Least known is ${widths[0][1]}, to \u00b1${short(widths[0][0])} %`, '95 % intervals.', fit.parameters.map((p) => ({ name: p.name, unit: p.unit, at: p.value, values: [{ name: '95 % interval', color: 'blue', value: p.value, low: p.ci95[0], high: p.ci95[1] }] })));
  }
  function fitFigures(fit) {
    const { history } = fit;
    if (!history || history.length < 2) return [];
    const names = fit.parameters.map((p) => p.name);
    const at = (key) => history.map((h) => [h.iteration, h[key]]).filter(([, v]) => v > 0);
    const least = history[history.length - 1].objective;
    const list = [panels({ id: 'convergence', title: `The functional falls from ${num(history[0].objective, 3)} to ${num(least, 3)} in ${fit.iterations} iterations`, caption: `${fit.stop_reason}. Accepted points of Levenberg-Marquardt.` }, [
      { height: 130, x: { label: 'iteration', domain: [0, history.length - 1], ticks: d3.range(0, history.length, Math.ceil(history.length / 12)) }, y: { label: 'functional and gradient', log: true, domain: padded(at('objective').concat(at('gradient')).map((p) => p[1]), 0).map((v, i) => (i ? v * 3 : Math.max(v, 1e-300) / 3)) },
        marks: [{ type: 'line', name: 'functional', color: 'blue', points: at('objective') }, { type: 'line', name: 'gradient', color: 'vermilion', dash: true, points: at('gradient') }, { type: 'dots', color: 'blue', points: at('objective') }] }])];
    if (names.length)
      list.push(panels({ id: 'iterates', title: `From the start ${names.slice(0, 2).map((name, p) => `${name} moves by ${signed(100 * (fit.parameters[p].value / fit.parameters[p].start - 1), 0)} %`).join(', ')}`, caption: 'Parameters over their final values, at each accepted point.' }, [
        { height: 130, x: { label: 'iteration', domain: [0, history.length - 1], ticks: d3.range(0, history.length, Math.ceil(history.length / 12)) }, y: { label: 'value over final value', domain: padded(history.flatMap((h) => h.x.map((v, p) => v / fit.parameters[p].value)), 0.06) },
          marks: names.slice(0, 5).map((name, p) => ({ type: 'line', name, color: COLORS[p], points: history.map((h) => [h.iteration, h.x[p] / fit.parameters[p].value]) })) }]));
    const bounded = fit.parameters.filter((p) => known(p.lower) && known(p.upper) && p.upper > p.lower);
    if (bounded.length && fit.bijection_chi > 0) {
      const y = d3.range(-120, 121, 4);
      const inverse = (p, v) => Math.log((p.upper - p.lower) / (v - p.lower) - 1) / fit.bijection_chi;
      const share = (p, v) => (v - p.lower) / (p.upper - p.lower);
      list.push(panels({ id: 'bijection', title: `No step leaves the bounds: ${bounded.slice(0, 2).map((p) => `${p.name} ends at ${short(100 * share(p, p.value))} % of its range`).join(', ')}`, caption: 'value = lower + (upper \u2212 lower)/(1 + exp(chi y)), in whose y the steps are made. Rings: start, dots: end.' }, [
        { height: 130, x: { label: 'y', domain: [-120, 120] }, y: { label: 'share of the range between the bounds', domain: [0, 1] }, marks: [
          { type: 'line', name: 'bijection', color: 'muted', points: y.map((v) => [v, 1 / (1 + Math.exp(fit.bijection_chi * v))]) },
          ...bounded.slice(0, 5).flatMap((p, k) => [{ type: 'dots', name: `${p.name}, start`, ring: true, color: COLORS[k], points: [[inverse(p, p.start), share(p, p.start)]] }, { type: 'dots', name: `${p.name}, end`, color: COLORS[k], points: [[inverse(p, p.value), share(p, p.value)]] }])] }]));
    }
    return list;
  }

  /* ---- diagnosis */

  function causesFigures(entry) {
    const d = entry.result;
    return d.rounds.map((round) => {
      const all = d.candidates.map((c, i) => ({ ...c, label: entry.words[i][0], fate: entry.words[i][1] })).filter((c) => c.round === round.round);
      const list = all.filter((c) => c.refitted).slice(0, 14);
      if (!list.length) return null;
      const stay = list.filter((c) => c.fate === 'named' || c.fate.startsWith('possible'));
      const names = stay.map((c) => c.label);
      const several = (key) => list.filter((c) => known(c[key])).length > 1;
      const out = several('holdout_rms') ? ['holdout_rms', 'error of held-out modes [%]'] : several('sensor_out_rms') ? ['sensor_out_rms', 'error at sensors left out, over its noise'] : null;
      const tint = (c) => (c.fate === 'named' ? 'green' : c.fate.startsWith('possible') ? 'ochre' : 'steel');
      const title = stay.length && stay[0].fate === 'named' ? `${names[0]} lowers the misfit by ${num(stay[0].chi2_drop, 3)} of ${num(round.chi2, 3)}`
        : stay.length === 1 ? `One cause is likely, and not named: ${names[0]}`
          : stay.length ? `${stay.length} causes cannot be told apart: ${names.slice(0, 3).join('; ')}${names.length > 3 ? '; \u2026' : ''}`
            : `None of ${list.length} single causes that were fitted is likely`;
      const columns = [{ label: 'drop of the misfit \u03c7\u00b2', domain: padded(list.map((c) => Math.max(c.chi2_drop, 0)).concat(0), 0.04, true), head: ['drop of the misfit', 'what became of it'], value: (c) => [c.chi2_drop, c.fate],
        draw: (c, x, y, content) => bar(content, x(0), x(Math.max(c.chi2_drop, 0)), y, tint(c)) }];
      if (out) columns.push({ label: out[1], domain: padded(list.map((c) => c[out[0]]), 0.06, true), value: (c) => c[out[0]], draw: (c, x, y, content) => known(c[out[0]]) && dot(content, x(c[out[0]]), y, tint(c) === 'steel' ? 'muted' : tint(c)) });
      return rows({ id: `causes-${round.round}`, title, caption: `Causes that were fitted${all.length > list.length ? `; ${all.length - list.length} more in the table` : ''}.${out ? ' The longest bar need not win: the right panel is the error on data that were not fitted.' : ''}`,
        legend: [['named', 'green', 'face'], ['possible', 'ochre', 'face'], ['unlikely', 'steel', 'face']].filter(([, own]) => list.some((c) => tint(c) === own)) }, list.map((c) => ({ ...c, name: c.label, strong: stay.includes(c) })), columns);
    });
  }
  function gainFigures(entry) {
    const { gain, extended, today, base } = entry.result;
    const list = [];
    const kinds = [['frequency_rms_percent', 'fitted frequencies [%]', 1], ['holdout_frequency_rms_percent', 'held-out frequencies [%]', 1], ['mode_out_frequency_rms_percent', 'frequencies left out in turn [%]', 1], ['shape_rms', 'fitted shapes [% of the largest]', 100], ['holdout_shape_rms', 'held-out shapes [%]', 100], ['mode_out_shape_rms', 'shapes of modes left out [%]', 100], ['sensor_out_shape_rms', 'shapes at sensors left out [%]', 100], ['chi2_per_dof', '\u03c7\u00b2 per degree of freedom', 1]]
      .map(([key, name, factor]) => ({ name, before: factor * gain[key].before, after: factor * (gain[key].after ?? NaN) })).filter((row) => row.before > 0 && row.after > 0);
    if (extended && kinds.length) {
      const held = kinds.find((row) => /held|left out/.test(row.name)) || kinds[0];
      const ends = kinds.flatMap((row) => [row.before, row.after]);
      list.push(rows({ id: 'gain', title: `Also on what was not fitted: ${held.name.replace(/ \[.*/, '')} ${held.after < held.before ? 'improve' : 'do not improve'}, ${short(held.before)} \u2192 ${short(held.after)} %`, caption: 'Errors, rms. Logarithmic.', legend: [['without', 'vermilion', 'dot'], [`with ${wordsOf(entry)}`, 'blue', 'dot']] }, kinds, [{
        label: 'error', log: true, domain: [Math.min(...ends) / 1.6, Math.max(...ends) * 1.6], head: ['without', 'with'], value: (row) => [row.before, row.after],
        draw: (row, x, y, content) => { content.append(line(x(row.before), y, x(row.after), y, 'muted')); dot(content, x(row.before), y, 'vermilion'); dot(content, x(row.after), y, 'blue'); } }]));
    }
    const moved = (extended || base).parameters.map((p) => {
      const change = gain.parameters.find((g) => g.name === p.name) || {};
      const fit = today?.parameters.find((t) => t.name === p.name);
      return { name: p.name, unit: p.unit, at: p.value, values: [...(fit ? [{ name: 'fit as the deck states it', color: 'muted', value: fit.value, low: fit.ci95[0], high: fit.ci95[1] }] : []), ...(extended && known(change.before) ? [{ name: 'without', color: 'vermilion', value: change.before, low: change.before_ci95[0], high: change.before_ci95[1] }] : []), { name: extended ? `with ${wordsOf(entry)}` : 'the model', color: 'blue', value: p.value, low: p.ci95[0], high: p.ci95[1] }] };
    });
    const shift = gain.parameters.map((p) => [100 * (p.after / p.before - 1), p.name]).filter(([v, name]) => known(v) && moved.some((m) => m.name === name)).sort((a, b) => Math.abs(b[0]) - Math.abs(a[0]))[0];
    list.push(intervalRows('change', extended && shift ? `The cause had biased ${shift[1]}: it moves by ${signed(shift[0], 1)} %` : 'How well the parameters are known', '95 % intervals.', moved));
    return list;
  }
  function placesFigure(entry) {
    const d = entry.result;
    if (!d.geometry || !d.sensors.length || d.verdict.kind === 'adequate') return null; /* the most of mere noise is no place to look at */
    const worst = d.sensors.filter((s) => known(s.rms)).sort((a, b) => b.rms - a.rms)[0];
    const peak = d.localisation.slice().sort((a, b) => b.indicator - a.indicator)[0];
    const marks = [...(worst ? [{ type: 'rule', y: 1 }, { type: 'stems', name: 'residual at the sensors over its noise', color: 'vermilion', points: d.sensors.map((s) => [s.z_m, s.rms]) }] : []), { type: 'line', name: 'force that the model lacks', color: 'blue', points: d.localisation.map((l) => [l.z_m, l.indicator]) }];
    const named = d.verdict.causes.flatMap((c) => c.parameters.filter((p) => p.name === 'z').map((p) => p.value));
    return [rotor(d.geometry, (d.extended || d.base)?.parameters, [{ name: 'force that the model lacks', color: 'blue', points: d.localisation.map((l) => [l.z_m, Math.max(0, Math.min(1, l.indicator))]) }, ...(named.length ? [{ name: 'cause that was named', color: 'vermilion', points: named.map((z) => [z, 1]) }] : [])], { id: 'places', title: peak ? `The model lacks most force around z = ${num(peak.z_m, 3)} m` : 'The rotor' }),
      panels({ id: 'residuals', title: worst ? `Shapes miss most at sensor ${worst.id}, z = ${num(worst.z_m, 3)} ${M}: ${short(worst.rms)} times the noise` : 'Where the model lacks force', caption: 'Of the model without the cause. 1: what the noise alone leaves.' }, [{ height: 130, x: { label: `z [${M}]`, domain: [0, d.geometry.length_m] }, y: { label: 'over its noise; share of the largest force', domain: padded(marks.flatMap((m) => (m.points || []).map((p) => p[1])).concat(1), 0.06, true) }, marks }])];
  }
  function limitsFigure(entry) {
    const list = entry.result.detectable.filter((l) => known(l.z_m) && !l.beyond);
    const { geometry } = entry.result;
    if (!geometry || !list.length) return null;
    return rows({ id: 'limits', title: `${list.length} causes have a place where they show best, ${entry.result.detectable.filter((l) => l.beyond).length} do not show at any size`, caption: 'Where on the rotor a cause shows best, and what it would have to be there at least.' },
      list.slice(0, 16).map((l) => ({ ...l, name: `${plain(l.id)}${l.target ? ` of ${l.target.replace('|', ' and ')}` : ''}: ${l.parameter} ${num(l.smallest * unitOf(l.smallest, l.unit).factor, 2)} ${unitOf(l.smallest, l.unit).text}` })),
      [{ label: `z [${M}]`, domain: [0, geometry.length_m], value: (l) => l.z_m, draw: (l, x, y, content) => dot(content, x(l.z_m), y, 'purple') }]);
  }

  /* ---- modes of a model */

  function modesFigures(r) {
    const { modes, geometry } = r;
    const list = [];
    if (!modes.length || !geometry) return list;
    const shaped = modes.filter((mode) => mode.shape?.length > 1);
    const size = (mode) => `${num(mode.full_hz, 5)} ${HZ}${known(mode.measured_hz) ? `, measured ${num(mode.measured_hz, 5)} ${HZ} (${signed(mode.error_percent, 2)} %)` : ''}`;
    const compared = modes.filter((mode) => known(mode.error_percent)).sort((a, b) => Math.abs(b.error_percent) - Math.abs(a.error_percent))[0];
    if (shaped.length)
      list.push(motion({
        title: `${modes.length} bending modes from ${num(modes[0].full_hz, 4)} to ${num(modes[modes.length - 1].full_hz, 5)} ${HZ}${compared ? `; furthest from its measured one is mode ${compared.mode}, ${signed(compared.error_percent, 1)} %` : ''}`,
        caption: 'Drawn to scale with the deflection enlarged; sections stand normal to the axis.',
      }, geometry, [], shaped.map((mode) => ({ label: `mode ${mode.mode}`, said: `Mode ${mode.mode}: ${size(mode)}.` })),
      [{ name: 'the model', color: 'blue', modes: shaped.map((mode) => (mode.axis?.length ? { z: r.axis_z_m, w: mode.axis, at: mode.shape } : { z: r.sensor_z_m, w: mode.shape, at: mode.shape })) }], r.sensor_z_m, null));
    else list.push(rotor(geometry));
    if (compared)
      list.push(frequencyFigure('frequencies', [{ series: [{ name: 'the model', color: 'blue', points: modes.filter((m) => known(m.error_percent)).map((m) => [m.mode, m.error_percent]) }] }], `The model as the deck states it misses mode ${compared.mode} most, by ${signed(compared.error_percent, 1)} %`, 'Predicted over measured frequency, less one.'));
    if (r.meridian) list.push(meridian(r));
    return list;
  }
  /* Half of the section through the axis, deflected, its elements shaded by their share of the strain energy. */
  function meridian(r) {
    const { r_m: rs, z_m: zs, elements } = r.meridian;
    const modes = r.modes.filter((mode) => mode.meridian);
    if (!modes.length) return null;
    let chosen = 0;
    const byGroup = (mode) => {
      const sum = new Map();
      elements.forEach((e, i) => sum.set(r.geometry.groups[e.group]?.name, (sum.get(r.geometry.groups[e.group]?.name) || 0) + mode.meridian.energy[i]));
      return [...sum.entries()].sort((a, b) => b[1] - a[1]);
    };
    const title = () => { const [name, share] = byGroup(modes[chosen])[0]; return `Mode ${modes[chosen].mode}, ${num(modes[chosen].full_hz, 5)} ${HZ}: ${fixed(100 * share, 0)} % of its strain energy are in ${name}`; };
    const is = {
      id: 'meridian', title: title(), caption: `The meridian of the solid, ${elements.length} elements, deflection enlarged. Shade: strain energy of an element over the largest.`,
      table: () => ({ head: ['part', ...modes.map((mode) => `mode ${mode.mode}`)], rows: byGroup(modes[0]).map(([name]) => [name, ...modes.map((mode) => byGroup(mode).find(([other]) => other === name)[1])]) }),
      controls: (redraw) => {
        const choose = modes.map((mode, k) => button(`mode ${mode.mode}`, () => {
          chosen = k;
          is.title = title();
          choose.forEach((other, j) => other.setAttribute('aria-pressed', j === k));
          redraw();
        }, { 'aria-pressed': !k }));
        return choose;
      },
      draw: (width) => {
        const content = sv('g');
        const { u, w, energy } = modes[chosen].meridian;
        const top = Math.max(...rs);
        const left = 56;
        const x = d3.scaleLinear().domain([Math.min(...zs), Math.max(...zs)]).range([left, width - 16]);
        const scale = Math.min(x(1) - x(0), 150 / top);
        const large = 0.35 * top;
        const high = (top + 2 * large) * scale;
        const y = (radius) => 12 + high - (radius + large) * scale;
        const most = Math.max(...energy);
        const levels = Array.from({ length: 11 }, () => '');
        elements.forEach((e, i) => {
          const corners = e.corner.map((c) => `${(x(zs[c]) + w[c] * large * scale).toFixed(1)},${y(rs[c] + u[c] * large).toFixed(1)}`);
          levels[Math.round(10 * Math.sqrt(energy[i] / most))] += `M${corners.join('L')}Z`;
        });
        levels.forEach((d, k) => d && content.append(path(d, { fill: color('ramp'), 'fill-opacity': (0.05 + 0.095 * k).toFixed(3), stroke: color('grid'), 'stroke-width': 0.3 })));
        content.append(line(left, y(0), width - 16, y(0), 'muted', { 'stroke-dasharray': '8 3 2 3' }), text(0, 11, `r [${M}]`, { class: 'quiet' }));
        for (const v of d3.scaleLinear().domain([0, top]).ticks(Math.min(3, top * scale / 14))) content.append(text(left - 8, y(v) + 4, num(v), { 'text-anchor': 'end', class: 'quiet' }), line(left - 5, y(v), left, y(v), 'muted'));
        const low = 18 + high;
        content.append(line(left, low, width - 16, low, 'muted'));
        for (const v of x.ticks(width / 90)) content.append(line(x(v), low, x(v), low + 4, 'muted'), text(x(v), low + 17, num(v), { 'text-anchor': 'middle', class: 'quiet' }));
        content.append(text((left + width) / 2, low + 33, `z [${M}]`, { 'text-anchor': 'middle', class: 'quiet' }));
        for (let k = 0; k <= 10; k++) content.append(sv('rect', { x: left + k * 12, y: low + 42, width: 12, height: 10, fill: color('ramp'), 'fill-opacity': (0.05 + 0.095 * k).toFixed(3) }));
        content.append(text(left, low + 66, '0 to 1: energy over the largest (root)', { class: 'quiet' }));
        return { content, height: low + 74 };
      },
    };
    return figure(is);
  }

  /* ---- sensitivities, transfer functions, modal analysis */

  function sensitivityFigures(r) {
    const modes = r.frequency_hz.map((_, k) => `mode ${k + 1}`);
    const cells = r.parameters.flatMap((p) => p.frequency_change.map((v, k) => [v, p.name, k + 1])).filter(([v]) => known(v)).sort((a, b) => Math.abs(b[0]) - Math.abs(a[0]));
    if (!cells.length) return [];
    const list = [matrix({ id: 'sensitivity', corner: 'parameter', title: `Most sensitive: mode ${cells[0][2]}, ${num(cells[0][0], 2)} % for 1 % of ${cells[0][1]}`, caption: 'Relative change of a frequency for that of a parameter, at the values above.' }, r.parameters.map((p) => p.name), modes, (i, k) => r.parameters[i].frequency_change[k], Math.abs(cells[0][0]), 3)];
    if (r.relative_value.length > 1) {
      const most = Math.max(...r.parameters.flatMap((p) => p.curves.flat()).filter(known));
      list.push(panels({ id: 'sensitivity-curves', title: `Half to one and a half of ${r.parameters.map((p) => p.name).slice(0, 3).join(', ')}: a component of the functional reaches ${num(most, 2)}`, caption: 'E\u00b2/2 of each mode, the other parameters at their values; one panel a parameter.' },
        r.parameters.slice(0, 6).map((p) => ({ title: p.name, height: 120, x: { label: 'value over reference', domain: range(r.relative_value) }, y: { label: 'component of the functional', domain: [0, most * 1.05] }, marks: p.curves.slice(0, 5).map((curve, k) => ({ type: 'line', name: `mode ${k + 1}`, color: COLORS[k], points: curve.map((v, i) => [r.relative_value[i], v]) })) }))));
    }
    const growth = r.functional_growth;
    if (growth) {
      const series = [['HYBRID', growth.hybrid.objective, 'blue'], ['HYBRID_F', growth.hybrid_f.objective, 'vermilion'], ['shapes alone', growth.shapes_alone, 'green']];
      const all = series.flatMap(([, values]) => values).filter((v) => v > 0);
      list.push(panels({ id: 'growth', title: `The functionals grow as epsilon to the power ${fixed(2 * growth.hybrid.slope, 2)} and ${fixed(2 * growth.hybrid_f.slope, 2)}`, caption: 'All parameters raised by epsilon, shapes perturbed. Theory says 2; the shapes alone leave nothing but rounding.' }, [
        { height: 170, x: { label: 'epsilon\u00b2', log: true, domain: range(growth.epsilon_squared) }, y: { label: 'functional', log: true, domain: [Math.min(...all) / 3, Math.max(...all) * 3] }, marks: series.map(([name, values, tint]) => ({ type: 'line', name, color: tint, log: true, points: values.map((v, i) => [growth.epsilon_squared[i], v > 0 ? v : NaN]) })) }]));
    }
    return list;
  }
  /* ---- the machine in operation: labels F, B, M of the whirl; bands of the Campbell diagram as dashes above and below */

  function speedsFigures(r) {
    const last = r.campbell[r.campbell.length - 1].speed_rpm;
    const rpm = { label: 'speed [rpm]', domain: [0, last] };
    const of = (number, value) => r.campbell.map((c) => [c.speed_rpm, value(c.modes.find((m) => m.mode === number) || {})]).map(([x, v]) => [x, known(v) ? v : NaN]);
    /* modes far above every line of excitation meet none: they would press the others to the axis; an unstable one stays */
    const least = (number, value) => Math.min(...of(number, value).map(([, v]) => v).filter(known));
    const lines = Math.max(last / 60 * r.harmonic, ...(r.excitation || []).map((e) => e.hz + e.per_revolution * last / 60));
    const numbers = [...new Set(r.campbell.flatMap((c) => c.modes.map((m) => m.mode)))].sort((a, b) => a - b).filter((n) => least(n, (m) => m.frequency_hz) < 2 * lines || least(n, (m) => m.log_decrement) < 0).slice(0, 12);
    const whirl = (number) => { const seen = new Set(r.campbell.slice(1).map((c) => (c.modes.find((m) => m.mode === number) || {}).whirl).filter(Boolean)); return seen.size === 1 ? [...seen][0][0].toUpperCase() : 'M'; };
    const top = Math.min(2 * lines, Math.max(lines, ...numbers.flatMap((n) => of(n, (m) => m.frequency_hz).map(([, v]) => v)).filter(known)) * 1.05);
    const at = (hz, turn) => (x) => hz + turn * x / 60;
    const excited = (r.excitation || []).filter((e) => !(e.hz === 0 && e.per_revolution === r.harmonic)).map((e) => ({ type: 'line', name: e.name, color: 'steel', width: 1, points: [0, last].map((x) => [x, at(e.hz, e.per_revolution)(x)]) }));
    const running = known(r.low_rpm) ? [{ type: 'rule', x: r.low_rpm }, { type: 'rule', x: r.high_rpm }] : [];
    const first = r.critical_speeds[0];
    const leastDamped = [...numbers].sort((a, b) => least(a, (m) => m.log_decrement) - least(b, (m) => m.log_decrement)).slice(0, 2);
    const list = [panels({ id: 'campbell', title: first ? `${r.critical_speeds.length} critical speeds up to ${num(last)} rpm, the first at ${num(first.speed_rpm)} rpm` : `No critical speed up to ${num(last)} rpm`, caption: 'Campbell diagram: frequencies in the fixed frame, F forward, B backward, M mixed, up to twice the highest line of excitation; dots: critical speeds; shaded: 95 % intervals by the linear prediction, of the log decrement those of the two least damped modes; dashed lines: the running range.' }, [
      { height: 300, x: rpm, y: { label: `frequency [${HZ}]`, domain: [0, top] }, marks: [
        ...running,
        ...numbers.map((n, i) => ({ type: 'interval', area: true, color: COLORS[i % COLORS.length], legend: false, points: r.campbell.map((c) => [c.speed_rpm, c.modes.find((m) => m.mode === n)]).filter(([, m]) => m && known(m.ci95[0])).map(([x, m]) => [x, m.ci95[0], m.ci95[1]]) })).filter((mark) => mark.points.length > 1),
        ...numbers.map((n, i) => ({ type: 'line', name: `mode ${n} ${whirl(n)}`, color: COLORS[i % COLORS.length], points: of(n, (m) => m.frequency_hz) })),
        { type: 'line', name: `${r.harmonic === 1 ? '' : `${num(r.harmonic)} times the `}speed`, color: 'muted', points: [[0, 0], [last, last / 60 * r.harmonic]] },
        ...excited,
        { type: 'dots', name: 'critical speeds', color: 'vermilion', points: r.critical_speeds.map((c) => [c.speed_rpm, c.speed_rpm / 60 * r.harmonic]) }] },
      { height: 130, x: rpm, y: { label: 'log decrement', domain: range([0, ...numbers.flatMap((n) => of(n, (m) => m.log_decrement).map(([, v]) => v)).filter(known)]) }, marks: [...leastDamped.map((n) => ({ type: 'interval', area: true, color: COLORS[numbers.indexOf(n) % COLORS.length], legend: false, points: r.campbell.map((c) => [c.speed_rpm, c.modes.find((m) => m.mode === n)]).filter(([, m]) => m?.log_decrement_ci95 && known(m.log_decrement_ci95[0])).map(([x, m]) => [x, ...m.log_decrement_ci95]) })).filter((mark) => mark.points.length > 1), ...numbers.map((n, i) => ({ type: 'line', name: `mode ${n} ${whirl(n)}`, color: COLORS[i % COLORS.length], legend: false, points: of(n, (m) => m.log_decrement) }))] }])];
    if (r.unbalance.length) {
      const most = Math.max(...r.unbalance.flatMap((u) => u.amplitude_m).filter(known)) * 1e6;
      const upper = Math.max(...r.unbalance.flatMap((u) => [...u.amplitude_m, ...(u.to_m || [])]).filter(known)) * 1e6;
      list.push(panels({ id: 'response', title: `Unbalance response: up to ${num(most, 3)} \u00b5m`, caption: 'Amplitude zero to peak and lag at the probes; shaded: 95 % intervals.' }, [
        { height: 200, x: rpm, y: { label: 'amplitude [\u00b5m]', domain: [0, upper * 1.05] }, marks: [...r.unbalance.slice(0, 5).map((u, i) => ({ type: 'interval', area: true, color: COLORS[i], legend: false, points: u.speed_rpm.map((x, k) => [x, u.from_m?.[k] * 1e6, u.to_m?.[k] * 1e6]).filter((p) => known(p[1])) })).filter((mark) => mark.points.length > 1), ...r.unbalance.slice(0, 5).map((u, i) => ({ type: 'line', name: u.probe, color: COLORS[i], points: u.speed_rpm.map((x, k) => [x, known(u.amplitude_m[k]) ? u.amplitude_m[k] * 1e6 : NaN]) }))] },
        { height: 130, x: rpm, y: { label: 'lag [\u00b0]', domain: [0, 360] }, marks: r.unbalance.slice(0, 5).map((u, i) => ({ type: 'line', name: u.probe, color: COLORS[i], legend: false, points: u.speed_rpm.map((x, k) => [x, known(u.phase_deg[k]) ? u.phase_deg[k] : NaN]) })) }]));
    }
    const rows = r.map.filter((row) => row.speed_rpm.length);
    if (rows.length > 1) {
      const count = Math.min(8, Math.max(...rows.map((row) => row.speed_rpm.length)));
      const all = rows.flatMap((row) => row.speed_rpm.slice(0, count));
      list.push(panels({ id: 'speed-map', title: `Critical speed map: the first from ${num(rows[0].speed_rpm[0])} to ${num(rows[rows.length - 1].speed_rpm[0])} rpm`, caption: 'Undamped forward critical speeds over the stiffness of all bearings, the stated one being 1; shaded: 95 % intervals by what else is uncertain.' }, [
        { height: 220, x: { label: 'stiffness of the bearings over that stated', log: true, domain: range(rows.map((row) => row.stiffness_factor)) }, y: { label: 'critical speed [rpm]', log: true, domain: [Math.min(...all) / 1.3, Math.max(...all) * 1.3] },
          marks: [...Array.from({ length: count }, (_, k) => ({ type: 'interval', area: true, color: COLORS[k % COLORS.length], legend: false, points: rows.filter((row) => row.speed_rpm.length > k && known(row.from_rpm?.[k])).map((row) => [row.stiffness_factor, row.from_rpm[k], row.to_rpm[k]]) })).filter((mark) => mark.points.length > 1), ...Array.from({ length: count }, (_, k) => ({ type: 'line', name: `${k + 1}`, color: COLORS[k % COLORS.length], log: true, points: rows.filter((row) => row.speed_rpm.length > k).map((row) => [row.stiffness_factor, row.speed_rpm[k]]) }))] }]));
    }
    if (first) {
      const shown = r.critical_speeds.slice(0, 6);
      list.push(panels({ id: 'critical-shapes', title: `Shapes at ${shown.length} critical speeds`, caption: 'Amplitude of the motion in x and in y along the rotor, the largest being 1.' }, shown.map((c) => ({
        title: `${num(c.speed_rpm)} rpm, ${c.whirl}`, height: 90, x: { label: `z [${M}]`, domain: range(c.z) }, y: { label: 'amplitude', domain: [0, 1.05] },
        marks: ['x', 'y'].map((axis, i) => ({ type: 'line', name: axis, color: COLORS[i], points: c.z.map((z, k) => [z, Math.hypot(c[`${axis}_re`][k], c[`${axis}_im`][k])]) })) }))));
    }
    return list;
  }
  const readable = (unit) => (unit || '').replace('s2', 's\u00b2').replace(/^(.*)\/\((.*) N\)$/, '$1/$2/N').replace(' N', '/N');
  function functionFigure(id, title, caption, choices, unit, lines) {
    let chosen = 0;
    const magnitude = (re, im) => re.map((v, i) => Math.hypot(v, im[i]));
    const phase = (re, im) => re.map((v, i) => Math.atan2(im[i], v) * 180 / Math.PI);
    const is = {
      id, title: title(choices[0]), caption, zoom: true, together: true,
      controls: (redraw) => {
        const choose = choices.length > 1 ? choices.slice(0, 24).map((c, k) => button(c.label, () => {
          chosen = k;
          is.title = title(choices[k]);
          choose.forEach((other, j) => other.setAttribute('aria-pressed', j === k));
          redraw();
        }, { 'aria-pressed': !k })) : [];
        return choose;
      },
    };
    const list = () => {
      const c = choices[chosen];
      const f = c.frequency_hz;
      const within = f.map((v) => !is.range || (v >= is.range[0] && v <= is.range[1]));
      const parts = [['synthesised', c.synthesised_re, c.synthesised_im, 'blue'], ['measured', c.measured_re, c.measured_im, 'vermilion']].filter(([, re]) => re?.length);
      const levels = parts.flatMap(([, re, im]) => magnitude(re, im).filter((v, i) => v > 0 && within[i]));
      const domain = range(f);
      const marks = (lines || []).map((hz) => ({ type: 'rule', x: hz }));
      return [{ height: 190, x: { label: '', domain }, y: { label: `magnitude [${unit}]`, log: true, domain: [Math.min(...levels) / 1.5, Math.max(...levels) * 1.5] }, marks: [...marks, ...parts.map(([name, re, im, tint]) => ({ type: 'line', width: 1.3, name, color: tint, points: magnitude(re, im).map((v, i) => [f[i], v > 0 ? v : NaN]) })).reverse()] },
        { height: 90, x: { label: `frequency [${HZ}]`, domain }, y: { label: 'phase [\u00b0]', domain: [-190, 190], ticks: [-180, -90, 0, 90, 180] }, marks: parts.map(([name, re, im, tint]) => ({ type: 'line', width: 1, name: `phase ${name}`, color: tint, points: phase(re, im).map((v, i, all) => [f[i], i && Math.abs(v - all[i - 1]) > 300 ? NaN : v]) })).reverse() }];
    };
    const whole = panels(is, list);
    return whole;
  }
  function transferFigure(r) {
    const choices = r.functions.filter((f) => f.frequency_hz).map((f) => ({ ...f, label: `${f.response} over ${f.reference}` }));
    if (!choices.length) return null;
    const within = r.modes.filter((mode) => mode.model_hz >= r.low_hz && mode.model_hz <= r.high_hz).map((mode) => mode.model_hz);
    return functionFigure('transfer', (c) => `${plain(r.quantity)} at ${c.response} for a force at ${c.reference}: ${within.length} modes from ${num(r.low_hz)} to ${num(r.high_hz)} ${HZ}${known(c.frac) ? `, FRAC ${fixed(c.frac, 3)}` : ''}`, `Dashed: modes of the model. Drag along the axis to zoom.`, choices, readable(r.unit), within);
  }
  function stabilisation(r) {
    const poles = r.stabilisation.filter((p) => p.damping > 0);
    if (!poles.length) return null;
    const part = (filter) => poles.filter(filter).map((p) => [p.frequency_hz, p.order]);
    const is = { id: 'stabilisation', zoom: true, title: `${r.modes.length} modes are stable over the orders up to ${r.order}`, caption: 'Dashed: modes that were picked. Grey line: rms of the measured functions. Drag along the axis to zoom.' };
    const level = r.rms_measured?.length ? d3.scaleLog().domain(range(r.rms_measured.filter((v) => v > 0))).range([0, r.order]) : null;
    return panels(is, () => [{ height: 260, x: { label: `frequency [${HZ}]`, domain: [r.source.low_hz, r.source.high_hz] }, y: { label: 'order', domain: [0, r.order * 1.03] }, marks: [
      ...(level ? [{ type: 'line', color: 'steel', width: 1, points: r.rms_frequency_hz.map((f, i) => [f, r.rms_measured[i] > 0 ? level(r.rms_measured[i]) : NaN]) }] : []),
      { type: 'dots', name: 'unstable', color: 'steel', r: 1.4, points: part((p) => !p.stable_frequency) },
      { type: 'dots', name: 'frequency stable', color: 'ochre', r: 2, points: part((p) => p.stable_frequency && !p.stable_damping) },
      { type: 'dots', name: 'frequency and damping stable', color: 'blue', r: 2.2, points: part((p) => p.stable_frequency && p.stable_damping) },
      ...r.modes.map((mode) => ({ type: 'rule', x: mode.frequency_hz, color: 'vermilion' }))] }]);
  }
  function emaShapes(r) {
    const list = [];
    const points = r.modes[0]?.shape || [];
    if (points.length > 1) {
      let chosen = 0;
      const is = {
        id: 'shapes', title: `${r.modes.length} mode shapes at ${points.length} points: ${fixed(Math.min(...r.modes.map((m) => m.mpc)), 3)} is the smallest phase collinearity`, caption: 'Real shapes, largest component 1, over the points in the order of the file; bars: two standard deviations. Rings: imaginary part of the complex shape.',
        said: () => `Mode ${r.modes[chosen].mode}: ${num(r.modes[chosen].frequency_hz, 6)} ${HZ}, damping ${num(100 * r.modes[chosen].damping, 3)} %, MPC ${fixed(r.modes[chosen].mpc, 3)}.`,
        controls: (redraw) => {
          let playing = null;
          const choose = r.modes.map((mode, k) => button(`mode ${mode.mode}`, () => { chosen = k; choose.forEach((other, j) => other.setAttribute('aria-pressed', j === k)); redraw(); }, { 'aria-pressed': !k }));
          const play = button('play', () => {
            const start = performance.now();
            const step = (now) => { is.phase = (now - start) / 320; redraw(); playing = requestAnimationFrame(step); };
            if (playing) { cancelAnimationFrame(playing); playing = null; is.phase = 0; redraw(); } else playing = requestAnimationFrame(step);
            play.textContent = playing ? 'stop' : 'play';
          });
          return [play, ...choose];
        },
      };
      list.push(panels(is, () => {
        const { shape } = r.modes[chosen];
        const turn = is.phase || 0;
        const at = shape.map((p, i) => [i + 1, p.complex_re * Math.cos(turn) - p.complex_im * Math.sin(turn)]);
        return [{ height: 170, inset: 16, x: { label: 'point', domain: [1, Math.max(2, shape.length)], ticks: d3.range(1, shape.length + 1, Math.ceil(shape.length / 12)), names: (v) => (shape[v - 1] ? String(shape[v - 1].node) : ''), name: (v) => `Point ${shape[v - 1]?.node}` }, y: { label: 'shape', domain: [-1.15, 1.15] }, marks: [{ type: 'rule', y: 0, solid: true },
          ...(turn ? [] : [{ type: 'interval', color: 'muted', points: shape.map((p, i) => [i + 1, p.value - 2 * p.std, p.value + 2 * p.std]) }]), { type: 'line', color: 'blue', points: at }, { type: 'dots', name: turn ? 'complex shape in motion' : 'real shape', color: 'blue', points: turn ? at : shape.map((p, i) => [i + 1, p.value]) },
          ...(turn ? [] : [{ type: 'dots', name: 'imaginary part', color: 'vermilion', ring: true, r: 2.6, points: shape.map((p, i) => [i + 1, p.complex_im]) }])] }];
      }));
    }
    if (r.modes.length > 1 && r.mac?.length) {
      const values = r.mac;
      const at = (i, j) => (Array.isArray(values[i]) ? values[i][j] : values[i * r.modes.length + j]);
      let most = [0, 0, 1];
      r.modes.forEach((_, i) => r.modes.forEach((__, j) => { if (i < j && at(i, j) > most[0]) most = [at(i, j), i, j]; }));
      list.push(matrix({ id: 'mac', corner: 'mode', across: 'mode', title: `Most alike are the shapes of modes ${r.modes[most[1]].mode} and ${r.modes[most[2]].mode}: MAC ${fixed(most[0], 2)}`, caption: 'Modal assurance criterion of the shapes with each other. Large beside the diagonal: measured at too few points.' }, r.modes.map((m) => String(m.mode)), r.modes.map((m) => String(m.mode)), at));
    }
    return list;
  }
  function emaFunctions(r) {
    const choices = r.curves.map((curve) => ({ ...curve, ...r.channels[curve.channel - 1], frequency_hz: curve.frequency_hz })).map((c) => ({ ...c, label: `${c.response_node} over ${c.reference_node}` }));
    if (!choices.length) return null;
    return functionFigure('functions', (c) => `Node ${c.response_node} over node ${c.reference_node}: the modes give back the measured function with FRAC ${fixed(c.frac, 3)}`, 'Worst FRAC first. Dashed: modes. Drag along the axis to zoom.', choices, { acceleration: 'm/s\u00b2/N', velocity: 'm/s/N', displacement: 'm/N' }[r.source.quantity] || plain(r.source.quantity), r.modes.map((m) => m.frequency_hz));
  }

  /* ---- what to measure next, studies */

  function testsFigure(r) {
    if (!r.tests?.length) return null;
    const best = r.tests[0];
    return rows({ id: 'tests', title: `${best.chance < 0.5 ? 'No test that was tried is likely to decide; the best is' : 'Best chance'}: ${best.text}, ${fixed(100 * best.chance, 0)} %`, caption: 'Chance that the true one of the rivals is named after the test, and that another is.', legend: [['true one named', 'green', 'face'], ['another named', 'vermilion', 'face']] }, r.tests.slice(0, 12).map((t) => ({ ...t, name: t.text.length > 90 ? `${t.text.slice(0, 88)}\u2026` : t.text })), [
      { label: 'chance', domain: [0, 1], head: ['chance', 'wrong name'], value: (t) => [t.chance, t.wrong], draw: (t, x, y, content) => { bar(content, x(0), x(t.chance), y, 'green'); bar(content, x(t.chance), x(t.chance + t.wrong), y, 'vermilion'); } },
      { label: 'cost [points]', domain: [0, Math.max(...r.tests.map((t) => t.cost)) * 1.05], value: (t) => t.cost, draw: (t, x, y, content) => dot(content, x(t.cost), y, 'blue') }]);
  }
  function sensorFigures(r) {
    const list = [];
    const plans = r.plans.filter((plan) => plan.z_m.length);
    const test = (r.tests || []).find((t) => t.sensors_m.length);
    if (r.geometry) {
      const best = plans.find((plan) => plan.method === 'optimal') || plans[0];
      list.push(rotor(r.geometry, r.parameters, [...(best ? [{ name: `${plain(best.method)} plan of ${best.z_m.length} sensors`, color: 'blue', points: best.z_m.map((z) => [z, 1]) }] : []), ...(test ? [{ name: `test: ${plain(test.id)}`, color: 'green', points: test.sensors_m.map((z) => [z, 0.6]) }] : [])], { id: 'plan', title: best ? `${best.z_m.length} sensors at the ${plain(best.method)} places lower the deviations by ${short(best.gain_percent)} %` : 'The rotor' }));
    }
    const places = r.places.filter((p) => known(p.worth_percent) || known(p.margin_percent));
    if (places.length) {
      const key = places.some((p) => known(p.worth_percent)) ? 'worth_percent' : 'margin_percent';
      const top = places.filter((p) => known(p[key])).sort((a, b) => b[key] - a[key])[0];
      list.push(panels({ id: 'sensor-worth', title: `One more sensor is worth most at z = ${num(top.z_m, 3)} ${M}: ${short(top[key])} %`, caption: 'By how much it lowers the standard deviations of moduli and causes, and raises what tells rivals apart.' }, [{ height: 150, x: { label: `z [${M}]`, domain: [0, r.geometry?.length_m ?? Math.max(...places.map((p) => p.z_m))] }, y: { label: 'worth [%]', domain: padded(places.flatMap((p) => [p.worth_percent, p.margin_percent]), 0.05, true) }, marks: [{ type: 'line', name: 'standard deviations', color: 'blue', points: r.places.filter((p) => known(p.worth_percent)).map((p) => [p.z_m, p.worth_percent]) }, ...(places.some((p) => known(p.margin_percent)) ? [{ type: 'line', name: 'rivals apart', color: 'vermilion', dash: true, points: r.places.filter((p) => known(p.margin_percent)).map((p) => [p.z_m, p.margin_percent]) }] : [])] }]));
    }
    if (r.counts?.length > 1)
      list.push(panels({ id: 'counts', title: `${r.counts[r.counts.length - 1].sensors} sensors leave \u00b1${short(r.counts[r.counts.length - 1].half_width_percent)} % of the least known parameter, one leaves \u00b1${short(r.counts[0].half_width_percent)} %`, caption: 'The best places taken one after the other.' }, [{ height: 120, x: { label: 'sensors', domain: [0, r.counts[r.counts.length - 1].sensors] }, y: { label: 'half-width [%]', domain: padded(r.counts.map((c) => c.half_width_percent), 0.05, true) }, marks: [{ type: 'line', color: 'blue', points: r.counts.map((c) => [c.sensors, c.half_width_percent]) }, { type: 'dots', name: 'half-width of the widest 95 % interval', color: 'blue', points: r.counts.map((c) => [c.sensors, c.half_width_percent]) }, ...(known(r.wanted_percent) ? [{ type: 'rule', y: r.wanted_percent, color: 'vermilion' }] : [])] }]));
    return list;
  }
  const AXES = ['deck', 'variant', 'modes', 'sensors', 'hide', 'noise_frequency', 'noise_shape'];
  function study(entry) {
    const s = entry.result;
    const { cells } = s;
    const list = [];
    const varies = AXES.filter((axis) => cells.some((c) => c.cell[axis] !== cells[0].cell[axis]));
    const part = (cell, axis) => (axis.startsWith('noise') ? `noise ${cell[axis]}` : axis === 'deck' ? String(cell.deck).split('/').pop() : axis === 'modes' || axis === 'sensors' ? `${axis} ${cell[axis] ?? 'all'}` : cell[axis] ?? 'none');
    const nameOf = (cell, but) => varies.filter((axis) => axis !== but).map((axis) => part(cell, axis)).join(', ');
    const keyOf = (cell) => JSON.stringify(AXES.map((axis) => cell[axis] ?? null));
    const runs = (entry.runs || []).map((run) => ({ ...run, at: cells.findIndex((c) => keyOf(c.cell) === keyOf(run.cell)) }));
    const thin = entry.thinned > 1 ? ` One run in ${entry.thinned} is shown.` : '';
    const first = cells.find((c) => c.parameters.length)?.parameters || [];
    /* starts and ends in the plane of two parameters */
    const started = runs.filter((run) => run.history?.length && run.parameters?.length);
    if (started.length && started[0].parameters.length) {
      const some = started.filter((run) => run.at === started[0].at).slice(0, 60);
      const [p, q] = [some[0].parameters[0], some[0].parameters[1]];
      const n = some[0].parameters.length;
      const u = unitOf(p.value, p.unit);
      const v = q ? unitOf(q.value, q.unit) : null;
      const track = (run) => {
        const flat = run.history.flatMap((h) => h.x);
        return Array.from({ length: Math.floor(flat.length / n) }, (_, i) => [flat[i * n] * u.factor, q ? flat[i * n + 1] * v.factor : i]);
      };
      const reached = cells[some[0].at];
      const all = some.flatMap(track);
      list.push(panels({ id: 'starts', title: known(reached?.reached_best) ? `${reached.reached_best} of ${reached.runs} starts end at the same minimum${nameOf(reached.cell) ? ` (${nameOf(reached.cell)})` : ''}` : `${some.length} iterations from their starts`, caption: `Iterates of ${some.length} runs of one cell; rings: starts, dots: ends.${thin}` }, [{ height: 260, x: { label: label(p.name, u.text), domain: padded(all.map((a) => a[0])) }, y: { label: q ? label(q.name, v.text) : 'iteration', domain: padded(all.map((a) => a[1])) }, marks: [...some.map((run) => ({ type: 'line', color: 'steel', width: 1, points: track(run) })), { type: 'dots', name: 'start', ring: true, color: 'vermilion', points: some.map((run) => track(run)[0]) }, { type: 'dots', name: 'end', color: 'blue', points: some.map((run) => track(run).pop()) }] }]));
    }
    /* over the number of modes */
    const count = (cell) => (cell.modes ? cell.modes.split(',').reduce((sum, one) => { const [a, b] = one.split('-').map(Number); return sum + (b ? b - a + 1 : 1); }, 0) : NaN);
    if (varies.includes('modes')) {
      const names = [...new Set(cells.map((c) => nameOf(c.cell, 'modes')))];
      const of = (name) => cells.filter((c) => nameOf(c.cell, 'modes') === name && known(count(c.cell)));
      const counts = cells.map((c) => count(c.cell)).filter(known);
      const x = { label: 'modes in the fit', domain: padded(counts), ticks: [...new Set(counts)].sort((a, b) => a - b) };
      const best = (c) => Math.min(...runs.filter((run) => run.at === cells.indexOf(c) && known(run.objective)).map((run) => run.objective));
      const series = names.slice(0, 5).map((name, k) => ({ name: name || 'functional', color: COLORS[k], points: of(name).map((c) => [count(c.cell), best(c)]).filter((a) => isFinite(a[1]) && a[1] > 0) }));
      const levels = series.flatMap((one) => one.points.map((a) => a[1]));
      if (levels.length) list.push(panels({ id: 'functional-by-modes', title: `With more modes the functional grows to ${num(Math.max(...levels), 2)}`, caption: `The least one of a cell.${thin}` }, [{ height: 150, x, y: { label: 'functional', log: true, domain: [Math.min(...levels) / 3, Math.max(...levels) * 3] }, marks: series.flatMap((one) => [{ type: 'line', color: one.color, points: one.points }, { type: 'dots', ...one }]) }]));
      const spread = first.map((p, j) => ({ p, values: cells.map((c) => c.parameters[j]?.mean).filter(known) })).map(({ p, values }) => [Math.max(...values) / Math.min(...values), p.name]).sort((a, b) => b[0] - a[0])[0];
      if (first.length) list.push(panels({ id: 'parameters-by-modes', title: `${spread[1]} changes by a factor of ${short(spread[0])} with the modes in the fit`, caption: 'Mean of each cell; bars: two standard deviations of its runs.' }, first.slice(0, 4).map((p, j) => {
        const u = unitOf(p.mean, p.unit);
        const values = cells.flatMap((c) => [c.parameters[j]?.mean * u.factor, (c.parameters[j]?.mean + 2 * (c.parameters[j]?.std || 0)) * u.factor]);
        return { title: p.name, height: 120, x: { ...x, label: j === Math.min(first.length, 4) - 1 ? x.label : '' }, y: { label: u.text ? `[${u.text}]` : '', domain: padded(values) }, marks: names.slice(0, 5).flatMap((name, k) => {
          const own = of(name).filter((c) => c.parameters[j]);
          return [{ type: 'interval', color: COLORS[k], points: own.map((c) => [count(c.cell), (c.parameters[j].mean - 2 * (c.parameters[j].std || 0)) * u.factor, (c.parameters[j].mean + 2 * (c.parameters[j].std || 0)) * u.factor]) }, { type: 'line', color: COLORS[k], points: own.map((c) => [count(c.cell), c.parameters[j].mean * u.factor]) }, { type: 'dots', name: name || p.name, color: COLORS[k], points: own.map((c) => [count(c.cell), c.parameters[j].mean * u.factor]) }];
        }) };
      })));
    }
    /* errors of the runs beside the truth */
    const judged = runs.filter((run) => run.parameters?.some((p) => known(run.truth?.[p.name])));
    if (judged.length) {
      const names = [...new Set(judged.flatMap((run) => run.parameters.map((p) => p.name)))].slice(0, 4);
      const error = (run, name) => { const p = run.parameters.find((one) => one.name === name); const truth = run.truth?.[name]; return p && known(truth) ? 100 * (p.value / truth - 1) : NaN; };
      const worst = names.map((name) => [rms(judged.map((run) => error(run, name)).filter(known)), name]).sort((a, b) => b[0] - a[0])[0];
      list.push(panels({ id: 'errors', title: `Largest scatter: ${worst[1]} is off by ${short(worst[0])} % rms over ${judged.length} runs`, caption: `Value over truth, less one, by run.${thin}` }, names.map((name) => ({ title: name, height: 110, x: { label: 'run', domain: padded(judged.map((run) => run.run)) }, y: { label: 'error [%]', domain: padded(judged.map((run) => error(run, name)), 0.06, true) }, marks: [{ type: 'rule', y: 0, solid: true }, { type: 'dots', name, color: 'blue', r: 2, opacity: 0.7, points: judged.map((run) => [run.run, error(run, name)]) }] }))));
    }
    /* coverage */
    const covered = cells.flatMap((c) => c.parameters.filter((p) => known(p.coverage95)).map((p) => ({ name: `${nameOf(c.cell) ? `${nameOf(c.cell)}: ` : ''}${p.name}`, share: 100 * p.coverage95, n: p.intervals })));
    if (covered.length) {
      const mean = covered.reduce((sum, c) => sum + c.share * c.n, 0) / covered.reduce((sum, c) => sum + c.n, 0);
      const band = (c) => 196 * Math.sqrt(0.95 * 0.05 / c.n);
      list.push(rows({ id: 'coverage', title: `${fixed(mean, 1)} % of the 95 % intervals hold the truth`, caption: 'Bar: where 95 % intervals of that number lie 19 times in 20.' }, covered.slice(0, 40), [{ label: 'intervals that hold the truth [%]', domain: [Math.min(80, ...covered.map((c) => c.share)) - 2, 101], head: ['share [%]', 'intervals'], value: (c) => [c.share, c.n], draw: (c, x, y, content) => { content.append(line(x(Math.max(x.domain()[0], 95 - band(c))), y, x(Math.min(100, 95 + band(c))), y, 'steel', { 'stroke-width': 8 })); dot(content, x(c.share), y, 'blue'); } }]));
    }
    /* verdicts */
    const diagnosed = cells.filter((c) => c.diagnoses);
    if (diagnosed.length) {
      const kinds = Object.keys(diagnosed[0].diagnoses.verdicts || {});
      const tints = ['green', 'blue', 'ochre', 'vermilion', 'steel'];
      const total = kinds.map((kind) => [diagnosed.reduce((sum, c) => sum + c.diagnoses.verdicts[kind], 0), kind]).sort((a, b) => b[0] - a[0]);
      const all = diagnosed.reduce((sum, c) => sum + c.diagnoses.count, 0);
      list.push(rows({ id: 'verdicts', title: `${total[0][0]} of ${all} diagnoses are ${plain(total[0][1])}`, caption: 'Share of the diagnoses of a cell.', legend: kinds.map((kind, k) => [plain(kind), tints[k % 5], 'face']) }, diagnosed.map((c) => ({ ...c, name: nameOf(c.cell) || part(c.cell, 'deck') })), [{ label: 'share', domain: [0, 1], head: kinds.map(plain), value: (c) => kinds.map((kind) => c.diagnoses.verdicts[kind]), draw: (c, x, y, content) => { let from = 0; kinds.forEach((kind, k) => { const to = from + c.diagnoses.verdicts[kind] / Math.max(1, c.diagnoses.count); if (to > from) bar(content, x(from), x(to), y, tints[k % 5]); from = to; }); } }]));
      const scores = Object.keys(diagnosed[0].diagnoses.scores || {});
      const scored = diagnosed.filter((c) => scores.some((key) => known(c.diagnoses.scores?.[key])));
      if (scored.length) {
        const sums = scores.map((key) => [scored.reduce((sum, c) => sum + (c.diagnoses.scores[key] || 0), 0), key]).filter(([v]) => v > 0).sort((a, b) => b[0] - a[0]);
        if (sums.length) list.push(rows({ id: 'scores', title: `Beside what was hidden: ${sums.slice(0, 2).map(([v, key]) => `${v} ${plain(key)}`).join(', ')}`, caption: 'Diagnoses by score, docs/study.md.' }, sums.map(([v, key]) => ({ name: plain(key), v })), [{ label: 'diagnoses', domain: [0, Math.max(...sums.map(([v]) => v))], value: (row) => row.v, draw: (row, x, y, content) => bar(content, x(0), x(row.v), y, 'blue') }]));
      }
    }
    /* decks */
    const errors = cells.filter((c) => c.frequency_rms_percent > 1e-9).map((c) => ({ name: nameOf(c.cell) || part(c.cell, 'deck'), fitted: c.frequency_rms_percent, held: c.holdout_frequency_rms_percent }));
    if (errors.length) {
      const least = errors.slice().sort((a, b) => a.fitted - b.fitted)[0];
      const ends = errors.flatMap((e) => [e.fitted, e.held]).filter((v) => v > 0);
      list.push(rows({ id: 'decks', title: `Errors of the frequencies: least in ${least.name}, ${short(least.fitted)} % rms`, caption: 'rms over the runs of a cell. Logarithmic.', legend: [['fitted', 'blue', 'dot'], ['held out', 'vermilion', 'ring']] }, errors.slice(0, 40), [{ label: 'error of the frequencies [%]', log: true, domain: [Math.min(...ends) / 1.5, Math.max(...ends) * 1.5], head: ['fitted [%]', 'held out [%]'], value: (e) => [e.fitted, e.held], draw: (e, x, y, content) => { dot(content, x(e.fitted), y, 'blue'); if (e.held > 0) dot(content, x(e.held), y, 'vermilion', true); } }]));
    }
    return list;
  }

  /* ---- which figures stand where: (entry of the data, the result or its state) */

  const fitsOf = (entry, r) => (r.extended && r.base ? [{ name: 'without', fit: r.base, color: 'vermilion', dash: true }, { name: `with ${wordsOf(entry)}`, fit: r.extended, color: 'blue' }] : [{ name: r.base ? 'the model' : 'the identified model', fit: r.base || r, color: 'blue' }]);
  /* One of several figures at a time, chosen by name. */
  function chosen(names, figures) {
    const there = figures.map((made, k) => [names[k], made]).filter(([, made]) => made);
    if (there.length < 2) return there.map(([, made]) => made);
    const show = (k) => {
      there.forEach(([, made], j) => { made.element.hidden = j !== k; });
      choose.forEach((one, j) => one.setAttribute('aria-pressed', j === k));
      there[k][1].redraw();
    };
    const choose = there.map(([name], k) => button(name, () => show(k), { 'aria-pressed': !k }));
    const element = el('div', {}, el('div', { class: 'controls' }, ...choose), ...there.map(([, made]) => made.element));
    return [{ element, redraw: () => show(0) }];
  }
  const statesOf = (entry, r) => chosen((r.base || r).states.map((state) => `state ${state.name}`), (r.base || r).states.map((state, s) => motionOfFits(`state ${state.name}`, state.geometry || r.geometry, fitsOf(entry, r).map((one) => ({ ...one, fit: { ...one.fit.states[s], parameters: one.fit.parameters } })))));
  const GROUPS = {
    rotor: (entry, r) => [r.geometry && rotor(r.geometry, (r.parameters || []).map((p) => (typeof p === 'string' ? { name: p } : p)))],
    shapes: (entry, r) => {
      if ((r.base || r).states?.length) return statesOf(entry, r);
      const geometry = r.geometry || entry.result.geometry;
      const made = motionOfFits(r.extended ? 'the extended model' : r.base ? 'the model' : 'the identified model', geometry, fitsOf(entry, r));
      return [made || (geometry && rotor(geometry, (r.base || r).parameters))];
    },
    agreement: (entry, r) => ((r.base || r).states?.length ? [stateFrequencies(r.extended || r.base || r)] : [frequencies({ ...entry, result: r })]),
    matrices: (entry, r) => correlations({ ...entry, result: r }),
    states: (entry, r) => [stateFrequencies(r)],
    parameters: (entry, r) => [parameterIntervals(r), correlation(r)],
    fit: (entry, r) => fitFigures(r),
    modes: (entry, r) => modesFigures(r),
    sensitivity: (entry, r) => sensitivityFigures(r),
    speeds: (entry, r) => speedsFigures(r),
    transfer: (entry, r) => [transferFigure(r)],
    'ema-shapes': (entry, r) => emaShapes(r),
    'ema-poles': (entry, r) => [stabilisation(r)],
    'ema-functions': (entry, r) => [emaFunctions(r)],
    gain: (entry) => gainFigures(entry),
    causes: (entry) => causesFigures(entry),
    correlation: (entry, r) => [correlation(r.extended || r.base)],
    places: (entry) => placesFigure(entry),
    limits: (entry) => [limitsFigure(entry)],
    tests: (entry, r) => [testsFigure(r)],
    sensors: (entry, r) => sensorFigures(r),
    study: (entry) => study(entry),
  };

  /* ---- the page */

  const waiting = [...document.querySelectorAll('.figures')];
  for (const place of waiting) {
    const entry = results[Number(place.dataset.result)];
    const own = place.dataset.state === undefined ? entry.result : { ...(entry.result.states[Number(place.dataset.state)]) };
    if (place.dataset.state !== undefined && !own.parameters) own.parameters = entry.result.parameters;
    for (const made of GROUPS[place.dataset.group](entry, own) || []) {
      if (!made) continue;
      place.append(made.element);
      made.redraw();
    }
  }
  for (const table of document.querySelectorAll('main .scroll > table')) {
    if (table.closest('figure')) continue;
    const cells = () => {
      const grid = [...table.rows].map((row) => [...row.cells].map((cell) => cell.textContent.replace(/\u2212/g, '-')));
      return { head: grid[0], rows: grid.slice(1).map((row) => row.map((cell) => (cell !== '' && isFinite(cell) ? Number(cell) : cell))) };
    };
    table.parentElement.after(el('div', { class: 'tools' }, ...tools(table.caption?.id || 'table', cells)));
  }
  const footer = document.querySelector('footer');
  results.forEach((entry, i) => footer.prepend(el('div', { class: 'tools' }, button(`JSON of ${entry.file.split('/').pop()}`, () => save(`result-${i + 1}.json`, 'application/json', JSON.stringify(entry.runs ? entry : entry.result, null, 1))))));
  footer.append(el('p', {}, 'The data of the figures stand in this page as the result has them, lists of more than 24 numbers with six digits.'));
  const folds = [...document.querySelectorAll('details.fold')];
  folds.forEach((fold) => { fold.open = false; });
  addEventListener('beforeprint', () => folds.forEach((fold) => { fold.open = !fold.closest('footer'); }));
  addEventListener('afterprint', () => folds.forEach((fold) => { fold.open = false; }));
  let width = innerWidth;
  addEventListener('resize', () => {
    if (innerWidth !== width) requestAnimationFrame(() => drawn.forEach((redraw) => redraw()));
    width = innerWidth;
  });
})();
