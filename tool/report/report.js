'use strict';
// The page's state is one number, the index of the frame shown; show() makes everything else follow it.

const data = JSON.parse(document.getElementById('data').textContent);
data.frames = JSON.parse(document.getElementById('frames').textContent);
const pictures = JSON.parse(document.getElementById('pictures').textContent);
const element = (id) => document.getElementById(id);
const numbers = data.frames.map((frame) => frame.number);
const last = numbers.length - 1;
let current = -1;
let playing = null;

function make(tag, text, attributes = {}) {
  const node = document.createElement(tag);
  if (text !== undefined) node.textContent = text;
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  return node;
}

// --- views

const views = data.views.map((view) => {
  const figure = make('figure');
  const link = make('a');
  const image = make('img', undefined, {width: data.size[0], height: data.size[1]});
  const absent = make('div', 'no picture of this frame', {class: 'absent'});
  absent.style.aspectRatio = `${data.size[0]} / ${data.size[1]}`;
  link.append(image);
  const caption = make('figcaption');
  figure.append(link, absent, caption);
  element('views').append(figure);
  return {...view, image, link, absent, caption};
});

function showViews(frame) {
  for (const view of views) {
    const inline = pictures[view.name] && pictures[view.name][frame.number];
    const file = view.files ? `${view.files}${String(frame.number).padStart(4, '0')}.png` : null;
    const there = Boolean(inline || (file && view.numbers.includes(frame.number)));
    view.image.hidden = !there;
    view.absent.hidden = there;
    if (there) view.image.src = inline ? `data:image/webp;base64,${inline}` : file;
    view.caption.textContent = `${view.name} view of frame ${frame.number}, ${frame.time.toFixed(3)} s`;
    view.image.alt = `${view.name} view of frame ${frame.number}`;
    if (there && file) view.link.href = file;
    else view.link.removeAttribute('href');
    view.link.title = file ? 'open the picture in full size' : '';
  }
}

// --- numbers of the frame

const facts = [
  ['components', 'components'], ['largest', 'largest'], ['constrained', 'fully constrained'],
  ['partly', 'partly constrained'], ['implicit', 'implicit springs'], ['explicit', 'explicit springs'],
  ['inactive', 'inactive springs'], ['contacts', 'contacts'], ['cg_iterations', 'CG iterations'],
  ['rvm', 'RVMs'], ['rvm_whole', 'RVMs whole'], ['max_strain', 'greatest strain [%]'], ['lowest', 'lowest point [m]'],
].filter(([name]) => data.series[name] && data.series[name].some((value) => value !== null));

for (const [name, label] of facts) {
  const box = make('div');
  box.append(make('dt', label), make('dd', '', {'data-fact': name}));
  element('facts').append(box);
}

function showFacts(index) {
  for (const node of element('facts').querySelectorAll('dd')) {
    node.textContent = shortNumber(data.series[node.dataset.fact][index]);
  }
}

// --- components

function componentRow([id, color, particles, boundary, springs, iterations, rvm, residual, solver, reason]) {
  const row = make('tr');
  const swatch = make('td');
  swatch.append(make('span', '', {class: 'swatch', style: `background:${color}`, role: 'img', 'aria-label': color}));
  row.append(swatch, make('td', String(id)));
  for (const value of [particles, boundary, springs, iterations, rvm, residual])
    row.append(make('td', shortNumber(value)));
  row.append(make('td', `${data.solvers[solver]}: ${data.reasons[reason]}`, {class: 'words'}));
  return row;
}

function showComponents(frame) {
  const rows = frame.components.map(componentRow);
  if (frame.rest) {
    const row = make('tr', undefined, {class: 'rest'});
    row.append(make('td', `${frame.rest.count} smaller`, {colspan: 2}), make('td', shortNumber(frame.rest.particles)),
               make('td', ''), make('td', shortNumber(frame.rest.springs)), make('td', shortNumber(frame.rest.iterations)),
               make('td', shortNumber(frame.rest.rvm)), make('td', '', {colspan: 2}));
    rows.push(row);
  }
  element('components').tBodies[0].replaceChildren(...rows);
  element('components-note').textContent = frame.steps
    ? `Of step ${frame.steps[1]}, the last one before the frame; iterations and RVMs above are sums over its steps ` +
      `${frame.steps[0]}–${frame.steps[1]}. Fully constrained particles (white) belong to no component.`
    : 'Before the first step nothing is decomposed yet.';
}

// --- frame shown

function show(index) {
  index = Math.max(0, Math.min(last, index));
  if (index === current) return;
  current = index;
  const frame = data.frames[index];
  showViews(frame);
  showFacts(index);
  showComponents(frame);
  showCursors(index);
  element('slider').value = index;
  element('slider').setAttribute('aria-valuetext', `frame ${frame.number}`);
  if (document.activeElement !== element('number')) element('number').value = frame.number;
  element('time').textContent = `${frame.time.toFixed(3)} s`;
  if (!playing) writeAddress();
}

function writeAddress() {
  history.replaceState(null, '', `#frame=${numbers[current]}`);
}

// Index of the frame with that number, or of the nearest there is.
function indexOf(number) {
  return numbers.reduce((best, n, k) => (Math.abs(n - number) < Math.abs(numbers[best] - number) ? k : best), 0);
}

function readAddress() {
  const match = /^#frame=(\d+)$/.exec(location.hash);
  return match ? indexOf(Number(match[1])) : null;
}

function stop() {
  if (!playing) return;
  clearTimeout(playing.timer);
  playing = null;
  element('play').textContent = '▶';
  element('play').setAttribute('aria-label', 'Play');
  writeAddress();
}

function play() {
  if (playing) return stop();
  playing = {begin: performance.now(), from: current === last ? 0 : current, timer: 0};
  element('play').textContent = '❚❚';
  element('play').setAttribute('aria-label', 'Stop');
  // Frames follow the clock, so that a slow machine leaves some out instead of playing in slow motion.
  const advance = () => {
    const index = playing.from + Math.floor(((performance.now() - playing.begin) / 1000) * data.fps);
    show(index);
    if (index >= last) return stop();
    playing.timer = setTimeout(advance, 1000 / data.fps);
  };
  advance();
}

function seek(index) {
  stop();
  show(index);
}

// --- controls

const actions = {
  first: () => seek(0),
  back: () => seek(current - 1),
  play,
  forward: () => seek(current + 1),
};
for (const [id, action] of Object.entries(actions)) element(id).addEventListener('click', action);
element('slider').max = last;
element('slider').addEventListener('input', (event) => seek(Number(event.target.value)));
element('number').min = numbers[0];
element('number').max = numbers[last];
element('number').addEventListener('change', (event) => seek(indexOf(Number(event.target.value))));

document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.target.id === 'number' || event.target.tagName === 'PRE') return;
  // Space on a button presses it, on a summary opens it.
  if (event.key === ' ' && ['BUTTON', 'SUMMARY', 'A'].includes(event.target.tagName)) return;
  const far = event.shiftKey ? 10 : 1;
  const keys = {
    ArrowLeft: () => seek(current - far),
    ArrowRight: () => seek(current + far),
    Home: () => seek(0),
    End: () => seek(last),
    ' ': play,
  };
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
});
addEventListener('hashchange', () => {
  const index = readAddress();
  if (index !== null) seek(index);
});

function addJump(label, name, digits) {
  const values = data.series[name];
  if (!values || values.every((value) => value === null)) return;
  const index = values.reduce((best, value, k) => (value > values[best] ? k : best), 0);
  const button = make('button', undefined, {'data-frame': numbers[index]});
  button.append(make('b', label), ` ${digits(values[index])} (frame ${numbers[index]})`);
  button.addEventListener('click', () => seek(index));
  element('jumps').append(button);
}

// --- what does not change with the frame

element('summary').textContent = data.summary;
for (const text of data.warnings) element('warnings').append(make('li', text));
for (const effect of data.effects) {
  const row = make('tr', undefined, effect.on ? {} : {class: 'off'});
  row.append(make('td', effect.name), make('td', effect.on ? 'on' : 'off'), make('td', effect.because));
  element('effects').tBodies[0].append(row);
}
if (data.warnings.length === 0) element('warnings').hidden = true;
addEventListener('beforeprint', () => {
  for (const details of document.querySelectorAll('details')) details.open = true;
});
element('scene').textContent = data.scene;
for (const [name, value] of data.made) element('made').append(make('dt', name), make('dd', value));
addJump('most components', 'components', shortNumber);
addJump('most iterations', 'cg_iterations', shortNumber);
addJump('greatest strain', 'max_strain', (value) => `${shortNumber(value)}%`);
const showCursors = makePlots(element('plots'), numbers, data.series, seek);
show(readAddress() ?? 0);
