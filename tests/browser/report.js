// Put at the end of a copy of report.html by tests/browser/report. Works the page as a user would and leaves a line
// per check in the document.
'use strict';
(async () => {
  const lines = [];
  const check = (name, holds) => lines.push(`${holds ? 'ok' : 'FAILED'}: ${name}`);
  const key = (name, options = {}) =>
    document.body.dispatchEvent(new KeyboardEvent('keydown', {key: name, bubbles: true, cancelable: true, ...options}));
  const number = () => Number(document.getElementById('number').value);
  const sources = () => [...document.querySelectorAll('figure img')].map((image) => image.src);
  const cursors = () => [...document.querySelectorAll('.cursor')].map((cursor) => parseFloat(cursor.style.left));
  const rest = (ms) => new Promise((done) => setTimeout(done, ms));
  try {
    const frames = data.frames.length;
    const end = data.frames[frames - 1].number;
    check('the address names the frame shown', number() === 3 && location.hash === '#frame=3');
    check('two views', sources().length === 2);
    check('views are inside the page', sources().every((source) => source.startsWith('data:image/webp;base64,')));
    await Promise.all([...document.querySelectorAll('figure img')].map((image) => image.decode()));
    check('views are pictures', [...document.querySelectorAll('figure img')].every((image) => image.naturalWidth > 100));
    check('at least seven plots', cursors().length >= 7);

    const before = {sources: sources(), cursors: cursors()};
    key('ArrowRight');
    check('an arrow key moves one frame', number() === 4);
    check('both views follow', sources().every((source, k) => source !== before.sources[k]));
    check('every cursor follows', cursors().every((left, k) => left > before.cursors[k]));
    check('the address follows', location.hash === '#frame=4');
    key('ArrowLeft', {shiftKey: true});
    check('Shift and an arrow key go ten frames, not beyond the first', number() === 0);
    key('ArrowRight', {shiftKey: true});
    check('Shift and an arrow key go ten frames', number() === Math.min(10, end));
    key('End');
    check('End', number() === end);
    key('Home');
    check('Home', number() === 0);
    check('frame 0 has no step yet', document.getElementById('components-note').textContent.includes('first step'));

    const slider = document.getElementById('slider');
    slider.value = 5;
    slider.dispatchEvent(new Event('input', {bubbles: true}));
    check('the slider moves the frame', number() === 5);
    const rows = document.querySelectorAll('#components tbody tr');
    check('the table lists components', rows.length > 0 && rows[0].cells.length === 9);
    check('a component says which solver took it, and why', /^\S.*: \S/.test(rows[0].cells[8].textContent));
    const cells = [...rows].map((row) => Number(row.cells[row.cells.length === 9 ? 2 : 1].textContent.replaceAll(',', '')));
    check('components and held particles are all particles',
          cells.reduce((sum, n) => sum + n, 0) + (data.series.constrained ? data.series.constrained[5] : 0) ===
          Number(/(\d+) particles/.exec(data.summary)[1]));

    const canvas = document.querySelector('.plot .canvas');
    const box = canvas.getBoundingClientRect();
    const pointer = {clientX: box.right - 3, clientY: box.top + 30, buttons: 1, pointerId: 1, bubbles: true};
    canvas.setPointerCapture = () => {};  // made-up pointers can't be captured
    canvas.dispatchEvent(new PointerEvent('pointerdown', pointer));
    check('a click at a plot’s end goes to the last frame', number() === end);

    const wide = document.createElement('section');
    document.getElementById('plots').before(wide);
    wide.style.width = '500px';
    makePlots(wide, [0, 1, 2], {rvm: [null, 5200000, 987654321], lowest: [-1, -0.5, 2000000]}, () => {});
    const labels = [...wide.querySelectorAll('.dygraph-axis-label-y')];
    check('labels of an axis beyond a million are whole',
          labels.some((label) => /,000,000$/.test(label.textContent)) &&
          labels.every((label) => {
            const text = document.createRange();
            text.selectNodeContents(label);
            const inner = text.getBoundingClientRect(), outer = label.parentElement.getBoundingClientRect();
            return inner.left >= wide.getBoundingClientRect().left && inner.width <= outer.width;
          }));
    wide.remove();
    dispatchEvent(new Event('beforeprint'));
    check('what is folded is open on paper', [...document.querySelectorAll('details')].every((part) => part.open));

    const jump = document.querySelector('#jumps button');
    jump.click();
    check('a jump goes to its frame', number() === Number(jump.dataset.frame));
    location.hash = '#frame=2';
    await rest(100);
    check('a changed address moves the frame', number() === 2);
    location.hash = '#frame=99999';
    await rest(100);
    check('an address beyond the end shows the last frame', number() === end);
    key('Home');
    key(' ');
    await rest(250);
    check('Space plays', number() > 0);
    key(' ');
    const stopped = number();
    await rest(300);
    check('Space stops', number() === stopped);

    check('effects are listed', document.querySelectorAll('#effects tbody tr').length >= 5);
    check('the scene is there', document.getElementById('scene').textContent.includes('[cloth'));
    const controls = [...document.querySelectorAll('button, input')].filter((control) => control.offsetParent);
    check('every control has a name', controls.every(
        (control) => control.getAttribute('aria-label') || control.textContent.trim() || control.labels.length > 0));
    check('nothing was fetched', performance.getEntriesByType('resource').every((e) => e.name.startsWith('data:')));
  } catch (error) {
    lines.push(`FAILED: ${error.stack}`);
  }
  const result = document.createElement('pre');
  result.id = 'result';
  result.textContent = '\n' + lines.join('\n') + '\nend of checks\n';
  document.body.append(result);
})();
