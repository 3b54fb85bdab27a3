// Image viewer: two images with a divider, and a row of thumbnails for each method.

// Dim indirect light has an exposure of its own, which its captions state.
const brighter = report.exposure_ev - report.indirect_exposure_ev;
const ownExposure = brighter > 0.05 ? `, ${numberText(brighter, 1)} EV brighter` : '';
const LAYERS = [
  { key: 'picture', error: 'error', name: 'Full image', tile: 'Image' },
  { key: 'indirect', error: 'indirect_error', name: `Indirect light${ownExposure}`, tile: `Indirect light${ownExposure}`, exposure: ownExposure },
];
const shows = { layer: LAYERS[0], left: '', right: '' }; // left, right: "reference", "0 picture", "0 error"

const uriOf = (owner, role) => images[owner?.images?.[role]];
const hasLayer = layer => [report.reference, ...methods].some(owner => uriOf(owner, layer.key));

// Image of such a name in the current layer.
function sourceOf(name, layer = shows.layer) {
  if (name === 'direct') return { uri: layer === LAYERS[0] ? uriOf(report.direct, 'error') : null,
    label: 'error of direct light', text: 'Direct light alone: error map' };
  if (name === 'reference') return { uri: uriOf(report.reference, layer.key), label: 'reference', text: 'Reference' };
  const [i, kind] = name.split(' ');
  const label = labels[i];
  if (kind === 'error') return { uri: uriOf(methods[i], layer.error), label: `error of ${label}`, text: `${label}: error map` };
  return { uri: uriOf(methods[i], layer.key), label, text: label };
}

// ---- the two images

function fillPick(select) {
  const option = name => {
    const source = sourceOf(name);
    return source.uri ? element('option', { value: name }, source.text) : null;
  };
  const errors = [...methods.map((_, i) => option(`${i} error`)), option('direct')].filter(Boolean);
  const plain = [option('reference'), ...methods.map((_, i) => option(`${i} picture`))].filter(Boolean);
  select.replaceChildren(...plain, ...(errors.length ? [element('optgroup', { label: 'Error maps' }, ...errors)] : []));
}

function showImages() {
  for (const side of ['left', 'right']) {
    const select = byId(side);
    fillPick(select);
    if (!sourceOf(shows[side]).uri) shows[side] = select.options[side === 'right' ? 0 : select.options.length - 1]?.value ?? '';
    select.value = shows[side];
    const source = sourceOf(shows[side] || 'reference');
    const image = byId(`${side}-image`);
    image.src = source.uri ?? '';
    image.alt = `${source.text}, ${shows.layer.name.toLowerCase()}`;
  }
  const i = parseInt(shows.left, 10);
  markShown(Number.isNaN(i) ? -1 : i);
  showLegend();
}

function show(side, name, layer = shows.layer) {
  shows[side] = name;
  if (layer !== shows.layer) setLayer(layer);
  else showImages();
}

// Called for rows of the table and points of the chart.
function showMethod(i) {
  shows.right = 'reference';
  show('left', `${i} picture`);
  const still = matchMedia('(prefers-reduced-motion: reduce)').matches;
  byId('stage').scrollIntoView({ block: 'nearest', behavior: still ? 'auto' : 'smooth' });
}

function flip() {
  splitAt(view.split > 0.5 ? 0 : 1);
}

// ---- values under the pointer

const canvases = new Map(); // data: URI → a context to read pixels from

function contextOf(uri) {
  if (canvases.has(uri)) return canvases.get(uri);
  const image = new Image();
  canvases.set(uri, null); // until it is decoded
  image.onload = () => {
    const canvas = element('canvas', { width: image.naturalWidth, height: image.naturalHeight });
    const context = canvas.getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    canvases.set(uri, context);
  };
  image.src = uri;
  return null;
}

function pixelText(source, x, y) {
  const context = source.uri && contextOf(source.uri);
  return context ? [...context.getImageData(x, y, 1, 1).data.slice(0, 3)].join(' ') : '…';
}

// place: position in a frame; frame null: the pointer has left.
function point(frame, place) {
  byId('viewer').classList.toggle('pointed', Boolean(frame));
  for (const other of document.querySelectorAll('.view')) other.classList.toggle('under-pointer', other === frame);
  if (!frame) return showHint();
  byId('viewer').style.setProperty('--px', place.x);
  byId('viewer').style.setProperty('--py', place.y);
  const x = Math.floor((view.x + place.x) / view.zoom * WIDTH), y = Math.floor((view.y + place.y) / view.zoom * HEIGHT);
  if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT) return showHint();
  const value = name => {
    const source = sourceOf(name);
    return element('span', { className: 'value' }, `${source.label} `, element('b', {}, pixelText(source, x, y)));
  };
  byId('readout').replaceChildren(element('span', { className: 'value place' }, `x ${x}, y ${y}`),
    ...[...new Set([shows.left, shows.right])].filter(Boolean).map(value));
}

function showHint() {
  byId('readout').textContent = matchMedia('(pointer: coarse)').matches
    ? 'Drag to compare, pinch to zoom, double-tap for the whole image.'
    : 'Drag to compare, wheel to zoom, double-click for the whole image. Keys: ← → + − 0, F to flip.';
}

// ---- legend of the error maps

const ERROR_NAMES = { flip: 'FLIP', flip_hdr: 'HDR-FLIP', mae: 'mean absolute error', mse: 'squared error',
  relmse: 'relative squared error', ssim: '1 − SSIM' };

// Optional report.error_maps: {"picture": {"metric": "flip", "full": 1}, …}
function showLegend() {
  const map = report.error_maps?.[shows.layer.key] ?? {};
  const any = methods.some(method => uriOf(method, shows.layer.error));
  const unit = ['mae'].includes(map.metric) ? ' cd/m²' : '';
  const ramp = element('span', { className: 'ramp', role: 'img', 'aria-label': 'from black over violet and red to white' });
  ramp.style.backgroundImage = `linear-gradient(to right, ${scale.join(', ')})`;
  const end = isNumber(map.full) ? `${numberText(map.full, map.full >= 1 && Number.isInteger(map.full) ? 0 : undefined)}${unit}`
    : 'large';
  byId('legend').replaceChildren(element('span', {}, ERROR_NAMES[map.metric] ?? 'Error', ' map'),
    element('span', { className: 'number' }, isNumber(map.full) ? '0' : 'none'), ramp,
    element('span', { className: 'number' }, end));
  byId('legend').hidden = !any;
}

// ---- thumbnails: a row

function tile(side, name, layer, caption) {
  const source = sourceOf(name, layer);
  if (!source.uri) return null;
  const image = element('img', { src: source.uri, alt: `${source.text}, ${layer.name.toLowerCase()}`, draggable: false });
  const frame = element('div', { className: 'view', tabIndex: 0, role: 'button', title: `Show on the ${side} above` }, image,
    element('div', { className: 'spot', 'aria-hidden': 'true' }));
  listenTo(frame, () => show(side, name, layer));
  frame.addEventListener('keydown', event => {
    if (event.key !== 'Enter' && event.key !== ' ') return;
    event.preventDefault();
    show(side, name, layer);
  });
  return element('figure', { className: 'tile' }, frame, element('figcaption', {}, caption));
}

function sheetRow(i) {
  const layer = shows.layer, other = LAYERS.find(candidate => candidate !== layer);
  const metric = METRICS.find(candidate => candidate.group === (layer.key === 'picture' ? 'Image' : 'Indirect light') &&
    isNumber(candidate.value(methods[i])) && !candidate.hidden);
  const figure = metric ? element('span', { className: 'figure' }, `${metric.name} ${numberText(metric.value(methods[i]))}`) : null;
  const tiles = [tile('left', `${i} picture`, layer, layer.tile), tile('right', 'reference', layer, `Reference${layer.exposure ?? ''}`),
    tile('left', `${i} error`, layer, 'Error map'), tile('left', `${i} picture`, other, other.tile)].filter(Boolean);
  if (!tiles.length) return null;
  return element('div', { className: 'row' }, element('h3', { title: changesText(methods[i]) }, colourChip(i), labels[i], figure), element('div', { className: 'tiles' }, ...tiles));
}

function buildSheet() {
  byId('sheet').replaceChildren(...methods.map((_, i) => sheetRow(i)).filter(Boolean));
}

// ---- start-up

function setLayer(layer) {
  shows.layer = layer;
  for (const input of byId('layers').querySelectorAll('input')) input.checked = input.value === layer.key;
  showImages();
  buildSheet();
  showView();
}

function buildLayers() {
  const there = LAYERS.filter(hasLayer);
  byId('layers').hidden = there.length < 2;
  for (const layer of there) {
    const input = element('input', { type: 'radio', name: 'layer', value: layer.key });
    input.addEventListener('change', () => setLayer(layer));
    byId('layers').append(element('label', {}, input, element('span', {}, layer.name)));
  }
  return there[0];
}

const KEYS = {
  '+': () => zoomAt(0.5, 0.5, 1.5), '=': () => zoomAt(0.5, 0.5, 1.5), '-': () => zoomAt(0.5, 0.5, 1 / 1.5), '0': fitView,
  f: flip, F: flip,
};
const PANS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function listenToKeys() {
  byId('viewer').addEventListener('keydown', event => {
    if (event.target.closest('select') || event.ctrlKey || event.metaKey || event.altKey) return;
    const pan = event.shiftKey && PANS[event.key];
    if (pan) panBy(pan[0] * 0.1, pan[1] * 0.1);
    else if (KEYS[event.key]) KEYS[event.key]();
    else return;
    event.preventDefault();
  });
  // A press would move the focus away from the divider and its keys.
  stage.addEventListener('mousedown', event => {
    if (event.target.closest('select')) return;
    event.preventDefault();
    byId('split').focus({ preventScroll: true });
  });
}

function buildViewer() {
  const first = buildLayers();
  if (!first) return;
  const last = methods.findLastIndex(method => uriOf(method, first.key));
  Object.assign(shows, { left: `${last < 0 ? 0 : last} picture`, right: 'reference' });
  if (!methods.length) shows.left = 'reference';
  stage.style.setProperty('--width', WIDTH);
  stage.style.setProperty('--height', HEIGHT);
  byId('viewer').style.setProperty('--aspect', `${WIDTH} / ${HEIGHT}`);
  for (const side of ['left', 'right']) byId(side).addEventListener('change', event => show(side, event.target.value));
  byId('split').addEventListener('input', event => splitAt(event.target.value / 100));
  byId('zoom-in').addEventListener('click', () => zoomAt(0.5, 0.5, 1.5));
  byId('zoom-out').addEventListener('click', () => zoomAt(0.5, 0.5, 1 / 1.5));
  byId('fit').addEventListener('click', fitView);
  byId('flip').addEventListener('click', flip);
  listenTo(stage);
  listenToKeys();
  showHint();
  byId('viewer').hidden = false;
  setLayer(first);
  new ResizeObserver(showView).observe(stage);
}
