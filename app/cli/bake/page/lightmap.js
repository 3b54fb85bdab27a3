// The page of a light map: checks, images of the atlas, histograms and tables.

const quality = report.quality ?? {};
const colours = dataOf('colours');
const percent = (value, decimals) => isNumber(value) ? `${numberText(100 * value, decimals ?? decimalsFor([100 * value]))} %` : '–';
const whole = value => isNumber(value) ? Math.round(value).toLocaleString('en').replaceAll(',', ' ') : '–';
const short = value => isNumber(value) ? String(+value.toPrecision(3)) : '–';

// ---- header

const pages = report.pages ?? [];
const sizeText = size => `${size[0]} × ${size[1]} texels`;
const sizesText = () => pages.length > 1 ? `${pages.length} pages, the largest of ${sizeText(pages[0].size)}` : Array.isArray(report.size) ? sizeText(report.size) : null;

// Charts that cannot be at the bound of noise.
function noiseText() {
  const { noise_charts: all, noisy_charts: noisy, quiet_charts: quiet } = report;
  return `${whole(all - noisy)} of ${whole(all)}; ${whole(noisy)} above it with the most paths; ${whole(quiet)} below half of it by few, or without light`;
}

function buildHead() {
  const scene = String(report.scene ?? 'Light map');
  byId('scene').textContent = scene;
  document.title = `${scene} – Afterglow light map`;
  const facts = [
    ['Size', sizesText()],
    ['GI', report.gi], ['Light', report.light || null],
    ['Paths per texel', isNumber(report.paths) ? `${whole(report.paths)}${isNumber(report.noise) ? ' in the mean' : ''}` : null],
    ['Charts within the noise', isNumber(report.noise_charts) ? noiseText() : null],
    ['Threads', report.threads], ['Time', isNumber(report.seconds) ? secondsText(report.seconds) : null],
    ['Afterglow', report.version], ['Date', report.date ? `${String(report.date).slice(0, 16).replace('T', ' ')} UTC` : null],
  ];
  byId('facts').append(...facts.filter(([, value]) => value !== null && value !== undefined).map(([name, value]) =>
    element('div', {}, element('dt', {}, name), element('dd', {}, String(value)))));
  if (!report.command) return;
  byId('command').hidden = false;
  byId('command').firstChild.textContent = report.command;
}

// ---- checks: the bounds are those of docs/lightmaps.md

const sumOf = (list, key) => (list ?? []).reduce((sum, item) => sum + (item[key] ?? 0), 0);

// Share of the surface with less than 0.84 of the reached density: the classes below the one in the middle. Projections of charts are denser.
function sparseShare() {
  const classes = quality.density?.classes ?? [], all = sumOf(classes, 'area_m2');
  const sparse = classes.filter((_, i) => i + 1 < classes.length && classes[i + 1].from < 0.85 * quality.density.reached);
  return all > 0 ? sumOf(sparse, 'area_m2') / all : 0;
}

// Share of the texels that are in charts of fewer than 16.
function smallShare() {
  const classes = quality.charts?.classes ?? [];
  return sumOf(classes.filter(item => item.from < 16), 'texels') / Math.max(sumOf(classes, 'texels'), 1);
}

function checks() {
  const { density = {}, texels = {}, overlaps = {}, charts = {}, seams = {}, leaks = {}, noise } = quality;
  const sparse = sparseShare(), small = smallShare();
  const wanted = isNumber(density.wanted) ? `, wanted ${short(density.wanted)}` : '';
  const folded = overlaps.folded ? `, ${whole(overlaps.folded)} covered twice` : '';
  const inside = charts.inside_geometry ? `; ${whole(charts.inside_geometry)} charts black` : '';
  const rows = [
    ['Overlaps', `${whole(overlaps.shared)} texels of two charts${folded}`, '0', overlaps.shared === 0 && overlaps.folded === 0,
      'Light of one surface shows on another: the islands of TEXCOORD_1 overlap. Unwrap the mesh again, or remove the set.'],
    ['Density', `${short(density.reached)} texels per metre${wanted}; ${percent(sparse)} of the surface below 0.84 of it`, 'at most 5 % below', sparse <= 0.05,
      'Blurred charts are red below: give them more room in TEXCOORD_1, or raise density.'],
    ['Atlas', `${whole(texels.count)} texels, ${percent(texels.utilisation, 0)} of it`, 'at least 40 %', texels.utilisation >= 0.4,
      'Gutters of small charts take the room: fewer, larger charts, or a higher density.'],
    ['Charts', `${whole(charts.count)}, ${percent(small)} of the texels in charts below 16`, 'at most 20 %', small <= 0.2,
      'Small parts have a texel or two each: raise density, or unwrap them together.'],
    ['Seams', `${percent(seams.after?.above_5_percent)} of ${whole(seams.texels)} texels of edges with steps above 5 % (${percent(seams.before?.above_5_percent)} before they were closed)`,
      'at most 5 %', !(seams.after?.above_5_percent > 0.05), noise?.median > 0.1 ? 'Noise makes steps, too: raise --spp first.'
        : 'Lines on smooth surfaces: raise density, or move seams in the unwrap.'],
    ['Leaks', `${whole(leaks.texels)} texels`, '0', leaks.texels === 0,
      'Light or darkness beside walls: divide the mesh where walls meet it, make walls thicker than a texel, or raise density.'],
    ['Inside geometry', `${whole(texels.filled)} texels filled, ${whole(texels.partly_inside)} partly inside${inside}`, null, null,
      'Filled texels have the light of the nearest valid one of their chart; nobody sees them but at their edges.'],
    ['Noise', noise ? `${percent(noise.largest)} in the worst chart, ${percent(noise.median)} in the median` : 'not known: not by paths',
      noise ? 'at most 5 %' : null, noise ? noise.largest <= 0.05 : null, noise ? 'Grain: raise --spp, or --spp auto:noise=PERCENT, or --denoise.' : ''],
  ];
  return rows;
}

function buildChecks() {
  const rows = checks().map(([name, value, bound, good, advice]) => element('tr', {}, element('th', { scope: 'row' }, name),
    element('td', { className: `state ${good === null ? 'info' : good ? 'good' : 'bad'}` }, good === null ? '' : good ? 'good' : 'look'),
    element('td', { className: 'words' }, value), element('td', { className: 'words' }, bound ?? ''),
    element('td', { className: 'words advice' }, good ? '' : advice)));
  byId('check-table').append(element('thead', {}, element('tr', {},
    ...['Check', '', 'Value', 'Good', 'What to do'].map((title, i) => element('th', { scope: 'col', className: i ? 'words' : 'corner' }, title)))),
  element('tbody', {}, ...rows));
}

// ---- the atlas

function chip(colour, text) {
  const mark = element('span', { className: 'chip', 'aria-hidden': 'true' });
  mark.style.backgroundColor = colour;
  return element('li', {}, mark, text);
}

function ramp(from, stops, to) {
  const bar = element('span', { className: 'ramp', 'aria-hidden': 'true' });
  bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
  return element('li', {}, from, bar, to);
}

const reached = quality.density?.reached;
const ATLAS = [
  ['light', 'Light', 'White surfaces under the light of the map. Good: smooth but for shadows; stains and lines are faults, which the images beside it show.', () => []],
  ['charts', 'Charts', 'A colour for each chart. Good: few large areas; confetti are small parts, each with a gutter.', () => []],
  ['density', 'Density', 'Texels per metre. Good: one colour; red charts are blurred.',
    () => [ramp(short(reached / 2 ** 1.5), colours.density, short(reached * 2 ** 1.5)), chip(colours.one_texel, 'charts of one texel')]],
  ['leaks', 'Leaks and texels inside geometry', 'Good: no red; see Leaks.',
    () => [chip(colours.leak, 'leak'), chip(colours.partly, 'partly inside'), chip(colours.filled, 'filled')]],
  ['noise', 'Noise', 'Standard error of each texel. Good: dark; bright charts need more paths.', () => [ramp('0.5 %', colours.noise, '50 %')]],
];

function figureOf(name, title, meaning, keys, side) {
  const uri = images[`${name}${side ? '-back' : ''}.png`];
  if (!uri) return null;
  const text = side ? `${title}, backs` : title;
  const button = element('button', { type: 'button', 'aria-label': `${text}: change its size` }, element('img', { src: uri, alt: text }));
  const figure = element('figure', {}, button, element('h3', {}, text), element('ul', { className: 'keys' }, ...keys()),
    element('figcaption', {}, meaning));
  button.addEventListener('click', () => figure.classList.toggle('large'));
  return figure;
}

function buildImages() {
  if (pages.length > 1)
    byId('pages').textContent = `Pages lie side by side, row by row, from page 0 at the upper left: ${pages.map((page, i) => `${i} at ${page.at.join(', ')}`).join('; ')}.`;
  for (const side of [0, 1])
    byId('images').append(...ATLAS.map(([name, title, meaning, keys]) => figureOf(name, title, meaning, keys, side)).filter(Boolean));
}

// ---- histograms

function buildHistogram(id, classes, amount, labelOf, titleOf, markOf) {
  const all = sumOf(classes, amount), most = Math.max(...classes.map(item => item[amount]), 0);
  byId(id).querySelector('.histogram').append(...classes.map((item, i) => {
    const bar = element('i', {}), share = all > 0 ? item[amount] / all : 0;
    bar.style.height = `${most > 0 ? 78 * item[amount] / most : 0}%`;
    return element('div', { className: `class${item.charts ? '' : ' empty'}${markOf?.(i) ? ' reached' : ''}`, title: titleOf(item, i, share) },
      element('b', {}, item.charts ? (share >= 0.005 ? percent(share, 0) : '<1 %') : ''), bar, element('span', {}, labelOf(item, i)));
  }));
}

function buildHistograms() {
  const density = quality.density?.classes ?? [], sizes = quality.charts?.classes ?? [];
  const middle = density.length / 2;
  buildHistogram('density', density, 'area_m2', item => short(item.from * 2 ** 0.25),
    (item, i, share) => `${item.charts} charts, ${percent(share)} of the surface, from ${short(item.from)} texels per metre`, i => i === middle);
  buildHistogram('sizes', sizes, 'texels', item => item.from < 1024 ? String(item.from) : `${item.from / 1024} k`,
    (item, i, share) => `${item.charts} charts of ${item.from} texels or more, ${percent(share)} of the texels`);
}

// ---- tables

const nameOf = chart => [chart.name || `instance ${chart.instance}`, chart.mesh && chart.mesh !== chart.name ? chart.mesh : null,
  isNumber(chart.page) ? `page ${chart.page}` : null].filter(Boolean).join(', ');
const placeOf = item => (item.position ?? []).map(value => numberText(value, 2)).join(', ');
const namesOf = charts => [...new Set((charts ?? []).map(nameOf))].join(' | ');
const numbersOf = charts => (charts ?? []).map(chart => chart.chart).join(' | ');
const luxOf = item => (item.lux ?? []).map(short).join(' | ');

function buildTable(id, columns, rows, none) {
  const table = byId(id).querySelector('table');
  if (!rows?.length) {
    table.replaceWith(element('p', {}, none));
    return;
  }
  table.append(element('thead', {}, element('tr', {}, ...columns.map(([title], i) => element('th', { scope: 'col', className: i ? '' : 'corner' }, title)))),
    element('tbody', {}, ...rows.map(row => element('tr', {}, ...columns.map(([, of], i) =>
      element(i ? 'td' : 'th', i ? {} : { scope: 'row' }, of(row)))))));
}

function buildTables() {
  const side = row => row.back ? ' (back)' : '';
  buildTable('seams', [['Instance, mesh', row => namesOf(row.charts) + side(row)], ['Step', row => percent(row.step)],
    ['Before', row => percent(row.step_before)], ['Lux', luxOf], ['x, y, z in m', placeOf], ['Charts', row => numbersOf(row.charts)]],
  quality.seams?.worst, 'No two charts share an edge of a smooth surface.');
  buildTable('leaks', [['Instance, mesh', row => namesOf(row.charts) + side(row)], ['Step', row => percent(row.step)], ['Lux', luxOf],
    ['x, y, z in m', placeOf], ['Chart', row => numbersOf(row.charts)]], quality.leaks?.worst, 'None.');
  byId('noise').hidden = !quality.noise;
  if (quality.noise)
    buildTable('noise', [['Instance, mesh', row => nameOf(row.first) + side(row)], ['Noise', row => percent(row.noise)], ['Texels', row => whole(row.texels)],
      ['First chart', row => String(row.first.chart)], ['Charts', row => whole(row.charts)], ['x, y, z in m', placeOf]], quality.noise.worst, 'None.');
}

function buildTimes() {
  const stages = report.stages ?? [];
  byId('times').querySelector('.caption').textContent = stages.length
    ? 'Seconds of all threads together, of each stage of the bake; those of a bake that was in the cache are of the run that made it.'
    : 'The light was in the cache, which does not know how long it took.';
  if (!stages.length) return;
  buildTable('times', [['Stage', row => `${row.bake}: ${row.name}`], ['Seconds on all threads', row => numberText(row.seconds, row.seconds < 10 ? 2 : 1)]], stages, '');
}

buildHead();
buildChecks();
buildImages();
buildHistograms();
buildTables();
buildTimes();
