'use strict';
// The plots over the frames: one dygraph each, all with the same cursor at the frame shown.

// Colours that are told apart on light and dark pages and by the colour-blind (Okabe & Ito).
const plotColors = ['#2f86c6', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#8c6cff', '#8f99a6', '#aa8b00'];

const printedWidth = 640;  // px, as in report.css

// What is plotted: titles, and columns of data.series by name.
function plotList(series) {
  const stages = Object.keys(series).filter((name) => name.startsWith('ms_'));
  const list = [
    {title: 'Components', columns: {components: 'components'}},
    {title: 'Largest component [particles]', columns: {largest: 'largest', constrained: 'fully constrained'}},
    {title: 'Springs handled implicitly [%]', columns: {implicit_share: 'of all stretch and shear springs'}},
    {title: 'CG iterations', columns: {cg_iterations: 'sum over components', cg_iterations_max: 'most of one'}},
    {title: 'Row–vector multiplies', columns: {rvm: 'decomposed', rvm_whole: 'whole'}},
    {title: 'Time per frame [ms]', stacked: true,
     columns: Object.fromEntries(stages.map((name) => [name, name.slice(3)]))},
    {title: 'Strain of stretch springs [%]', columns: {max_strain: 'greatest', p99_strain: '99th percentile'}},
    {title: 'Lowest point [m]', columns: {lowest: 'of all particles'}},
    {title: 'Energy [J]', columns: {kinetic: 'kinetic', potential: 'potential'}},
  ];
  for (const plot of list) {
    plot.names = Object.keys(plot.columns).filter((name) => (series[name] || []).some((value) => value !== null));
  }
  return list.filter((plot) => plot.names.length > 0);
}

function shortNumber(value) {
  if (value === null || value === undefined) return '–';
  if (Number.isInteger(value)) return value.toLocaleString('en');
  return Math.abs(value) >= 1e-3 || value === 0 ? String(Number(value.toPrecision(4))) : value.toExponential(2);
}

// For axes: whole up to a thousand million.
function axisNumber(value) {
  return Math.abs(value) >= 1e10 ? value.toExponential(1) : shortNumber(value);
}

// Room for the labels of an axis that reaches from 0 to the greatest of these values and a tick beyond [px].
function labelWidth(columns, stacked) {
  const sums = columns[0].map((_, k) => columns.reduce((sum, column) => sum + Math.abs(column[k] || 0), 0));
  const most = Math.max(...(stacked ? sums : columns.flat().map((value) => Math.abs(value || 0))));
  const least = Math.min(0, ...columns.flat().map((value) => value || 0));
  const pen = document.createElement('canvas').getContext('2d');
  pen.font = '12px sans-serif';
  const longest = Math.max(...[most, 1.2 * most, most / 5, least].map(
    (value) => pen.measureText(axisNumber(Number(value.toPrecision(2)))).width));
  return Math.max(52, Math.ceil(longest) + 12);
}

// Makes all plots in `parent`. `numbers` are the frames' numbers; `seek(index)` is called as a plot is clicked or
// dragged over. Returns show(index), which moves the cursors.
function makePlots(parent, numbers, series, seek) {
  const style = getComputedStyle(document.documentElement);
  const read = () => ({axisLineColor: style.getPropertyValue('--line'), gridLineColor: style.getPropertyValue('--line')});
  // All boxes first: how wide a plot is depends on how many share the row.
  const boxes = plotList(series).map((spec) => {
    const box = document.createElement('div');
    box.className = 'plot';
    const heading = document.createElement('h3');
    heading.textContent = spec.title;
    const legend = document.createElement('div');
    legend.className = 'legend';
    const canvas = document.createElement('div');
    canvas.className = 'canvas';
    canvas.setAttribute('role', 'img');
    box.append(heading, legend, canvas);
    parent.append(box);
    return {spec, legend, canvas};
  });
  const plots = boxes.map(({spec, legend, canvas}) => {
    const rows = numbers.map((number, k) => [number, ...spec.names.map((name) => series[name][k])]);
    const graph = new Dygraph(canvas, rows, {
      labels: ['frame', ...spec.names.map((name) => spec.columns[name])],
      colors: plotColors,
      legend: 'never',
      interactionModel: {},
      includeZero: true,
      stackedGraph: Boolean(spec.stacked),
      fillGraph: Boolean(spec.stacked),
      strokeWidth: 1.6,
      xRangePad: 4,
      highlightCircleSize: 0,
      axes: {
        x: {drawGrid: false},
        y: {
          axisLabelWidth: labelWidth(spec.names.map((name) => series[name]), spec.stacked),
          axisLabelFormatter: axisNumber,
        },
      },
      ...read(),
    });
    const cursor = document.createElement('div');
    cursor.className = 'cursor';
    canvas.append(cursor);

    const at = (event) => {
      const number = graph.toDataXCoord(event.clientX - canvas.getBoundingClientRect().left);
      let nearest = 0;
      numbers.forEach((n, k) => {
        if (Math.abs(n - number) < Math.abs(numbers[nearest] - number)) nearest = k;
      });
      seek(nearest);
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      at(event);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons & 1) at(event);
    });
    return {spec, graph, cursor, legend, canvas};
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    for (const plot of plots) plot.graph.updateOptions(read());
  });

  let shown = 0;
  const show = (index) => {
    shown = index;
    for (const {spec, graph, cursor, legend, canvas} of plots) {
      cursor.style.left = graph.toDomXCoord(numbers[index]) + 'px';
      const parts = spec.names.map((name, k) => {
        const part = document.createElement('span');
        const mark = document.createElement('i');
        mark.style.background = plotColors[k % plotColors.length];
        part.append(mark, `${spec.columns[name]} ${shortNumber(series[name][index])}`);
        return part;
      });
      legend.replaceChildren(...parts);
      canvas.setAttribute('aria-label', `${spec.title} over the frames; at frame ${numbers[index]}: ${legend.textContent}`);
    }
  };
  // dygraphs follow the window's width; the cursors have to follow them.
  addEventListener('resize', () => setTimeout(() => show(shown), 100));
  // On paper all are as wide as report.css says, and drawn for that.
  const redraw = (width) => {
    for (const {graph, canvas} of plots) graph.resize(width ?? canvas.clientWidth, canvas.clientHeight);
    show(shown);
  };
  addEventListener('beforeprint', () => redraw(printedWidth));
  addEventListener('afterprint', () => redraw());
  return show;
}
