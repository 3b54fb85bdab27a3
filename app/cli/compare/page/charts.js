// Charts: error against time, and time by pass.

const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const charts = [];
const PLOTTED = METRICS.filter(metric => metric.plot && isMeasured(metric));

function commonOptions() {
  return {
    animation: false, responsive: true, maintainAspectRatio: false, devicePixelRatio: Math.max(devicePixelRatio, 2),
    plugins: {
      legend: { display: false },
      tooltip: {
        backgroundColor: css('--ink'), titleColor: css('--paper'), bodyColor: css('--paper'), displayColors: false,
        padding: 10, cornerRadius: 4, titleFont: { weight: '600' },
      },
    },
  };
}

function axis(title, more) {
  return {
    title: { display: Boolean(title), text: title, color: css('--soft') },
    grid: { color: css('--line'), borderColor: css('--line'), tickColor: 'transparent' },
    ticks: { color: css('--soft'), maxTicksLimit: 7 }, ...more,
  };
}

function useTheme() {
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  Chart.defaults.font.size = 12.5;
  Chart.defaults.color = css('--ink');
}

// ---- error against time

function pointsOf(metric) {
  return methods.map((method, i) => ({ i, x: method.frame_ms?.median, y: errorOf(metric, method) }))
    .filter(point => isNumber(point.x) && isNumber(point.y));
}

// Pareto front: from left to right, each with less error than all before.
function frontOf(points) {
  let least = Infinity;
  return [...points].sort((a, b) => a.x - b.x || a.y - b.y).filter(({ y }) => y < least && ((least = y), true));
}

const span = values => Math.max(...values) / Math.min(...values);
const canBeLog = points => points.every(({ x, y }) => x > 0 && y > 0);

function logTicks(value) {
  const lead = Number(String(value.toExponential()).charAt(0));
  return [1, 2, 5].includes(lead) && Math.abs(value / 10 ** Math.floor(Math.log10(value)) - lead) < 1e-6
    ? String(+value.toPrecision(2)) : '';
}

// Margins for names and points around the values.
function scatterAxis(title, values, log) {
  const high = Math.max(...values), low = Math.min(...values);
  if (!log) return axis(title, { type: 'linear', min: 0, suggestedMax: high > 0 ? 1.15 * high : 1 });
  return axis(title, { type: 'logarithmic', min: low / 1.6, max: high * 1.6,
    ticks: { color: css('--soft'), callback: logTicks, autoSkip: false, maxRotation: 0 } });
}

const LABEL_STEPS = [0, 15, -15, 30, -30, 45, -45, 60, -60];

// A free place for a label beside its point; undefined where there is none. The list below the chart has every name.
function placeOf(point, width, area, taken) {
  const places = LABEL_STEPS.flatMap(step => [point.x + 11, point.x - 11 - width].map(x => ({ x, y: point.y + step, width })));
  const overlaps = (a, b) => Math.abs(a.y - b.y) < 15 && a.x < b.x + b.width && b.x < a.x + a.width;
  return places.find(place => place.x >= area.left && place.x + width <= area.right && place.y >= area.top + 7 &&
    place.y <= area.bottom - 7 && !taken.some(box => overlaps(box, place)));
}

const pointNames = {
  id: 'pointNames',
  afterDatasetsDraw(chart) {
    const { ctx, chartArea } = chart;
    const points = chart.getDatasetMeta(0).data;
    const taken = points.map(point => ({ x: point.x - 8, y: point.y, width: 16 }));
    ctx.save();
    ctx.font = `500 12.5px ${Chart.defaults.font.family}`;
    ctx.fillStyle = css('--ink');
    ctx.textBaseline = 'middle';
    points.forEach((point, k) => {
      const text = labels[chart.data.datasets[0].data[k].i];
      const place = placeOf(point, ctx.measureText(text).width, chartArea, taken);
      if (!place) return;
      taken.push(place);
      ctx.fillText(text, place.x, place.y);
    });
    ctx.restore();
  },
};

function listPoints(points) {
  byId('points').replaceChildren(...points.map(({ i }) => element('li', { title: changesText(methods[i]) }, colourChip(i), labels[i])));
}

function scatterData(points) {
  return {
    datasets: [
      { data: points, pointRadius: 6, pointHoverRadius: 8, backgroundColor: points.map(({ i }) => methodColour(i)), borderColor: css('--paper'),
        borderWidth: 1.5 },
      { data: frontOf(points), type: 'line', pointRadius: 0, pointHitRadius: 0, borderColor: css('--soft'),
        borderWidth: 1.25, borderDash: [3, 4], order: 1 },
    ],
  };
}

function drawScatter(show) {
  const metric = PLOTTED[byId('error').value];
  const points = pointsOf(metric);
  const log = byId('log').checked && canBeLog(points);
  const options = commonOptions();
  options.layout = { padding: { top: 12, right: 8 } };
  options.plugins.tooltip.filter = item => item.datasetIndex === 0;
  options.plugins.tooltip.callbacks = {
    title: items => items.length ? labels[items[0].raw.i] : '',
    label: ({ raw }) => [`${metric.plot}  ${numberText(raw.y)}`, `${numberText(raw.x)} ms`],
  };
  options.onClick = (_, hits) => hits.length && hits[0].datasetIndex === 0 && show(points[hits[0].index].i);
  options.scales = {
    x: scatterAxis('milliseconds a frame (GPU, median)', points.map(point => point.x), log),
    y: scatterAxis(metric.plot, points.map(point => point.y), log),
  };
  listPoints(points);
  byId('log').disabled = !canBeLog(points);
  byId('scatter-chart').setAttribute('aria-label', `${metric.plot} against milliseconds: ` + points.map(({ i, x, y }) =>
    `${labels[i]} ${numberText(y)} in ${numberText(x)} ms`).join('; '));
  return new Chart(byId('scatter-chart'), { type: 'scatter', data: scatterData(points), options, plugins: [pointNames] });
}

function buildScatter(redraw) {
  const timed = methods.some(method => isNumber(method.frame_ms?.median));
  if (!PLOTTED.length || !timed) return false;
  const select = byId('error');
  PLOTTED.forEach((metric, i) => select.append(element('option', { value: i }, metric.plot)));
  const points = pointsOf(PLOTTED[0]);
  byId('log').checked = points.length > 1 && canBeLog(points) &&
    (span(points.map(point => point.x)) > 20 || span(points.map(point => point.y)) > 20);
  select.addEventListener('change', redraw);
  byId('log').addEventListener('change', redraw);
  byId('scatter').hidden = false;
  return true;
}

// ---- time by pass

const passMs = pass => pass?.gpu_ms?.median;
const groupOf = pass => String(pass.name).split('.')[0];
const TECHNIQUES = new Set(methods.flatMap(techniquesOf));

// Pass names in frame order; a name that only some methods have follows its predecessor there.
function passNames() {
  const names = [];
  for (const method of methods) {
    let place = 0;
    for (const pass of method.passes ?? []) {
      const known = names.indexOf(pass.name);
      if (known < 0) names.splice(place++, 0, pass.name);
      else place = known + 1;
    }
  }
  return names;
}

// Passes of the frame are grey and blue, those of methods are coloured.
function groupColours(groups) {
  const own = css('--own').split(/\s+/), common = css('--common').split(/\s+/);
  let nextOwn = 0, nextCommon = 0;
  return new Map(groups.map(group => [group, TECHNIQUES.has(group) ? own[nextOwn++ % own.length]
    : common[nextCommon++ % common.length]]));
}

// A name as lines, broken after + : , where it is long.
const NAME_WIDTH = 22;
function linesOf(name) {
  const lines = [''];
  for (const part of name.match(new RegExp(`[^+:,]{1,${NAME_WIDTH}}[+:,]?`, 'g')) ?? [name])
    if (lines.at(-1) && lines.at(-1).length + part.length > NAME_WIDTH) lines.push(part);
    else lines[lines.length - 1] += part;
  return lines;
}

function passesData(names, colours) {
  return {
    labels: labels.map(linesOf),
    datasets: names.map(name => ({
      label: name, backgroundColor: colours.get(groupOf({ name })), borderColor: css('--paper'),
      borderWidth: { right: 1 }, borderSkipped: false, barThickness: 22,
      data: methods.map(method => passMs((method.passes ?? []).find(pass => pass.name === name)) ?? 0),
    })),
  };
}

// Total frame time beside its bar.
const frameTimes = {
  id: 'frameTimes',
  afterDatasetsDraw(chart) {
    const { ctx } = chart;
    ctx.save();
    ctx.font = `12.5px ${Chart.defaults.font.family}`;
    ctx.fillStyle = css('--soft');
    ctx.textBaseline = 'middle';
    methods.forEach((method, i) => {
      const bars = chart.data.datasets.map((_, k) => chart.getDatasetMeta(k).data[i]).filter(Boolean);
      if (!bars.length || !isNumber(method.frame_ms?.median)) return;
      ctx.fillText(numberText(method.frame_ms.median), Math.max(...bars.map(bar => bar.x)) + 8, bars[0].y);
    });
    ctx.restore();
  },
};

function drawPasses() {
  const names = passNames();
  const colours = groupColours([...new Set(names.map(name => groupOf({ name })))]);
  const options = commonOptions();
  options.indexAxis = 'y';
  options.layout = { padding: { right: 44 } };
  options.plugins.tooltip.callbacks = {
    title: items => items.length ? `${items[0].dataset.label}` : '',
    label: item => `${labels[item.dataIndex]}  ${numberText(item.raw)} ms`,
  };
  options.scales = {
    x: axis('milliseconds (GPU, median of each pass)', { stacked: true, min: 0 }),
    y: axis('', { stacked: true, grid: { display: false, borderColor: css('--line') },
      ticks: { color: css('--ink'), autoSkip: false } }),
  };
  byId('groups').replaceChildren(...[...colours].map(([group, colour]) => {
    const chip = element('span', { className: 'chip' });
    chip.style.backgroundColor = colour;
    return element('li', {}, chip, group);
  }));
  const totals = methods.map((method, i) =>
    `${labels[i]} ${numberText((method.passes ?? []).reduce((sum, pass) => sum + (passMs(pass) ?? 0), 0))} ms`);
  byId('passes-chart').setAttribute('aria-label', `Milliseconds by pass; in all: ${totals.join('; ')}`);
  return new Chart(byId('passes-chart'), { type: 'bar', data: passesData(names, colours), options, plugins: [frameTimes] });
}

function buildPasses() {
  const timed = methods.some(method => (method.passes ?? []).some(pass => isNumber(passMs(pass))));
  if (!timed) return false;
  const rows = labels.map(label => Math.max(42, 18 * linesOf(label).length + 8));
  byId('passes-chart').parentElement.style.height = `${Math.max(74 + methods.length * Math.max(...rows), 160)}px`;
  byId('passes').hidden = false;
  return true;
}

// ---- all charts

function buildCharts(show) {
  const draw = () => {
    while (charts.length) charts.pop().destroy();
    useTheme();
    if (hasScatter) charts.push(drawScatter(show));
    if (hasPasses) charts.push(drawPasses());
  };
  const hasScatter = buildScatter(draw), hasPasses = buildPasses();
  draw();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
  matchMedia('print').addEventListener('change', draw); // paper is white
}
